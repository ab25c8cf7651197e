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

use geom::{Grid, Shown, Vec3, grid, least_axis};
use nalgebra::Matrix3;
use rayon::prelude::*;
use serde::Serialize;
use std::str::FromStr;
use thiserror::Error;

/// Cells in a radius.
const CELLS: f64 = 3.0;
/// Smallest radius [m].
const LEAST: f64 = 1e-6;
/// With fewer cells in the radius, nothing is known of a surface.
const ENOUGH: usize = 6;

/// The rule: from which variation on points lie on no surface.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Scattered {
    /// Radius in which the neighbours of a point are taken [m].
    pub radius: f64,
    /// A point with at least this mean variation is scattered [–].
    pub share: f64,
}

/// Why a text is not `RADIUS,SHARE`.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "'{0}' is not RADIUS,SHARE: give a length of {LEAST:e} m or more and a variation above 0 and up to 0.333, such as 0.2,0.1"
)]
pub struct ScatteredError(String);

impl FromStr for Scattered {
    type Err = ScatteredError;

    fn from_str(text: &str) -> Result<Scattered, ScatteredError> {
        let wrong = || ScatteredError(text.to_owned());
        let (radius, share) = text.split_once(',').ok_or_else(wrong)?;
        let [radius, share] = [radius, share].map(|n| geom::number::positive(n.trim()));
        match (radius, share) {
            (Ok(radius), Ok(share)) if radius >= LEAST && share <= 1.0 / 3.0 => {
                Ok(Scattered { radius, share })
            }
            _ => Err(wrong()),
        }
    }
}

/// Why a cloud cannot be judged.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "--scattered: the cloud spans {} m, too much for cells of {} m (a third of RADIUS): remove points far away first (--outliers 12,3 in the same \
     command, or --keep SHAPE)", Shown(*.span), Shown(*.cell)
)]
pub struct TooWide {
    /// Longest side of the box of the points [m].
    span: f64,
    /// Width of the cells that the rule asks for [m].
    cell: f64,
}

/// The points on surfaces, and whether the radius was too small to tell.
#[derive(Debug, Clone, PartialEq)]
pub struct Compact {
    /// Rows that are not scattered, in order.
    pub rows: Vec<u32>,
    /// Whether most points have too few others within the radius to lie on a surface or not.
    pub sparse: bool,
}

/// Judges the finite `points` [m].
///
/// # Errors
/// Points so far apart that cells would be wider than a third of the radius.
pub fn compact(points: &[Vec3], rule: &Scattered) -> Result<Compact, TooWide> {
    if points.is_empty() {
        return Ok(Compact { rows: Vec::new(), sparse: false });
    }
    let cells = Grid::new(points, rule.radius / CELLS);
    if cells.cell() > rule.radius / CELLS {
        let (low, high) = grid::bounds(points);
        return Err(TooWide { span: (high - low).max(), cell: rule.radius / CELLS });
    }
    let (_, starts) = cells.filled();
    let rows = |run: &[u32]| &cells.order()[run[0] as usize..run[1] as usize];
    let mean = |run: &[u32]| {
        let rows = rows(run);
        rows.iter().map(|&i| points[i as usize]).sum::<Vec3>() / rows.len() as f64
    };
    let means: Vec<Vec3> = starts.par_windows(2).map(mean).collect();
    let reach = Grid::new(&means, rule.radius);
    let near = |p: &Vec3| -> Vec<u32> { reach.within(&means, *p, rule.radius).collect() };
    let variations: Vec<f64> =
        means.par_iter().map(|p| variation(&covariance(&means, p, &near(p)))).collect();
    let judge = |p: &Vec3| {
        let near = near(p);
        let sum: f64 = near.iter().map(|&c| variations[c as usize]).sum();
        (sum >= rule.share * near.len() as f64, near.len() < ENOUGH)
    };
    let judged: Vec<(bool, bool)> = means.par_iter().map(judge).collect();
    let runs = starts.windows(2).zip(&judged).filter(|(_, (scattered, _))| !scattered);
    let mut stay: Vec<u32> = runs.flat_map(|(run, _)| rows(run)).copied().collect();
    stay.sort_unstable();
    let few = judged.iter().filter(|(_, few)| *few).count();
    Ok(Compact { rows: stay, sparse: 2 * few > judged.len() })
}

/// Covariance of some of the points about their mean; `p` is one of them, or near them.
fn covariance(points: &[Vec3], p: &Vec3, rows: &[u32]) -> Matrix3<f64> {
    let off = |i: &u32| points[*i as usize] - p;
    let count = rows.len() as f64;
    let mean = rows.iter().map(off).sum::<Vec3>() / count;
    rows.iter().map(off).map(|d| (d - mean) * (d - mean).transpose()).sum::<Matrix3<f64>>() / count
}

/// Surface variation of a covariance: λ₀ over the sum of its eigenvalues.
fn variation(covariance: &Matrix3<f64>) -> f64 {
    let trace = covariance.trace();
    let least = least_axis(covariance).map_or(0.0, |axis| axis.dot(&(covariance * axis)));
    if trace > 0.0 { (least / trace).max(0.0) } else { 0.0 }
}
