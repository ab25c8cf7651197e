//! E57, by the `e57` crate: every scan of the file, each in its pose.

use super::color::ColorScale;
use super::extra::Extra;
use super::point::Fields;
use super::{claims, xml};
use crate::formats::error::ReadError;
use crate::formats::{foreign, narrowed::narrowed};
use crate::points::Cloud;
use e57::{E57Reader, PointCloud, RawValues};
use geom::Vec3;
use std::io::Cursor;
use stream::{Table, Values};

pub(crate) fn matches(bytes: &[u8]) -> bool {
    bytes.starts_with(b"ASTM-E57")
}

pub(crate) fn read(bytes: Vec<u8>) -> Result<Cloud, ReadError> {
    foreign::guarded("E57", move || decode(bytes))
}

fn broken(what: impl ToString, point: u64) -> ReadError {
    ReadError::Broken { format: "E57", what: what.to_string(), point: Some(point) }
}

/// What the scans of one file have, side by side.
#[derive(Default)]
struct Columns {
    points: Vec<Vec3>,
    intensity: Vec<f64>,
    color: [Vec<f32>; 3],
    row: Vec<i32>,
    column: Vec<i32>,
    scan: Vec<u16>,
}

fn decode(bytes: Vec<u8>) -> Result<Cloud, ReadError> {
    let length = bytes.len() as u64;
    claims::before_the_header(&bytes).and_then(|()| xml::check(&bytes)).map_err(|e| broken(e, 0))?;
    let mut reader = E57Reader::new(Cursor::new(bytes)).map_err(|e| broken(e, 0))?;
    let scans = reader.pointclouds();
    claims::before_the_points(&scans, length).map_err(|e| broken(e, 0))?;
    let posed = scans.iter().enumerate().map(|(number, scan)| claims::with_sound_pose(number, scan));
    let scans: Vec<PointCloud> = posed.collect::<Result<_, _>>().map_err(|e| broken(e, 0))?;
    let scales = ColorScale::of(&scans);
    let mut columns = Columns::default();
    let mut extra = Extra::of(&scans);
    for (number, scan) in scans.iter().enumerate() {
        let at = columns.points.len() as u64;
        let (fields, further) = (Fields::of(scan, scales[number]), extra.in_scan(scan));
        for row in reader.pointcloud_raw(scan).map_err(|e| broken(e, at))? {
            let at = columns.points.len() as u64;
            let mut push = |row| {
                columns.push(&fields, &row, number)?;
                extra.push(&row, &further)
            };
            row.and_then(&mut push).map_err(|e| broken(e, at))?;
        }
    }
    columns.into_cloud(&scans, extra)
}

impl Columns {
    fn push(&mut self, fields: &Fields, row: &RawValues, scan: usize) -> e57::Result<()> {
        self.points.push(fields.position(row)?);
        self.intensity.push(fields.intensity(row)?);
        for (column, value) in self.color.iter_mut().zip(fields.color(row)?) {
            column.push(value);
        }
        let [line, place] = fields.indices(row)?;
        self.row.push(line);
        self.column.push(place);
        self.scan.push(scan.min(u16::MAX as usize) as u16);
        Ok(())
    }

    fn into_cloud(self, scans: &[PointCloud], extra: Extra) -> Result<Cloud, ReadError> {
        let has = |property: fn(&PointCloud) -> bool| scans.iter().any(property);
        let mut attributes = Table::with_rows(self.points.len());
        let mut push = |name: &str, values: Values| {
            attributes.push(name, values).map_err(|source| ReadError::Table { format: "E57", source })
        };
        if has(PointCloud::has_intensity) {
            push("intensity", shortest(self.intensity))?;
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
        let left_out = left_out(&extra.left_out);
        for (name, values) in extra.into_columns() {
            push(&name, values)?;
        }
        let mut cloud = Cloud { points: self.points, attributes, double: true, ..Cloud::default() };
        left_out.into_iter().for_each(|what| cloud.leave_out(what));
        // A scanner stands at the origin of its scan. A pose that moves nothing is stated for scans that were merged as well: these have no grid, and there
        // is one of them.
        let eye = |scan: &PointCloud| {
            let t = &scan.transform.as_ref()?.translation;
            let eye = Vec3::new(t.x, t.y, t.z);
            (eye.norm() > 0.0 || scans.len() > 1 || scan.has_row_column()).then_some(eye)
        };
        scans.iter().filter_map(eye).for_each(|eye| cloud.add_viewpoint(&eye));
        Ok(cloud)
    }
}

/// Longest list of properties that a comment holds [B].
const LONGEST: usize = 1000;

/// A comment that names the properties of the scans for which there is no column.
fn left_out(names: &[String]) -> Option<String> {
    let plain = |c: char| if c.is_ascii_graphic() || c == ' ' { c } else { '_' };
    let text: String = names.join(" ").chars().take(LONGEST).map(plain).collect();
    (!names.is_empty()).then(|| format!("{} properties of the scans were left out: {text}", names.len()))
}

/// Numbers of 4 bytes, if none loses a digit by that.
fn shortest(column: Vec<f64>) -> Values {
    if column.iter().all(|&v| v.is_nan() || f64::from(v as f32) == v) {
        return Values::F32(column.iter().map(|&v| v as f32).collect());
    }
    Values::F64(column)
}
