//! E57, by the `e57` crate: every scan of the file, each in its pose.

use super::{ReadError, catch, e57_claims as claims};
use crate::Cloud;
use e57::{CartesianCoordinate, E57Reader, Point, PointCloud, Record, RecordName};
use geom::Vec3;
use std::collections::BTreeSet;
use std::io::Cursor;
use stream::{Table, Values};

pub(super) fn matches(bytes: &[u8]) -> bool {
    bytes.starts_with(b"ASTM-E57")
}

pub(super) fn read(bytes: Vec<u8>) -> Result<Cloud, ReadError> {
    catch("E57", move || decode(bytes))
}

fn broken(what: impl ToString, point: u64) -> ReadError {
    ReadError::Broken { format: "E57", what: what.to_string(), point: Some(point) }
}

/// What the scans of one file have, side by side.
#[derive(Default)]
struct Columns {
    points: Vec<Vec3>,
    intensity: Vec<f32>,
    color: [Vec<f32>; 3],
    row: Vec<i32>,
    column: Vec<i32>,
    scan: Vec<u16>,
}

fn decode(bytes: Vec<u8>) -> Result<Cloud, ReadError> {
    let length = bytes.len() as u64;
    claims::before_the_header(&bytes).map_err(|e| broken(e, 0))?;
    let mut reader = E57Reader::new(Cursor::new(bytes)).map_err(|e| broken(e, 0))?;
    let scans = reader.pointclouds();
    claims::before_the_points(&scans, length).map_err(|e| broken(e, 0))?;
    let posed = scans.iter().enumerate().map(|(number, scan)| claims::with_sound_pose(number, scan));
    let scans: Vec<PointCloud> = posed.collect::<Result<_, _>>().map_err(|e| broken(e, 0))?;
    let mut columns = Columns::default();
    for (number, scan) in scans.iter().enumerate() {
        let at = columns.points.len() as u64;
        let mut points = reader.pointcloud_simple(scan).map_err(|e| broken(e, at))?;
        points.intensity_to_color(false);
        points.normalize_intensity(false);
        points.normalize_color(false);
        for point in points {
            let at = columns.points.len() as u64;
            columns.push(point.map_err(|e| broken(e, at))?, number);
        }
    }
    columns.into_cloud(&scans)
}

impl Columns {
    fn push(&mut self, point: Point, scan: usize) {
        self.points.push(match point.cartesian {
            CartesianCoordinate::Valid { x, y, z } => Vec3::new(x, y, z),
            // A direction without a distance, or nothing: no echo.
            _ => Vec3::repeat(f64::NAN),
        });
        self.intensity.push(point.intensity.unwrap_or(f32::NAN));
        let color = point.color.map_or([0.0; 3], |c| [c.red, c.green, c.blue]);
        for (column, value) in self.color.iter_mut().zip(color) {
            column.push(value);
        }
        self.row.push(point.row as i32);
        self.column.push(point.column as i32);
        self.scan.push(scan.min(u16::MAX as usize) as u16);
    }

    fn into_cloud(self, scans: &[PointCloud]) -> Result<Cloud, ReadError> {
        let has = |property: fn(&PointCloud) -> bool| scans.iter().any(property);
        let mut attributes = Table::with_rows(self.points.len());
        let mut push = |name: &str, values: Values| {
            attributes.push(name, values).map_err(|source| ReadError::Table { format: "E57", source })
        };
        if has(PointCloud::has_intensity) {
            push("intensity", Values::F32(self.intensity))?;
        }
        if has(PointCloud::has_color) {
            for (name, column) in ["red", "green", "blue"].into_iter().zip(self.color) {
                push(name, narrowed(column))?;
            }
        }
        if has(PointCloud::has_row_column) {
            push("row", Values::I32(self.row))?;
            push("column", Values::I32(self.column))?;
        }
        if scans.len() > 1 {
            push("scan", Values::U32(self.scan.iter().map(|&scan| scan.into()).collect()))?;
        }
        let comments = left_out(scans).into_iter().collect();
        let mut cloud = Cloud { points: self.points, attributes, double: true, comments, ..Cloud::default() };
        // A scanner stands at the origin of its scan; a pose that moves nothing is stated for merged scans as well.
        for t in scans.iter().filter_map(|scan| scan.transform.as_ref()).map(|pose| &pose.translation) {
            let eye = Vec3::new(t.x, t.y, t.z);
            if eye.norm() > 0.0 {
                cloud.add_viewpoint(&eye);
            }
        }
        Ok(cloud)
    }
}

/// Longest list of properties that a comment holds [B].
const LONGEST: usize = 1000;

/// A comment that names the properties of the scans that are not read.
fn left_out(scans: &[PointCloud]) -> Option<String> {
    let name = |record: &Record| match &record.name {
        RecordName::ReturnCount => Some("returnCount".to_owned()),
        RecordName::ReturnIndex => Some("returnIndex".to_owned()),
        RecordName::TimeStamp => Some("timeStamp".to_owned()),
        RecordName::Unknown { namespace, name } => Some(format!("{namespace}:{name}")),
        _ => None,
    };
    let names: BTreeSet<String> =
        scans.iter().flat_map(|scan| scan.prototype.iter().filter_map(name)).collect();
    let names = names.into_iter().collect::<Vec<_>>().join(" ");
    let plain = |c: char| if c.is_ascii_graphic() || c == ' ' { c } else { '_' };
    let names: String = names.chars().take(LONGEST).map(plain).collect();
    (!names.is_empty()).then(|| format!("properties of the scans that were left out: {names}"))
}

/// Colours in the smallest type that holds them all.
fn narrowed(column: Vec<f32>) -> Values {
    let fits = |top: f32| column.iter().all(|&c| c.fract() == 0.0 && (0.0..=top).contains(&c));
    if fits(255.0) {
        Values::U8(column.iter().map(|&c| c as u8).collect())
    } else if fits(65535.0) {
        Values::U16(column.iter().map(|&c| c as u16).collect())
    } else {
        Values::F32(column)
    }
}
