//! Points that lie on no surface, but fill space: leaves and branches, sparks, rain.
//!
//! ```text
//! cells      of width RADIUS/3; each that holds points counts as one point, the mean of them: noise below a cell averages out, and density does
//!            not matter
//! variation  λ₀/(λ₀ + λ₁ + λ₂) of the covariance of the cells within RADIUS, λ₀ its least eigenvalue: 0 on a plane, 1/3 where they fill space
//! scattered  the mean variation of the cells within RADIUS is at least SHARE
//! ```
//!
//! Surface variation: Pauly, Gross & Kobbelt (2002), doi:10.1109/VISUAL.2002.1183771.

use geom::{Grid, Vec3, least_axis};
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::str::FromStr;
use thiserror::Error;

/// Cells for a radius.
const CELLS: f64 = 3.0;

/// When points are too scattered for a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scattered {
    /// Reach of the neighbours that are looked at [m].
    pub radius: f64,
    /// Mean variation from which on a point is scattered [–].
    pub share: f64,
}

/// Why a text is not `RADIUS,SHARE`.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "'{0}' is not RADIUS,SHARE: give a length above 0 [m] and a variation above 0 and up to 0.333, such as 0.2,0.1"
)]
pub struct ScatteredError(String);

impl FromStr for Scattered {
    type Err = ScatteredError;

    fn from_str(text: &str) -> Result<Scattered, ScatteredError> {
        let wrong = || ScatteredError(text.to_owned());
        let (radius, share) = text.split_once(',').ok_or_else(wrong)?;
        let [radius, share] = [radius, share].map(|n| geom::number::positive(n.trim()));
        match (radius, share) {
            (Ok(radius), Ok(share)) if share <= 1.0 / 3.0 => Ok(Scattered { radius, share }),
            _ => Err(wrong()),
        }
    }
}

/// Rows of the finite `points` [m] that are not scattered, in order.
pub fn compact(points: &[Vec3], rule: &Scattered) -> Vec<u32> {
    if points.is_empty() {
        return Vec::new();
    }
    let cells = Grid::new(points, rule.radius / CELLS);
    let (_, starts) = cells.filled();
    let rows = |run: &[u32]| &cells.order()[run[0] as usize..run[1] as usize];
    let mean = |run: &[u32]| {
        let rows = rows(run);
        rows.iter().map(|&i| points[i as usize]).sum::<Vec3>() / rows.len() as f64
    };
    let means: Vec<Vec3> = starts.par_windows(2).map(mean).collect();
    let grid = Grid::new(&means, rule.radius);
    let near = |p: &Vec3| -> Vec<u32> { grid.within(&means, *p, rule.radius).collect() };
    let variations: Vec<f64> =
        means.par_iter().map(|p| variation(&covariance(&means, p, &near(p)))).collect();
    let is_scattered = |p: &Vec3| {
        let near = near(p);
        let sum: f64 = near.iter().map(|&c| variations[c as usize]).sum();
        sum >= rule.share * near.len() as f64
    };
    let scattered: Vec<bool> = means.par_iter().map(is_scattered).collect();
    let runs = starts.windows(2).zip(scattered).filter(|(_, scattered)| !scattered);
    let mut stay: Vec<u32> = runs.flat_map(|(run, _)| rows(run)).copied().collect();
    stay.sort_unstable();
    stay
}

/// Of some of the points, about their mean; `p` is one of them, or near.
fn covariance(points: &[Vec3], p: &Vec3, rows: &[u32]) -> Matrix3<f64> {
    let off = |i: &u32| points[*i as usize] - p;
    let count = rows.len() as f64;
    let mean = rows.iter().map(off).sum::<Vec3>() / count;
    rows.iter().map(off).map(|d| (d - mean) * (d - mean).transpose()).sum::<Matrix3<f64>>() / count
}

/// λ₀ over the sum of all, of a covariance.
fn variation(covariance: &Matrix3<f64>) -> f64 {
    let trace = covariance.trace();
    let least = least_axis(covariance).map_or(0.0, |axis| axis.dot(&(covariance * axis)));
    if trace > 0.0 { (least / trace).max(0.0) } else { 0.0 }
}
