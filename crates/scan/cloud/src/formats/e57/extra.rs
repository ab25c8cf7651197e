//! Properties of E57 scans beside positions, colours, intensities and indices: times, return numbers, normals, ranges, and those of any extension.
//!
//! Each is a column with the name that the file gives it; normals are `nx ny nz`, turned by the pose of their scan. A scan without the property has NaN.
//! ASTM E2807-11 (2019); normals: E57_NOR_surface_normals (libe57).

use super::point::Pose;
use e57::{PointCloud, RawValues, Record, RecordDataType, RecordName, Result};
use std::collections::{HashMap, HashSet};
use stream::{MOST_COLUMNS, Values};

/// Columns of the cloud that are not from here, at most.
const OTHERS: usize = 16;
/// Names that the cloud has already.
const TAKEN: [&str; 10] = ["x", "y", "z", "intensity", "red", "green", "blue", "row", "column", "scan"];
/// The normal, by the names of the extension and by those of the cloud.
const NORMAL: [(&str, &str); 3] = [("normalX", "nx"), ("normalY", "ny"), ("normalZ", "nz")];

/// Numbers that a column holds.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Byte,
    Whole,
    Single,
    Double,
}

struct Column {
    property: RecordName,
    name: String,
    kind: Kind,
    values: Vec<f64>,
}

/// The columns of a file, and the properties for which there is no room.
pub(crate) struct Extra {
    columns: Vec<Column>,
    /// By their names in the file.
    pub(crate) left_out: Vec<String>,
}

/// Where the columns stand in the rows of one scan.
pub(crate) struct Further<'a> {
    scan: &'a PointCloud,
    /// Of each column; none where the scan has no such property.
    places: Vec<Option<usize>>,
    /// The column of times, and the field that says which of them do not count.
    time: Option<usize>,
    time_is_invalid: Option<usize>,
    /// The columns of the normal, if it is to be turned.
    normal: Option<[usize; 3]>,
    pose: Pose,
}

/// Whether a property of a scan has a column here.
fn is_carried(scan: &PointCloud, property: &RecordName) -> bool {
    match property {
        RecordName::TimeStamp | RecordName::ReturnIndex | RecordName::ReturnCount => true,
        RecordName::Unknown { .. } => true,
        // Where there is nothing else, they are the position.
        RecordName::SphericalRange | RecordName::SphericalAzimuth | RecordName::SphericalElevation => {
            scan.has_cartesian()
        }
        _ => false,
    }
}

impl Extra {
    /// The columns of the scans, without values.
    pub(crate) fn of(scans: &[PointCloud]) -> Extra {
        let mut extra = Extra { columns: Vec::new(), left_out: Vec::new() };
        let mut names: HashSet<String> = TAKEN.map(str::to_owned).into();
        let mut known: HashMap<RecordName, Option<usize>> = HashMap::new();
        for scan in scans {
            for record in scan.prototype.iter().filter(|record| is_carried(scan, &record.name)) {
                match known.get(&record.name) {
                    Some(Some(k)) => extra.columns[*k].widen(&record.data_type),
                    Some(None) => {}
                    None if extra.columns.len() + OTHERS < MOST_COLUMNS => {
                        known.insert(record.name.clone(), Some(extra.columns.len()));
                        extra.columns.push(Column::new(record, &mut names));
                    }
                    None => {
                        known.insert(record.name.clone(), None);
                        extra.left_out.push(full_name(&record.name));
                    }
                }
            }
        }
        extra
    }

    /// How many columns there are.
    pub(crate) fn count(&self) -> usize {
        self.columns.len()
    }

    /// Where the columns stand in the rows of a scan.
    pub(crate) fn in_scan<'a>(&self, scan: &'a PointCloud) -> Further<'a> {
        let mut places: HashMap<&RecordName, usize> = HashMap::new();
        for (place, record) in scan.prototype.iter().enumerate() {
            places.entry(&record.name).or_insert(place);
        }
        let normal = NORMAL.map(|(_, name)| self.columns.iter().position(|c| c.name == name));
        let is_here = |k: Option<usize>| k.filter(|&k| places.contains_key(&self.columns[k].property));
        Further {
            scan,
            places: self.columns.iter().map(|c| places.get(&c.property).copied()).collect(),
            time: self.columns.iter().position(|c| c.property == RecordName::TimeStamp),
            time_is_invalid: places.get(&RecordName::IsTimeStampInvalid).copied(),
            normal: match normal.map(is_here) {
                [Some(x), Some(y), Some(z)] if scan.transform.is_some() => Some([x, y, z]),
                _ => None,
            },
            pose: Pose::of(scan),
        }
    }

    /// Adds a row of a scan.
    ///
    /// # Errors
    /// What the reader says of the file.
    pub(crate) fn push(&mut self, row: &RawValues, further: &Further) -> Result<()> {
        if self.columns.is_empty() {
            return Ok(());
        }
        let number = |place: usize| row[place].to_f64(&further.scan.prototype[place].data_type);
        for (column, place) in self.columns.iter_mut().zip(&further.places) {
            column.push(place.map(number).transpose()?);
        }
        if let (Some(k), Some(state)) = (further.time, further.time_is_invalid)
            && number(state)? != 0.0
        {
            self.columns[k].values.pop();
            self.columns[k].push(None);
        }
        if let Some(normal) = further.normal {
            let last = self.columns[normal[0]].values.len() - 1;
            let turned = further.pose.turn(normal.map(|k| self.columns[k].values[last]));
            for (k, value) in normal.into_iter().zip(turned.iter()) {
                self.columns[k].values[last] = *value;
            }
        }
        Ok(())
    }

    /// The columns with their names.
    pub(crate) fn into_columns(self) -> impl Iterator<Item = (String, Values)> {
        self.columns.into_iter().map(|c| (c.name, c.kind.values(&c.values)))
    }
}

impl Column {
    fn new(record: &Record, names: &mut HashSet<String>) -> Column {
        let property = record.name.clone();
        let mut kind = Kind::of(&record.data_type);
        let full = full_name(&property);
        let short = full.rsplit(':').next().unwrap_or_default();
        let normal = NORMAL.iter().find(|(extension, _)| full != short && *extension == short);
        if normal.is_some() && kind != Kind::Double {
            // A turned normal is no whole number.
            kind = Kind::Single;
        }
        let plain = |text: &str| -> String {
            let letter = |c: char| if c.is_ascii_graphic() { c } else { '_' };
            text.chars().map(letter).collect()
        };
        let wanted = normal.map_or(short, |(_, name)| name);
        let mut name = plain(wanted);
        // A name that is taken gets that of its extension in front, then a number behind.
        if name.is_empty() || names.contains(&name) {
            name = plain(&full.replace(':', "_"));
        }
        let first = name.clone();
        for number in 2.. {
            if names.insert(name.clone()) {
                break;
            }
            name = format!("{first}_{number}");
        }
        Column { property, name, kind, values: Vec::new() }
    }

    /// Makes room for the numbers of a further scan.
    fn widen(&mut self, data: &RecordDataType) {
        let other = Kind::of(data);
        self.kind = match (self.kind, other) {
            (a, b) if a == b => a,
            (Kind::Byte, Kind::Whole) | (Kind::Whole, Kind::Byte) => Kind::Whole,
            _ => Kind::Double,
        };
    }

    fn push(&mut self, value: Option<f64>) {
        if value.is_none() && matches!(self.kind, Kind::Byte | Kind::Whole) {
            self.kind = Kind::Double;
        }
        self.values.push(value.unwrap_or(f64::NAN));
    }
}

impl Kind {
    fn of(data: &RecordDataType) -> Kind {
        let within = |low: i64, high: i64, min: i64, max: i64| low <= min && max <= high;
        match *data {
            RecordDataType::Single { .. } => Kind::Single,
            RecordDataType::Integer { min, max } if within(0, 255, min, max) => Kind::Byte,
            RecordDataType::Integer { min, max } if within(i32::MIN.into(), i32::MAX.into(), min, max) => {
                Kind::Whole
            }
            _ => Kind::Double,
        }
    }

    fn values(self, numbers: &[f64]) -> Values {
        match self {
            Kind::Byte => Values::U8(numbers.iter().map(|&v| v as u8).collect()),
            Kind::Whole => Values::I32(numbers.iter().map(|&v| v as i32).collect()),
            Kind::Single => Values::F32(numbers.iter().map(|&v| v as f32).collect()),
            Kind::Double => Values::F64(numbers.to_vec()),
        }
    }
}

/// The name of a property in the file, behind that of its extension and a colon.
fn full_name(property: &RecordName) -> String {
    match property {
        RecordName::TimeStamp => "timeStamp".to_owned(),
        RecordName::ReturnIndex => "returnIndex".to_owned(),
        RecordName::ReturnCount => "returnCount".to_owned(),
        RecordName::SphericalRange => "sphericalRange".to_owned(),
        RecordName::SphericalAzimuth => "sphericalAzimuth".to_owned(),
        RecordName::SphericalElevation => "sphericalElevation".to_owned(),
        RecordName::Unknown { namespace, name } if !namespace.is_empty() => format!("{namespace}:{name}"),
        RecordName::Unknown { name, .. } => name.clone(),
        _ => String::new(),
    }
}
