//! Ground or floor that need not be flat, by the progressive morphological filter: Zhang et al. (2003), doi:10.1109/TGRS.2003.810682.
//!
//! ```text
//! lowest     z of the lowest point in each cell of a raster of width c
//! opening    with squares of w₁ < w₂ < … ≤ WIDTH/c cells: what is narrower goes (erosion, then dilation)
//! object     a cell that opening k lowers by more than  h + s c (wₖ − wₖ₋₁)      eq. 8; h = HEIGHT, s = SLOPE
//! surface    the cells that are no objects, and between them a smooth surface (pull and push)
//! ground     points at most  h + c |∇surface|/2  above or below the surface
//! ```
//!
//! z points upwards. Cells hold about four points, and the raster has no more cells than a few for each point.

mod heights;

use crate::density;
use geom::{Vec3, grid};
use heights::Heights;
use rayon::prelude::*;
use std::str::FromStr;
use thiserror::Error;

/// Points of a cell, about.
const POINTS: f64 = 4.0;
/// Share of the surface that is sparser.
const SPARSE: f64 = 0.2;
/// Most cells for each point.
const MOST: f64 = 16.0;
/// A window is at least so many cells wide: what is narrower looks like the ground.
const FEWEST: f64 = 3.0;
/// Steepest ground where none is given [–].
const SLOPE: f64 = 0.3;

/// What counts as ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ground {
    /// Width of the widest thing that stands on it [m].
    pub width: f64,
    /// How far above or below it a point may be and still be ground [m].
    pub height: f64,
    /// Steepest slope of it [–].
    pub slope: f64,
}

/// Why a text is not `WIDTH,HEIGHT` or `WIDTH,HEIGHT,SLOPE`.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "'{0}' is not WIDTH,HEIGHT or WIDTH,HEIGHT,SLOPE: give the width of the widest thing on the ground [m], how far from the ground \
     a point may be [m], and its steepest slope, such as 3,0.05 or 3,0.05,0.3"
)]
pub struct GroundTextError(String);

impl FromStr for Ground {
    type Err = GroundTextError;

    fn from_str(text: &str) -> Result<Ground, GroundTextError> {
        let wrong = || GroundTextError(text.to_owned());
        let numbers: Vec<f64> = text
            .split(',')
            .map(|n| geom::number::positive(n.trim()).map_err(|_| wrong()))
            .collect::<Result<_, _>>()?;
        match numbers[..] {
            [width, height] => Ok(Ground { width, height, slope: SLOPE }),
            [width, height, slope] => Ok(Ground { width, height, slope }),
            _ => Err(wrong()),
        }
    }
}

/// Why no ground can be found.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error(
    "--ground: a thing of {width} m has fewer than {FEWEST} cells of {cell:.3} m, which hold about {POINTS} points each: give the width of \
     the widest thing on the ground, and remove points far away first (--keep, --largest)"
)]
pub struct GroundError {
    /// Width of the widest thing [m].
    width: f64,
    /// Width of a cell [m].
    cell: f64,
}

/// Rows of the finite `points` [m] that are not ground, in order.
///
/// # Errors
/// Cells that are too wide for the rule.
pub fn above(points: &[Vec3], rule: &Ground) -> Result<Vec<u32>, GroundError> {
    let Some(cell) = cell(points) else { return Ok((0..points.len() as u32).collect()) };
    if !(cell * FEWEST <= rule.width) {
        return Err(GroundError { width: rule.width, cell });
    }
    let lowest = Heights::lowest(points, cell);
    let surface = lowest.without(&objects(&lowest, rule)).filled();
    let is_above = |p: &Vec3| {
        let (z, slope) = surface.at(p);
        (p.z - z).abs() > rule.height + 0.5 * cell * slope.min(rule.slope)
    };
    let above: Vec<bool> = points.par_iter().map(is_above).collect();
    Ok((0u32..).zip(above).filter(|(_, above)| *above).map(|(i, _)| i).collect())
}

/// Width of the cells [m]; none where points are too few or all at one place.
fn cell(points: &[Vec3]) -> Option<f64> {
    let flat: Vec<Vec3> = points.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect();
    let density = density::sparse(&flat, SPARSE)?;
    let (low, high) = grid::bounds(&flat);
    let least = ((high.x - low.x) * (high.y - low.y) / (MOST * points.len() as f64)).sqrt();
    // A line of points has an area of zero, and cells all the same.
    let least = least.max((high - low).amax() / (MOST * points.len() as f64));
    let cell = (POINTS / density).sqrt().max(least);
    (cell > 0.0 && cell.is_finite()).then_some(cell)
}

/// Cells that openings lower by more than the ground can rise.
fn objects(lowest: &Heights, rule: &Ground) -> Vec<bool> {
    let widest = ((rule.width / lowest.cell) as usize).min(lowest.widest());
    let mut objects = vec![false; lowest.cells()];
    let (mut surface, mut before, mut width) = (lowest.clone(), 1, 1usize);
    while before < widest {
        width = (width + width.div_ceil(4)).min(widest);
        let opened = surface.opened(width / 2);
        let step = rule.height + rule.slope * lowest.cell * (width - before) as f64;
        surface.lowered_by_more(&opened, step).for_each(|k| objects[k] = true);
        (surface, before) = (opened, width);
    }
    objects
}
