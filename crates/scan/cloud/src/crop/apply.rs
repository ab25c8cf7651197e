//! Crop: which points stay.
//!
//! A point stays if it is in at least one `keep` (or none is given) and in no `remove`. Of the rest, points whose properties do not fulfil a condition, points beyond the outer shape, repeated ones, isolated
//! points, grazing ones, ground, scattered ones and small parts are removed on request, in this order. What a rule, or an earlier crop that only
//! marked points, removes inside a `restore` stays all the same.

use super::marks::{MARK, Reason, marks};
use super::report::{Cropped, RegionCount};
use super::rule::outer;
use super::rules::{CropError, Region, Rules};
use super::shapes::ShapeTest;
use super::sieve::{BEFORE, NOT_FINITE, Sieve};
use super::together::measure;
use crate::points::Cloud;
use crate::points::check_reach;
use geom::Vec3;
use rayon::prelude::*;

/// The points that stay, in their order, with all their properties; or all finite ones, marked.
///
/// # Errors
/// A point farther away than distances to others can be computed with, where a rule asks for them and no shape has taken it away; a rule
/// without what it needs.
pub fn crop(cloud: &Cloud, rules: &Rules) -> Result<(Cloud, Cropped), CropError> {
    let mut report = Cropped { points_in: cloud.points.len(), ..Cropped::default() };
    report.regions = rules.regions.iter().map(|region| count(&cloud.points, region)).collect();
    let judge = ShapeTest::new(rules);
    let mut sieve = Sieve::new(cloud, &judge);
    report.idle = judge.idle(rules);
    report.not_finite = sieve.count(|r| r == NOT_FINITE);
    report.outside_shapes = sieve.count(|r| r == Reason::Shape as u8);
    report.marked_before = sieve.count(|r| r & BEFORE != 0);
    refuse(cloud, rules, report.marked_before)?;
    if let Some(condition) = &rules.condition {
        let fulfilled = condition.fulfilled(cloud)?;
        let staying = (0u32..).zip(sieve.staying());
        let rows: Vec<u32> = staying.filter(|(_, (row, _))| fulfilled[*row]).map(|(at, _)| at).collect();
        report.unfulfilled = sieve.keep(Reason::Condition, &rows);
    }
    if !rules.outer.shapes.is_empty() {
        let beyond = outer::beyond(&sieve.points(), &rules.outer);
        report.beyond_outer = beyond.rows.len();
        sieve.remove(Reason::Outer, &beyond.rows);
        report.beyond = Some(beyond);
    }
    if rules.measure() {
        check_reach(sieve.staying())?;
    }
    measure(cloud, rules, &mut sieve, &mut report)?;
    report.restored = sieve.restore(&rules.restore);
    report.points_out = sieve.count(|r| r == 0);
    Ok((sieve.cloud(cloud, rules.mark), report))
}

/// Refuses what would change nothing, or needs what is not there.
fn refuse(cloud: &Cloud, rules: &Rules, marked: usize) -> Result<(), CropError> {
    let given = |option: bool, error: CropError| if option { Err(error) } else { Ok(()) };
    let foreign = marks(cloud).is_none() && cloud.attributes.get(MARK).is_some();
    given(rules.mark && foreign, CropError::OtherMarks)?;
    given(rules.mark && rules.removes_nothing() && marked == 0, CropError::NothingToMark)?;
    let none = !rules.measure() && rules.condition.is_none() && marked == 0;
    given(!rules.restore.is_empty() && none, CropError::NothingToRestore)?;
    let blind = rules.seen_from.is_empty() && cloud.viewpoints().next().is_none();
    given(rules.grazing.is_some() && blind, CropError::NoViewpoint)
}

fn count(points: &[Vec3], region: &Region) -> RegionCount {
    let inside = points.par_iter().filter(|p| region.shape.contains(p)).count();
    RegionCount { name: region.name.clone(), action: region.action, points: inside }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Shape;
    use stream::{Table, Values};

    #[test]
    fn a_point_stays_in_some_keep_and_no_remove() {
        let points: Vec<Vec3> = (0..10).map(|i| Vec3::new(i as f64, 0.0, 0.0)).collect();
        let mut attributes = Table::with_rows(11);
        attributes.push("id", Values::I32((0..11).collect())).unwrap();
        let points = [&points[..], &[Vec3::repeat(f64::NAN)]].concat();
        let cloud = Cloud { points, attributes, ..Cloud::default() };
        let shape = |text: &str| text.parse::<Shape>().unwrap();
        let rules = Rules {
            keep: vec![shape("box:0,-1,-1,3,1,1"), shape("sphere:8,0,0,1.5")],
            remove: vec![shape("sphere:2,0,0,0.5")],
            ..Rules::default()
        };
        let (kept, report) = crop(&cloud, &rules).unwrap();
        assert_eq!(kept.attributes.get("id"), Some(&Values::I32(vec![0, 1, 3, 7, 8, 9])));
        assert_eq!((report.not_finite, report.outside_shapes, report.points_out), (1, 4, 6));
        let (none, _) = crop(&Cloud::default(), &rules).unwrap();
        assert!(none.points.is_empty());
    }
}
