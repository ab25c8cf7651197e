//! Distances to the nearest other point: how even a cloud is.

use crate::cells::Cells;
use geom::{Grid, Vec3};
use rayon::prelude::*;
use serde::Serialize;

/// Points that stand for all.
const TYPICAL: usize = 4096;

/// Statistics of the distance from each point to the nearest other one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct NearestDistances {
    /// Least of the distances [m].
    pub min: f64,
    /// Mean of the distances [m].
    pub mean: f64,
    /// Median of the distances [m].
    pub median: f64,
    /// Standard deviation over mean [–].
    pub variation: f64,
}

/// Statistics of the nearest distances; `None` for fewer than two points.
pub fn nearest_distances(points: &[Vec3]) -> Option<NearestDistances> {
    let mut distances = distances(points);
    if distances.len() < 2 {
        return None;
    }
    let count = distances.len() as f64;
    let mean = distances.iter().sum::<f64>() / count;
    let variance = distances.iter().map(|d| (d - mean) * (d - mean)).sum::<f64>() / count;
    let variation = if mean > 0.0 { variance.sqrt() / mean } else { 0.0 };
    let (_, &mut median, _) = distances.select_nth_unstable_by(points.len() / 2, f64::total_cmp);
    let min = distances.iter().copied().fold(f64::INFINITY, f64::min);
    Some(NearestDistances { min, mean, median, variation })
}

/// Distance [m] from each point to the nearest other one, by index; empty for fewer than two points.
pub fn distances(points: &[Vec3]) -> Vec<f64> {
    let mut nearest = vec![f64::INFINITY; points.len()];
    if points.len() < 2 {
        return Vec::new();
    }
    let mut open: Vec<u32> = (0..points.len() as u32).collect();
    let mut reach = first_reach(points);
    // Points without a neighbour in reach are tried again with twice the reach, against all points.
    while !open.is_empty() {
        let cells = Cells::new(points, reach);
        let slot_of = cells.slots();
        let found: Vec<f64> =
            open.par_iter().map(|&i| nearest_in(&cells, slot_of[i as usize], reach)).collect();
        for (&i, d) in open.iter().zip(&found) {
            nearest[i as usize] = *d;
        }
        open.retain(|&i| nearest[i as usize].is_infinite());
        reach *= 2.0;
    }
    nearest
}

/// Median distance [m] to the nearest other point, of an even part of the points: a quick measure to choose a reach by. `None` when
/// it is zero, or for fewer than two points.
pub fn typical(points: &[Vec3]) -> Option<f64> {
    if points.len() < 2 {
        return None;
    }
    let stride = points.len().div_ceil(TYPICAL);
    let mut reach = first_reach(points);
    loop {
        let grid = Grid::new(points, reach);
        let nearest = |&i: &u32| {
            let near = grid.within(points, points[i as usize], reach).filter(|&j| j != i);
            let square = |j: u32| (points[j as usize] - points[i as usize]).norm_squared();
            near.map(square).fold(f64::INFINITY, f64::min).sqrt()
        };
        let some: Vec<u32> = grid.order().iter().copied().step_by(stride).collect();
        let mut found: Vec<f64> = some.par_iter().map(nearest).collect();
        let middle = found.len() / 2;
        let median = *found.select_nth_unstable_by(middle, f64::total_cmp).1;
        if median.is_finite() {
            return (median > 0.0).then_some(median);
        }
        reach *= 2.0;
    }
}

/// Place in `kept` of the kept point nearest to each point.
pub(crate) fn owners(points: &[Vec3], kept: &[u32], spacing: f64) -> Vec<u32> {
    let chosen: Vec<Vec3> = kept.iter().map(|&i| points[i as usize]).collect();
    let grid = Grid::new(&chosen, spacing);
    points.par_iter().map(|p| grid.nearest(&chosen, *p, spacing).unwrap_or(0)).collect()
}

fn nearest_in(cells: &Cells, slot: u32, reach: f64) -> f64 {
    let mut least = f64::INFINITY;
    cells.each_near(slot, reach, |other, square| {
        if other != slot {
            least = least.min(square);
        }
    });
    least.sqrt()
}

/// Spacing of the points were they spread evenly over the two longest sides of their box [m].
fn first_reach(points: &[Vec3]) -> f64 {
    let (lo, hi) = geom::grid::bounds(points);
    let mut sides = [hi.x - lo.x, hi.y - lo.y, hi.z - lo.z];
    sides.sort_by(f64::total_cmp);
    let count = points.len() as f64;
    let even = (sides[2] * sides[1].max(sides[2] / count) / count).sqrt();
    let scale = lo.abs().max().max(hi.abs().max()).max(1e-9);
    even.max(1e-12 * scale)
}
