//! A wall, and what was built.

use crate::radii::dents::DeepDents;
use crate::radii::solve::{Changed, Changes};
use crate::settings::Representative;
use crate::surface::bulge::Bulges;
use crate::surface::leak;
use crate::surface::sheets::Sheets;
use geom::Vec3;
use serde::Serialize;

/// Wall spheres.
#[derive(Debug, Clone, PartialEq)]
pub struct Wall {
    /// Centres [m], in the order of the points.
    pub centres: Vec<Vec3>,
    /// Radii [m].
    pub radii: Vec<f64>,
    /// Region of each sphere; 0 outside of all.
    pub regions: Vec<u16>,
}

/// What was built, for the report.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WallReport {
    pub spheres: usize,
    /// Representative distance of neighbours P [m].
    pub spacing: f64,
    /// Shortest and longest distance of a pair [m].
    pub spacing_range: [f64; 2],
    /// Representative roughness ζ [m]: the one asked for, or what the given radius makes.
    pub roughness: f64,
    /// Least, mean and largest radius [m].
    pub radius_range: [f64; 3],
    /// Longest side of the box around the points [m].
    pub width: f64,
    /// How far the least and the most of the wall stands in front of the points [m]: the radii where the centres are on the points, `None` where the
    /// surface is.
    pub in_front: Option<[f64; 2]>,
    /// A radius of curvature that a quarter of the surface falls below [m], where the wall stands in front of it.
    pub curvature_radius: Option<f64>,
    /// How far the dents are from those asked for.
    pub changes: Changes,
    /// The pairs of which `changes` tells, where they were asked for.
    #[serde(skip)]
    pub changed: Vec<Changed>,
    /// Where the wall cannot have the roughness that was asked for; `None` when nowhere.
    pub deep_dents: Option<DeepDents>,
    /// The widest gap; `None` when not asked for or when there is none.
    pub widest_gap: Option<leak::Gap>,
    /// Gaps that the smallest particle passes.
    pub leaks: usize,
    /// Gaps wider than this [m] between three points cannot be distinguished from the outline.
    pub gaps_up_to: f64,
    /// Where two sheets of the surface are closer than the spacing; `None` when nowhere.
    pub sheets: Option<Sheets>,
    /// Where spheres on the points' other side stick out; `None` where the centres are on the points, and when nowhere.
    pub bulges: Option<Bulges>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// The value that stands for all.
pub(crate) fn representative(values: &[f64], which: Representative) -> f64 {
    let middle = values.len() / 2;
    match which {
        // The mean of equal numbers is that number, not one beside it.
        Representative::Mean if range(values)[0] == range(values)[1] => values[0],
        Representative::Mean => values.iter().sum::<f64>() / values.len() as f64,
        Representative::Median => *values.to_vec().select_nth_unstable_by(middle, f64::total_cmp).1,
    }
}

/// The least and the largest value.
pub(crate) fn range(values: &[f64]) -> [f64; 2] {
    values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], &v| [lo.min(v), hi.max(v)])
}
