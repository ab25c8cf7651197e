//! Crop: which points stay.
//!
//! A point stays if it is in at least one `keep` (or none is given) and in no `remove`. Of the rest, points whose properties do not fulfil a condition, points beyond the outer shape, repeated ones, isolated
//! points, grazing ones, ground, scattered ones and small parts are removed on request, in this order. What a rule, or an earlier crop that only
//! marked points, removes inside a `restore` stays all the same.

use crate::crop_neighbours::measure;
use crate::filter::{Filter, FilterError};
use crate::ground::{Ground, GroundError, Raster};
use crate::outer::{self, Outer, Outside};
use crate::places::Crowd;
use crate::points::{TooFar, check_reach};
use crate::regions::{Action, Region};
use crate::scatter::{Scattered, TooWide};
use crate::sieve::{BEFORE, NOT_FINITE, Sieve};
pub use crate::sieve::{MARK, Reason, marks};
use crate::{Cloud, outliers};
use geom::{Shape, Vec3};
use rayon::prelude::*;
use serde::Serialize;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use thiserror::Error;

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
    /// Keep points whose properties fulfil this condition.
    pub condition: Option<Filter>,
    /// Keep points farther apart than this [m]; with 0, one of each place.
    pub distinct: Option<f64>,
    /// Remove points far from their neighbours.
    pub outliers: Option<outliers::Outliers>,
    /// Remove points whose surface every viewpoint sees at more than this angle to its normal [°].
    pub grazing: Option<f64>,
    /// Where scanners stood [m], beside the viewpoints that the cloud states.
    pub seen_from: Vec<Vec3>,
    /// Remove the ground.
    pub ground: Option<Ground>,
    /// Remove points that lie on no surface.
    pub scattered: Option<Scattered>,
    /// Keep only the largest part whose points are connected by steps of at most this [m].
    pub largest: Option<f64>,
    /// What the rules below the outer shape, or marks, remove in these shapes stays.
    pub restore: Vec<Shape>,
    /// Keep all points, and mark those that would go ([`MARK`]).
    pub mark: bool,
}

impl Rules {
    /// Whether no point can go.
    pub fn removes_nothing(&self) -> bool {
        let shapes = self.keep.len() + self.remove.len() + self.regions.len() + self.outer.shapes.len();
        shapes == 0 && self.condition.is_none() && !self.measure()
    }

    /// Whether a rule looks at points together.
    pub(crate) fn measure(&self) -> bool {
        self.distinct.is_some()
            || self.outliers.is_some()
            || self.grazing.is_some()
            || self.ground.is_some()
            || self.scattered.is_some()
            || self.largest.is_some()
    }
}

/// Why a cloud cannot be cropped.
#[derive(Debug, Clone, PartialEq, Error)]
#[allow(missing_docs)]
pub enum CropError {
    #[error("--where: {0}")]
    Condition(#[from] FilterError),
    #[error(transparent)]
    TooFar(#[from] TooFar),
    #[error(transparent)]
    Ground(#[from] GroundError),
    #[error(transparent)]
    Scattered(#[from] TooWide),
    #[error("--grazing: the cloud states no viewpoint: give --seen-from x,y,z, where the scanner stood")]
    NoViewpoint,
    #[error(
        "--restore: nothing is removed that could be restored: give a rule such as --ground (shapes are not undone), or a cloud with marks (--mark)"
    )]
    NothingToRestore,
    #[error(
        "--mark: no rule is given, and the cloud has no marks, so nothing would be marked: add --ground, --outliers …"
    )]
    NothingToMark,
    #[error("--mark: the cloud has a property '{MARK}' that --mark did not write: rename it first")]
    OtherMarks,
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
    /// Points that were marked before.
    pub marked_before: usize,
    /// Points that do not fulfil the condition.
    pub unfulfilled: usize,
    /// Points as near to another one as the rule for distinct points says.
    pub repeated: usize,
    /// Where many points lie in one place, when a rule looked at points together.
    pub crowd: Option<Crowd>,
    /// Points far from their neighbours.
    pub outliers: usize,
    /// Points whose surface lies along the line of sight.
    pub grazing: usize,
    /// Where scanners stood [m], when they were asked for.
    pub viewpoints: Vec<[f64; 3]>,
    /// Points of the ground.
    pub ground: usize,
    /// How it was found.
    pub ground_raster: Option<Raster>,
    /// Points on no surface.
    pub scattered: usize,
    /// Points of smaller parts.
    pub smaller_parts: usize,
    /// Points of these, and of those that were marked before, that were restored.
    pub restored: usize,
    /// Rules that could not judge the cloud, and why.
    pub idle: Vec<String>,
    /// Points that stay, or would where they are marked.
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
    keep: Vec<Tried<'a>>,
    remove: Vec<Tried<'a>>,
}

/// A shape, and whether it has held a point that none before it held.
struct Tried<'a> {
    shape: &'a Shape,
    counts: AtomicBool,
}

impl<'a> Tried<'a> {
    fn new(shape: &'a Shape) -> Tried<'a> {
        Tried { shape, counts: AtomicBool::new(false) }
    }

    #[inline]
    fn holds(&self, p: &Vec3) -> bool {
        let holds = self.shape.contains(p);
        if holds && !self.counts.load(Relaxed) {
            self.counts.store(true, Relaxed);
        }
        holds
    }
}

impl ShapeTest<'_> {
    pub fn new(rules: &Rules) -> ShapeTest<'_> {
        let of = |action: Action| rules.regions.iter().filter(move |r| r.action == action).map(|r| &r.shape);
        ShapeTest {
            keep: rules.keep.iter().chain(of(Action::Keep)).map(Tried::new).collect(),
            remove: rules.remove.iter().chain(of(Action::Remove)).map(Tried::new).collect(),
        }
    }

    /// Shapes without a name that change nothing, once all points were seen.
    pub fn idle(&self, rules: &Rules) -> Vec<String> {
        let of = |option: &str, given: usize, tried: &[Tried]| {
            let idle = tried.iter().take(given).enumerate().filter(|(_, tried)| !tried.counts.load(Relaxed));
            idle.map(|(k, _)| {
                let which = if given > 1 { format!(" (number {})", k + 1) } else { String::new() };
                if k == 0 && (option == "--keep" || self.keep.is_empty()) {
                    format!("{option}{which} holds no point: compare its coordinates and their unit with those of the cloud")
                } else {
                    format!("{option}{which} changes nothing: it holds no point that other shapes leave to it")
                }
            })
            .collect::<Vec<String>>()
        };
        [of("--keep", rules.keep.len(), &self.keep), of("--remove", rules.remove.len(), &self.remove)]
            .concat()
    }

    /// Whether a point [m] stays, as far as shapes say.
    #[inline]
    pub fn stays(&self, p: &Vec3) -> bool {
        (self.keep.is_empty() || self.keep.iter().any(|s| s.holds(p)))
            && !self.remove.iter().any(|s| s.holds(p))
    }
}

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
