//! Who may touch whom until something has moved half a skin: the Verlet list.
//!
//! Verlet (1967), Phys. Rev. 159. Pairs are found once each, in the order of the grid's sorted places, so that the list is a
//! function of positions alone.

use geom::{Grid, Vec3};
use rayon::prelude::*;

const CHUNK: usize = 512;

/// A pair of particles, i < j.
type Pair = (u32, u32);

/// Some pairs, in order.
pub type Pairs = Vec<Pair>;

/// Pairs of `points` [m] (in the grid's sorted order) whose surfaces are closer than `skin` [m], in pieces that follow each other.
pub fn pairs(points: &[Vec3], radii: &[f64], grid: &Grid, largest: f64, skin: f64) -> Vec<Pairs> {
    (0..points.len().div_ceil(CHUNK))
        .into_par_iter()
        .map(|c| {
            let mut found = Vec::with_capacity(CHUNK * 5);
            for i in c * CHUNK..((c + 1) * CHUNK).min(points.len()) {
                scan(i, points, radii, grid, largest, skin, &mut found);
            }
            found
        })
        .collect()
}

fn scan(
    i: usize,
    points: &[Vec3],
    radii: &[f64],
    grid: &Grid,
    largest: f64,
    skin: f64,
    found: &mut Vec<Pair>,
) {
    let (p, r) = (points[i], radii[i] + skin);
    let reach = r + largest;
    for run in grid.runs_near(p, reach) {
        if run.end <= i {
            continue;
        }
        for j in run.start.max(i + 1)..run.end {
            let close = r + radii[j];
            if (points[j] - p).norm_squared() < close * close {
                found.push((i as u32, j as u32));
            }
        }
    }
}
