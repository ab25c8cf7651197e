//! Holes: blind spots of the scanner inside the outline of the surface.
//!
//! ```text
//! threshold D [1/m²]   given, or a quarter of the density that only the sparsest 20th of the surface is below
//! scale     c = 1/√D   a disc of c² has one point where the density is D; wider where the noise is
//! 1. the surface ends where the cells of width c around a position leave a gap of 100° and more (`sheet`)
//! 2. ends are linked to loops when they are near and look the same way: across a hole or a narrow strip they do not;
//!    what is linked wider than a hole may be is looked at in overlapping boxes, each of which a hole fits in
//! 3. each loop's surroundings are laid flat: plane, and the quadratic over it (`patch`)
//! 4. there, cells whose window of (2.5 c)² holds at most 6.25 c² D points are open; open cells that are not
//!    joined to the outside, but by a strait, are a hole (`enclosed`)
//! ```
//!
//! Step 4 decides, so that the rim of the surface and false ends of step 1 do not count as holes.

use crate::examined::Patch;
use crate::few::Few;
use crate::levels::{Level, scales};
use crate::local_spacing::LocalSpacing;
use crate::loops::{ends_of, loops};
use crate::patch::Frame;
use crate::raster::Raster;
use crate::sheet::{End, REACH, Sheet};
use geom::{Quadratic, Shape, Vec3};
use rayon::prelude::*;

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
}

/// The holes of a cloud of finite points.
pub(crate) fn find(points: &[Vec3], search: &Search) -> Vec<Hole> {
    match search.threshold {
        Threshold::Below(below) => of_level(&Level::whole(points, below.sqrt().recip()), search),
        Threshold::Local(field) => {
            let of_scale = |&cell: &f64| of_level(&Level::suited(points, field, cell), search);
            once(scales(field).values().flat_map(of_scale).collect(), Vec::new())
        }
    }
}

/// The holes of one scale.
fn of_level(level: &Level, search: &Search) -> Vec<Hole> {
    if !search.regions.is_empty() {
        let inside = search.regions.iter().map(|shape| (ends_of(level, shape), Some(shape)));
        return once(look(level, inside.collect(), search), Vec::new());
    }
    let (narrow, wide) = loops(level, search.widest);
    let whole = |loops: Vec<Vec<End>>| loops.into_iter().map(|ends| (ends, None)).collect();
    let found = look(level, whole(narrow), search);
    // A box of many holes lies far from the surface: each hole found there is examined again in a separate patch.
    let seen = look_over(level, wide, search);
    let seen =
        seen.iter().filter(|hole| !found.iter().any(|known| known.overlaps(hole) || hole.overlaps(known)));
    let near: Vec<Vec<End>> = seen.map(|hole| hole.ends(&level.sheet, &level.ends)).collect();
    let again = look(level, whole(near), search);
    once(found, again)
}

/// The holes among groups of ends in boxes, by a few points of each cell, and without their surroundings.
fn look_over(level: &Level, boxes: Vec<Vec<End>>, search: &Search) -> Vec<Hole> {
    if boxes.is_empty() {
        return Vec::new();
    }
    let few = Few::new(&level.points, &level.sheet);
    let holes = |ends| Patch::new(level, ends, None, search).map(|patch| patch.holes_of(&few, level, search));
    let found: Vec<Option<Vec<Hole>>> = boxes.into_par_iter().map(holes).collect();
    found.into_iter().flatten().flatten().collect()
}

/// The holes among groups of ends, each in its shape where there is one.
fn look(level: &Level, groups: Vec<(Vec<End>, Option<&Shape>)>, search: &Search) -> Vec<Hole> {
    let patch = |(ends, shape)| Patch::new(level, ends, shape, search);
    let patches: Vec<Patch> = groups.into_iter().filter_map(patch).collect();
    let sheet = &level.sheet;
    let near = |p: &Patch| sheet.cells.grid.within(&sheet.positions, p.frame.origin, p.radius * 1.5);
    let holes = |patch: &Patch| {
        let rows = near(patch).flat_map(|cell| sheet.rows(cell).iter().copied());
        patch.holes(level, rows, search)
    };
    let found: Vec<Vec<Hole>> = patches.par_iter().map(holes).collect();
    found.into_iter().flatten().collect()
}

/// Each hole once: two patches may both see it, the smaller one better; and then those of `others` that are not among them.
fn once(mut holes: Vec<Hole>, mut others: Vec<Hole>) -> Vec<Hole> {
    holes.sort_by(|a, b| a.raster.half.total_cmp(&b.raster.half));
    others.sort_by(|a, b| a.raster.half.total_cmp(&b.raster.half));
    let mut kept: Vec<Hole> = Vec::new();
    for hole in holes.into_iter().chain(others) {
        if !kept.iter().any(|other| other.overlaps(&hole)) {
            kept.push(hole);
        }
    }
    kept
}

impl Hole {
    /// The ends of the surface around it.
    fn ends(&self, sheet: &Sheet, ends: &[End]) -> Vec<End> {
        let reach = 0.5 * self.width + REACH * sheet.cell;
        let near = |end: &&End| (sheet.positions[end.index as usize] - self.centre).norm() <= reach;
        ends.iter().filter(near).copied().collect()
    }

    /// Area of the open cells, laid flat [m²].
    pub fn area(&self) -> f64 {
        self.open.len() as f64 * self.raster.cell * self.raster.cell
    }

    /// Whether a good part of the `other` lies over or under this one.
    fn overlaps(&self, other: &Hole) -> bool {
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
