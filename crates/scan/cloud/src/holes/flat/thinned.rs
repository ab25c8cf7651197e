//! A few points of each cell of a sheet, side by side in memory: enough to see whether something is there.
//!
//! A box that holds many cells is projected by these points. A hole found there is examined again with all points, so these may be
//! 4-byte numbers, relative to the middle of the sheet.

use super::frame::Frame;
use super::raster::Raster;
use crate::holes::surface::sheet::Sheet;
use geom::{Quadratic, Vec3};
use multiversion::multiversion;
use rayon::prelude::*;

/// Points of a cell at most: with fewer than seven, a window full of points looks open.
const ENOUGH: usize = 8;
/// How far from its cell's mean position a point may be, in cells: √3, and rounding.
const FROM_MEAN: f64 = 1.75;

/// x, y and z of the points of a cell, from the sheet's middle [m]; NaN where there are fewer.
type Points = [[f32; ENOUGH]; 3];

/// At most [`ENOUGH`] points of each cell, spread over its rows; in the order of the sheet's cells.
pub(crate) struct Thinned(Vec<Points>);

impl Thinned {
    pub fn new(points: &[Vec3], sheet: &Sheet) -> Thinned {
        let some = |&cell: &u32| {
            let rows = sheet.rows(cell);
            let mut some = [[f32::NAN; ENOUGH]; 3];
            for (k, &row) in rows.iter().step_by(rows.len().div_ceil(ENOUGH)).enumerate() {
                let position = points[row as usize] - sheet.middle;
                (0..3).for_each(|a| some[a][k] = position[a] as f32);
            }
            some
        };
        Thinned(sheet.cells.order().par_iter().map(some).collect())
    }

    /// Points over each cell of a `raster`, of those in cells that a ball of radius `reach` [m] around the frame's origin touches that are at
    /// most `covers` [m] off the `surface`.
    pub fn counts(
        &self,
        sheet: &Sheet,
        (frame, reach): (&Frame, f64),
        raster: &Raster,
        surface: &Quadratic,
        covers: f64,
    ) -> Vec<u32> {
        let edge = raster.half + FROM_MEAN * sheet.cell;
        let flat = Flat::new(frame, &sheet.middle, raster, surface, covers);
        // The last counts what is nowhere.
        let mut counts = vec![0u32; raster.len() + 1];
        for run in sheet.cells.grid.runs_near(frame.origin, reach) {
            count(&flat, frame, edge, (&sheet.cells.points[run.clone()], &self.0[run]), &mut counts);
        }
        counts.pop();
        counts
    }
}

/// From a position to a cell of a raster, and to the height over a surface.
struct Flat {
    /// Three rows of a matrix and a shift: along u and v in cells of the raster, along the normal [m].
    axes: [[f32; 4]; 3],
    /// The surface over u and v in cells: what makes them small, its coefficients.
    scale: [f32; 2],
    surface: [f32; 6],
    covers: f32,
    side: f32,
    nowhere: u32,
}

impl Flat {
    fn new(frame: &Frame, middle: &Vec3, raster: &Raster, surface: &Quadratic, covers: f64) -> Flat {
        let origin = frame.origin - middle;
        let row = |axis: &Vec3, shift: f64, unit: f64| {
            [axis.x, axis.y, axis.z, shift - origin.dot(axis)].map(|value| (value / unit) as f32)
        };
        let (coefficients, scale) = surface.parts();
        Flat {
            axes: [
                row(&frame.u, raster.half, raster.cell),
                row(&frame.v, raster.half, raster.cell),
                row(&frame.n, 0.0, 1.0),
            ],
            scale: [raster.cell / scale, -raster.half / scale].map(|value| value as f32),
            surface: coefficients.map(|c| c as f32),
            covers: covers as f32,
            side: raster.side as f32,
            nowhere: raster.len() as u32,
        }
    }

    /// Cells of the raster under some points.
    #[inline(always)]
    fn cells(&self, [xs, ys, zs]: &Points) -> [u32; ENOUGH] {
        let [c0, c1, c2, c3, c4, c5] = self.surface;
        let mut cells = [0; ENOUGH];
        for k in 0..ENOUGH {
            let along = |[a, b, c, shift]: [f32; 4]| a * xs[k] + b * ys[k] + c * zs[k] + shift;
            let [u, v, w] = self.axes.map(along);
            let [s, t] = [u, v].map(|cells| cells * self.scale[0] + self.scale[1]);
            let off = w - (c0 + s * (c1 + c3 * s + c4 * t) + t * (c2 + c5 * t));
            let inside =
                (u >= 0.0) & (v >= 0.0) & (u < self.side) & (v < self.side) & (off.abs() <= self.covers);
            cells[k] = if inside { v as u32 * self.side as u32 + u as u32 } else { self.nowhere };
        }
        cells
    }
}

/// Counts the points of cells whose mean positions are at most `edge` [m] off the frame's origin along u and v.
#[multiversion(targets("x86_64+avx512f+avx512dq+avx512vl", "x86_64+avx2"))]
fn count(flat: &Flat, frame: &Frame, edge: f64, (means, points): (&[Vec3], &[Points]), counts: &mut [u32]) {
    for (mean, points) in means.iter().zip(points) {
        let from = mean - frame.origin;
        if from.dot(&frame.u).abs() <= edge && from.dot(&frame.v).abs() <= edge {
            for at in flat.cells(points) {
                counts[at as usize] += 1;
            }
        }
    }
}
