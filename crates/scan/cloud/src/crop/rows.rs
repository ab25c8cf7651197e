//! Crop of a plain binary PLY row by row: shapes test each point separately, so only the kept rows are held, unchanged.

use super::marks::MARK;
use super::report::Cropped;
use super::rules::Rules;
use super::shapes::ShapeTest;
use crate::formats::ReadError;
use crate::points::units::{self, UnitWarning};
use geom::Vec3;
use rayon::prelude::*;
use std::io::{Read, Write};
use stream::NumberType;
use stream::ply::{self, Blocks, PlyError, number_at};

/// Rows judged by one task.
const CHUNK: usize = 1 << 12;

/// The rows that stay, and what a header says about them.
pub struct KeptRows {
    comments: Vec<String>,
    properties: Vec<(String, NumberType)>,
    rows: Vec<u8>,
    /// What looks wrong about the numbers of the whole cloud.
    pub warnings: Vec<UnitWarning>,
}

/// Where x, y and z are: side by side, all of one type with a point in it.
fn positions<R>(blocks: &Blocks<R>) -> Option<(NumberType, usize)> {
    let x = blocks.properties.iter().position(|p| p.name == "x")?;
    let (kind, at) = (blocks.properties[x].kind, blocks.properties[x].offset);
    let follows = |step: usize, axis: &str| {
        blocks.properties.get(x + step).is_some_and(|p| p.name == axis && p.kind == kind)
    };
    (matches!(kind, NumberType::F32 | NumberType::F64) && follows(1, "y") && follows(2, "z"))
        .then_some((kind, at))
}

/// Whether [`crop_rows`] can do what the rules ask for.
pub fn can<R>(blocks: &Blocks<R>, rules: &Rules) -> bool {
    let shapes_alone = rules.outer.shapes.is_empty()
        && rules.condition.is_none()
        && !rules.measure()
        && rules.restore.is_empty()
        && !rules.mark;
    let marked = blocks.properties.iter().any(|p| p.name == MARK);
    shapes_alone && !marked && positions(blocks).is_some()
}

/// The rows that stay; the same as [`crate::crop::apply`] leaves.
///
/// # Errors
/// A stream that is cut off, or goes on after its last row.
pub fn crop_rows<R: Read>(mut blocks: Blocks<R>, rules: &Rules) -> Result<(KeptRows, Cropped), ReadError> {
    let Some((kind, at)) = positions(&blocks) else { return Err(ReadError::NoPosition) };
    let (stride, size) = (blocks.stride, kind.size());
    let point = move |row: &[u8]| Vec3::from([0, 1, 2].map(|a| number_at(&row[at + a * size..], kind)));
    let judge = ShapeTest::new(rules);
    let mut report = Cropped::of(rules);
    let mut survey = units::Survey::new(usize::try_from(blocks.rows).unwrap_or(usize::MAX));
    let mut kept = Vec::new();
    while let Some(rows) = blocks.next_rows().map_err(ReadError::Ply)? {
        survey.add(rows.len() / stride, |row| point(&rows[row * stride..]));
        report.points_in += rows.len() / stride;
        let judged: Vec<(Vec<u8>, Cropped)> =
            rows.par_chunks(CHUNK * stride).map(|rows| judge.rows(rows, stride, point, rules)).collect();
        for (rows, part) in judged {
            kept.extend_from_slice(&rows);
            report.add(&part);
        }
    }
    if report.points_in >= crate::formats::MOST {
        return Err(ReadError::TooMany { points: report.points_in as u64 });
    }
    report.idle = judge.idle(rules);
    report.points_out = kept.len() / stride;
    report.outside_shapes = report.points_in - report.not_finite - report.points_out;
    let properties = blocks.properties.iter().map(|p| (p.name.clone(), p.kind)).collect();
    let comments = std::mem::take(&mut blocks.comments);
    let warnings = survey.warnings(kind == NumberType::F64, &comments);
    Ok((KeptRows { comments, properties, rows: kept, warnings }, report))
}

impl KeptRows {
    /// Writes them as PLY.
    ///
    /// # Errors
    /// A stream that takes no more.
    pub fn write(&self, to: &mut impl Write) -> Result<(), PlyError> {
        let properties: Vec<(&str, NumberType)> =
            self.properties.iter().map(|(name, kind)| (&**name, *kind)).collect();
        ply::write_rows(to, &self.comments, ("vertex", &self.rows), &properties)
    }
}

impl ShapeTest<'_> {
    /// The rows that stay, and counts of the others.
    fn rows(
        &self,
        rows: &[u8],
        stride: usize,
        point: impl Fn(&[u8]) -> Vec3,
        rules: &Rules,
    ) -> (Vec<u8>, Cropped) {
        let (mut kept, mut part) = (Vec::with_capacity(rows.len()), Cropped::of(rules));
        for row in rows.chunks_exact(stride) {
            let p = point(row);
            part.regions
                .iter_mut()
                .zip(&rules.regions)
                .for_each(|(n, r)| n.points += r.shape.contains(&p) as usize);
            if !(p.x.is_finite() && p.y.is_finite() && p.z.is_finite()) {
                part.not_finite += 1;
            } else if self.stays(&p) {
                kept.extend_from_slice(row);
            }
        }
        (kept, part)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::crop::crop;
    use crate::points::Cloud;
    use stream::ply::{Encoding, Opened};
    use stream::{Table, Values};

    /// Row by row the same bytes and counts come out as from the whole cloud, for either type of number and with the position anywhere.
    #[test]
    fn rows_are_cropped_as_the_whole_cloud_is() {
        for (double, position_column) in [(false, 0), (true, 1), (false, 2)] {
            let place = |i: i32| Vec3::new(f64::from(i % 97), f64::from(i / 97), f64::from(i % 7)) / 8.0;
            let mut points: Vec<Vec3> = (0..60_000).map(place).collect();
            points[77].y = f64::NAN;
            let mut attributes = Table::with_rows(points.len());
            attributes.push("id", Values::I32((0..60_000).collect())).unwrap();
            attributes.push("tone", Values::U8((0..60_000).map(|i| i as u8).collect())).unwrap();
            let comments = vec!["a scan".to_owned()];
            let cloud = Cloud { points, attributes, double, position_column, comments, ..Cloud::default() };
            let rules = Rules {
                remove: vec!["sphere:6,30,0,5".parse().unwrap()],
                keep: vec!["box:0,0,0,11,60,0.5".parse().unwrap()],
                ..Rules::default()
            };
            let written = |cloud: &Cloud| {
                let mut bytes = Vec::new();
                crate::write_ply(&mut bytes, cloud, Encoding::default()).unwrap();
                bytes
            };
            let (whole, counts) = crop(&cloud, &rules).unwrap();
            let bytes = written(&cloud);
            let Ok(Opened::Blocks(blocks)) = Opened::new(&bytes[..]) else { panic!("plain") };
            assert!(can(&blocks, &rules));
            let (kept, same) = crop_rows(blocks, &rules).unwrap();
            let mut out = Vec::new();
            kept.write(&mut out).unwrap();
            assert_eq!(counts, same);
            assert!(counts.points_out > 1000 && counts.not_finite == 1);
            assert!(out == written(&whole));
            assert_eq!(kept.warnings, units::warnings(&cloud));
        }
    }
}
