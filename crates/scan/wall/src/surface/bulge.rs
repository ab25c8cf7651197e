//! Bulges: where wall spheres whose surfaces pass through the points stick out of the scanned surface beside them.
//!
//! A sphere lies behind its own point. Where the surface bends outwards more tightly than the sphere, at an edge or a rod, or where the structure is
//! thinner than it, the sphere covers other points.

use geom::{Grid, Vec3};
use serde::Serialize;

/// About so many points are checked.
const LOOKED_AT: usize = 2000;
/// A point that lies deeper than this in a sphere counts, over the distance of neighbours [–]: noise is less.
const COUNTS: f64 = 0.25;
/// A warning is given from this share of the points on [–]: a corner covers only a few.
const TOLD: f64 = 0.02;

/// The spheres that stick out of the surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bulges {
    /// Share of the points that spheres of other points cover [–].
    pub share: f64,
    /// The point that lies deepest [m].
    pub at: [f64; 3],
    /// How deep that point lies in the sphere [m].
    pub depth: f64,
    /// Radius of the sphere that covers it [m].
    pub radius: f64,
}

/// Where points [m] lie inside the spheres of others; `spacing` [m] is that of neighbours. `None` where few do.
pub(crate) fn find(points: &[Vec3], centres: &[Vec3], radii: &[f64], spacing: f64) -> Option<Bulges> {
    let largest = radii.iter().copied().fold(0.0, f64::max);
    let grid = Grid::new(centres, largest.max(spacing));
    let deepest = |slot: usize| {
        let within = grid.within(centres, points[slot], largest).map(|k| k as usize);
        let inside = within.map(|k| (radii[k] - (points[slot] - centres[k]).norm(), k));
        inside.max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))
    };
    let looked: Vec<usize> = (0..points.len()).step_by(points.len().div_ceil(LOOKED_AT).max(1)).collect();
    let found = looked.iter().filter_map(|&slot| Some((slot, deepest(slot)?)));
    let covered: Vec<_> = found.filter(|(_, (depth, _))| *depth > COUNTS * spacing).collect();
    let share = covered.len() as f64 / looked.len() as f64;
    let (slot, (depth, k)) = covered.into_iter().max_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
    (share >= TOLD).then_some(Bulges { share, at: points[slot].into(), depth, radius: radii[k] })
}
