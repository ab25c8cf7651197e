//! Crop: which points stay.
//!
//! A point stays if it is in at least one `keep` (or none is given) and in no `remove`. Of the rest, points beyond the outer shape,
//! isolated points and small parts are removed on request.

use crate::outer::{self, Outer, Outside};
use crate::points::{TooFar, check_reach};
use crate::regions::{Action, Region};
use crate::{Cloud, largest, outliers};
use geom::{Shape, Vec3};
use rayon::prelude::*;
use serde::Serialize;

/// Points judged by one task.
const CHUNK: usize = 1 << 14;

/// What to keep.
#[derive(Debug, Clone, Default)]
pub struct Rules {
    /// Keep the points of these shapes; all when there is none.
    pub keep: Vec<Shape>,
    /// Remove the points of these shapes.
    pub remove: Vec<Shape>,
    /// Named regions to keep and to remove; they count as the shapes above do.
    pub regions: Vec<Region>,
    /// Remove what lies beyond the outer shape, when one is described.
    pub outer: Outer,
    /// Remove points far from their neighbours.
    pub outliers: Option<outliers::Outliers>,
    /// Keep only the largest part whose points are connected by steps of at most this [m].
    pub largest: Option<f64>,
}

/// What was kept and why not.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Cropped {
    /// Points that came in.
    pub points_in: usize,
    /// Points without finite coordinates.
    pub not_finite: usize,
    /// Points that the shapes took away.
    pub outside_shapes: usize,
    /// Points of each named region, whatever the other rules make of them.
    pub regions: Vec<RegionCount>,
    /// Points beyond the outer shape.
    pub beyond_outer: usize,
    /// The parts that they make up, when an outer shape is described.
    pub beyond: Option<Outside>,
    /// Points far from their neighbours.
    pub outliers: usize,
    /// Points of smaller parts.
    pub smaller_parts: usize,
    /// Points that stay.
    pub points_out: usize,
}

/// Points of a named region.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct RegionCount {
    /// Its name.
    pub name: String,
    /// What is done with them.
    pub action: Action,
    /// How many.
    pub points: usize,
}

impl Cropped {
    /// Nothing counted yet.
    pub(crate) fn of(rules: &Rules) -> Cropped {
        let none = |r: &Region| RegionCount { name: r.name.clone(), action: r.action, points: 0 };
        Cropped { regions: rules.regions.iter().map(none).collect(), ..Cropped::default() }
    }

    /// Adds what shapes alone count in a part of the cloud.
    pub(crate) fn add(&mut self, part: &Cropped) {
        self.not_finite += part.not_finite;
        self.regions.iter_mut().zip(&part.regions).for_each(|(all, part)| all.points += part.points);
    }
}

/// Shapes that a point is in, or not.
pub(crate) struct ShapeTest<'a> {
    keep: Vec<&'a Shape>,
    remove: Vec<&'a Shape>,
}

impl ShapeTest<'_> {
    pub fn new(rules: &Rules) -> ShapeTest<'_> {
        let of = |action: Action| rules.regions.iter().filter(move |r| r.action == action).map(|r| &r.shape);
        ShapeTest {
            keep: rules.keep.iter().chain(of(Action::Keep)).collect(),
            remove: rules.remove.iter().chain(of(Action::Remove)).collect(),
        }
    }

    /// Whether a point [m] stays, as far as shapes say.
    #[inline]
    pub fn stays(&self, p: &Vec3) -> bool {
        (self.keep.is_empty() || self.keep.iter().any(|s| s.contains(p)))
            && !self.remove.iter().any(|s| s.contains(p))
    }
}

/// The points that stay, in their order, with all their properties.
///
/// # Errors
/// A point farther away than distances to others can be computed with, where a rule asks for them and no shape has taken it away.
pub fn crop(cloud: &Cloud, rules: &Rules) -> Result<(Cloud, Cropped), TooFar> {
    let points = &cloud.points;
    let is_finite = |p: &Vec3| p.x.is_finite() && p.y.is_finite() && p.z.is_finite();
    let judge = ShapeTest::new(rules);
    let judged: Vec<(Vec<u32>, usize)> = points
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(chunk, points)| {
            let first = (chunk * CHUNK) as u32;
            let finite = (first..).zip(points).filter(|(_, p)| is_finite(p));
            let bad = points.len() - finite.clone().count();
            (finite.filter(|(_, p)| judge.stays(p)).map(|(i, _)| i).collect(), bad)
        })
        .collect();
    let not_finite = judged.iter().map(|(_, bad)| bad).sum();
    let mut rows: Vec<u32> = judged.into_iter().flat_map(|(rows, _)| rows).collect();
    let mut report = Cropped { points_in: points.len(), not_finite, ..Cropped::default() };
    report.outside_shapes = points.len() - not_finite - rows.len();
    report.regions = rules.regions.iter().map(|region| count(points, region)).collect();
    if !rules.outer.shapes.is_empty() {
        let some: Vec<Vec3> = rows.iter().map(|&r| points[r as usize]).collect();
        let beyond = outer::beyond(&some, &rules.outer);
        report.beyond_outer = beyond.rows.len();
        rows = without(rows, &beyond.rows);
        report.beyond = Some(beyond);
    }
    if rules.outliers.is_some() || rules.largest.is_some() {
        check_reach(rows.iter().map(|&r| (r as usize, &points[r as usize])))?;
    }
    if let Some(rule) = &rules.outliers {
        let before = rows.len();
        rows = refine(points, rows, |p| outliers::inliers(p, rule));
        report.outliers = before - rows.len();
    }
    if let Some(radius) = rules.largest {
        let before = rows.len();
        rows = refine(points, rows, |p| largest::largest(p, radius));
        report.smaller_parts = before - rows.len();
    }
    report.points_out = rows.len();
    let all = rows.len() == points.len();
    Ok((if all { cloud.clone() } else { cloud.select(&rows) }, report))
}

fn count(points: &[Vec3], region: &Region) -> RegionCount {
    let inside = points.par_iter().filter(|p| region.shape.contains(p)).count();
    RegionCount { name: region.name.clone(), action: region.action, points: inside }
}

/// The rows without those at the given ascending places.
fn without(rows: Vec<u32>, places: &[u32]) -> Vec<u32> {
    let mut gone = places.iter().copied().peekable();
    let all = (0..).zip(rows);
    all.filter_map(|(place, row): (u32, u32)| gone.next_if_eq(&place).is_none().then_some(row)).collect()
}

/// The rows that `choose` picks from the points of `rows`.
fn refine(points: &[Vec3], rows: Vec<u32>, choose: impl Fn(&[Vec3]) -> Vec<u32>) -> Vec<u32> {
    let some: Vec<Vec3> = rows.iter().map(|&r| points[r as usize]).collect();
    choose(&some).into_iter().map(|i| rows[i as usize]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
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
