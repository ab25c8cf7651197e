//! Ground or floor that need not be flat, by a progressive morphological filter: Zhang et al. (2003), doi:10.1109/TGRS.2003.810682.
//!
//! ```text
//! lowest     z of the lowest point in each cell of a raster of width c
//! pit        a cell that is lower by more than  h + 2 s c  than all but two of the cells up to two away: noise below the ground
//! opening    erosion, then dilation, with squares that reach r₁ < r₂ < … ≥ WIDTH/2c cells to each side: what is narrower goes
//! object     a cell that opening k lowers by more than  h + 2 s c (rₖ − rₖ₋₁);  h = HEIGHT, s = SLOPE        eq. 8
//! surface    the cells that are neither, and between them a smooth surface (pull and push)
//! ground     points at most  h + c |∇surface|/2  above or below the surface
//! ```
//!
//! Reaches grow by a sixteenth, so the largest step is h + s WIDTH/16, and what is lower may be taken for ground. Squares lie wholly within the raster,
//! or what stands in its corners would need squares twice as wide; cells without points, as in shadows, have the lowest height nearby. z points
//! upwards. Cells hold about four points, and the raster has no more cells than a few for each point.

mod heights;

use crate::neighbours::density;
use geom::{Shown, Vec3, grid};
use heights::Heights;
use rayon::prelude::*;
use serde::Serialize;
use std::str::FromStr;
use thiserror::Error;

/// Points of a cell, about.
const POINTS: f64 = 4.0;
/// Share of the surface that is sparser.
const SPARSE: f64 = 0.2;
/// Most cells for each point.
const MOST: f64 = 16.0;
/// Cells of the widest thing, at least: what is narrower looks like the ground.
const FEWEST: f64 = 3.0;
/// Steepest ground where none is given [–].
const SLOPE: f64 = 0.3;

/// What counts as ground.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
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
        let number = |n: &str| geom::number::positive(n.trim()).map_err(|_| wrong());
        let numbers: Vec<f64> = text.split(',').map(number).collect::<Result<_, _>>()?;
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
    "--ground: a thing of {} m has fewer than {FEWEST} cells of {} m, which hold about {POINTS} points each in a cloud that spans {} m: give the \
     width of the widest thing on the ground, and remove points far away first (--outliers 12,3 in the same command, or --keep SHAPE)",
    Shown(*.width), Shown(*.cell), Shown(*.span)
)]
pub struct GroundError {
    /// Width of the widest thing [m].
    width: f64,
    /// Width of a cell [m].
    cell: f64,
    /// Longest side of the box of the points [m].
    span: f64,
}

/// The points above the ground, and how the ground was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Above {
    /// Rows that are not ground, in order.
    pub rows: Vec<u32>,
    /// How it was found; `None`: too few points to tell, and none is ground.
    pub raster: Option<Raster>,
}

/// How ground was found.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Raster {
    /// Width of a cell [m].
    pub cell: f64,
    /// Lower things may be taken for ground [m].
    pub largest_step: f64,
    /// Cells whose lowest point is noise below the ground.
    pub pits: usize,
}

/// Which of the finite `points` [m] are not ground.
///
/// # Errors
/// Cells that are too wide for the rule.
pub fn above(points: &[Vec3], rule: &Ground) -> Result<Above, GroundError> {
    let Some(cell) = cell(points) else {
        return Ok(Above { rows: (0..points.len() as u32).collect(), raster: None });
    };
    if !(cell * FEWEST <= rule.width) {
        let (low, high) = grid::bounds(points);
        return Err(GroundError { width: rule.width, cell, span: (high - low).max() });
    }
    let lowest = Heights::lowest(points, cell);
    let mut gone = lowest.pits(rule.height + 2.0 * rule.slope * cell);
    let pits = gone.iter().filter(|pit| **pit).count();
    let largest_step = objects(&lowest.without(&gone), rule, &mut gone);
    let surface = lowest.without(&gone).filled();
    let is_above = |p: &Vec3| {
        let (z, slope) = surface.at(p);
        (p.z - z).abs() > rule.height + 0.5 * cell * slope.min(rule.slope)
    };
    let above: Vec<bool> = points.par_iter().map(is_above).collect();
    let rows = (0u32..).zip(above).filter(|(_, above)| *above).map(|(i, _)| i).collect();
    Ok(Above { rows, raster: Some(Raster { cell, largest_step, pits }) })
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

/// Adds the cells that openings lower by more than the ground can rise; the largest step [m].
fn objects(lowest: &Heights, rule: &Ground, gone: &mut [bool]) -> f64 {
    // A square is wider than the widest thing wherever that lies on the raster.
    let farthest = ((0.5 * rule.width / lowest.cell) as usize).min(lowest.widest()) + 1;
    let (mut surface, mut before, mut largest) = (lowest.clone().lowered(), 0, 0.0f64);
    while before < farthest {
        let reach = (before + 1 + before / 16).min(farthest);
        let opened = surface.opened(reach);
        let step = rule.height + 2.0 * rule.slope * lowest.cell * (reach - before) as f64;
        let lowered = surface.above_by(&opened, step);
        gone.iter_mut().zip(lowered).for_each(|(gone, lowered)| *gone |= lowered);
        (surface, before, largest) = (opened, reach, largest.max(step));
    }
    largest
}
