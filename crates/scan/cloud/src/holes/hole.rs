//! A hole, and what counts as one.

use super::flat::frame::Frame;
use super::flat::raster::Raster;
use super::surface::sheet::{End, REACH, Sheet};
use crate::neighbours::spacing::LocalSpacing;
use geom::{Quadratic, Shape, Vec3};

/// Cells of the patch a scale.
pub(crate) const CELLS: f64 = 2.0;
/// How far the window makes a hole look smaller than it is, in cells.
pub(crate) const GROW: f64 = 2.5;

/// Where the surface is open.
#[derive(Clone, Copy)]
pub(crate) enum Threshold<'a> {
    /// Where the density is at most this [1/m²].
    Below(f64),
    /// Where it is at most a quarter of that around.
    Local(&'a LocalSpacing),
}

/// What counts as a hole.
pub(crate) struct Search<'a> {
    pub threshold: Threshold<'a>,
    /// Widest hole that is one [m].
    pub widest: f64,
    /// Only in these shapes, and there without regard to outline and width; everywhere when there is none.
    pub regions: &'a [Shape],
}

/// A hole, laid flat.
pub(crate) struct Hole {
    pub frame: Frame,
    pub surface: Quadratic,
    pub raster: Raster,
    /// The open cells.
    pub open: Vec<usize>,
    /// Rows of the points of this sheet around the hole, and their local positions [m].
    pub around: Vec<(u32, Vec3)>,
    /// Middle of the open cells [m].
    pub centre: Vec3,
    /// Greatest width [m].
    pub width: f64,
    /// Scale at which its surface is fitted [m].
    pub fit: f64,
}

impl Hole {
    /// The ends of the surface around it.
    pub fn ends(&self, sheet: &Sheet, ends: &[End]) -> Vec<End> {
        let reach = 0.5 * self.width + REACH * sheet.cell;
        let near = |end: &&End| (sheet.positions[end.index as usize] - self.centre).norm() <= reach;
        ends.iter().filter(near).copied().collect()
    }

    /// Whether some of it is in a shape.
    pub fn is_in(&self, shape: &Shape) -> bool {
        self.open.iter().any(|&cell| {
            let (u, v) = self.raster.middle(cell);
            shape.contains(&self.frame.world(&Vec3::new(u, v, self.surface.height(u, v))))
        })
    }

    /// Area of the open cells, laid flat [m²].
    pub fn area(&self) -> f64 {
        self.open.len() as f64 * self.raster.cell * self.raster.cell
    }

    /// Whether a good part of the `other` lies over or under this one.
    pub fn overlaps(&self, other: &Hole) -> bool {
        let reach = 0.75 * (self.width + other.width);
        if (self.centre - other.centre).norm() > reach {
            return false;
        }
        let inside = |cell: &&usize| {
            let (u, v) = other.raster.middle(**cell);
            let position = other.frame.world(&Vec3::new(u, v, other.surface.height(u, v)));
            let local = self.frame.local(&position);
            self.raster.at(local.x, local.y).is_some_and(|cell| self.open.binary_search(&cell).is_ok())
        };
        5 * other.open.iter().filter(inside).count() >= other.open.len()
    }
}
