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

use crate::enclosed;
use crate::few::Few;
use crate::largest::Parts;
use crate::patch::Frame;
use crate::raster::Raster;
use crate::sheet::{End, REACH, Sheet};
use geom::{Grid, Quadratic, Shape, Vec3};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Cells of the patch a scale.
pub(crate) const CELLS: f64 = 2.0;
/// Half the window, in cells of the patch.
const WINDOW: usize = 2;
/// Fewest open cells of a hole: less is chance.
const FEWEST_CELLS: usize = 6;
/// Fewest ends of a loop.
const FEWEST_ENDS: usize = 4;
/// How far the window makes a hole look smaller than it is, in cells.
pub(crate) const GROW: f64 = 2.5;
/// Points this far off the surface of a patch, as a share of its radius, still cover it: a stone that rises out of
/// its shadow is no hole in the ground. A wall scanned from both sides must be thicker, or cropped to one side.
const COVERS: f64 = 0.5;
/// Most cells of one patch.
const MOST_CELLS: f64 = 16e6;

/// What counts as a hole.
pub(crate) struct Search<'a> {
    /// Open where the density is at most this [1/m²].
    pub below: f64,
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

/// The holes of a cloud of finite points, in the order of their first ends.
pub(crate) fn find(points: &[Vec3], search: &Search) -> Vec<Hole> {
    let sheet = Sheet::of_surface(points, 1.0 / search.below.sqrt());
    let ends = sheet.ends();
    if !search.regions.is_empty() {
        let inside = search.regions.iter().map(|shape| (ends_of(&sheet, &ends, shape), Some(shape)));
        return once(look(points, &sheet, inside.collect(), search), Vec::new());
    }
    let (narrow, wide) = loops(&sheet, &ends, search.widest);
    let whole = |loops: Vec<Vec<End>>| loops.into_iter().map(|ends| (ends, None)).collect();
    let found = look(points, &sheet, whole(narrow), search);
    // A box of many holes lies far from the surface: each hole found there is examined again in a separate patch.
    let seen = look_over(points, &sheet, wide, search);
    let seen =
        seen.iter().filter(|hole| !found.iter().any(|known| known.overlaps(hole) || hole.overlaps(known)));
    let near: Vec<Vec<End>> = seen.map(|hole| hole.ends(&sheet, &ends)).collect();
    let again = look(points, &sheet, whole(near), search);
    once(found, again)
}

/// The holes among groups of ends in boxes, by a few points of each cell, and without their surroundings.
fn look_over(points: &[Vec3], sheet: &Sheet, boxes: Vec<Vec<End>>, search: &Search) -> Vec<Hole> {
    if boxes.is_empty() {
        return Vec::new();
    }
    let few = Few::new(points, sheet);
    let holes = |ends| Patch::new(sheet, ends, None).map(|patch| patch.holes_of(&few, sheet, search));
    let found: Vec<Option<Vec<Hole>>> = boxes.into_par_iter().map(holes).collect();
    found.into_iter().flatten().flatten().collect()
}

/// The holes among groups of ends, each in its shape where there is one.
fn look(
    points: &[Vec3],
    sheet: &Sheet,
    groups: Vec<(Vec<End>, Option<&Shape>)>,
    search: &Search,
) -> Vec<Hole> {
    let patch = |(ends, shape)| Patch::new(sheet, ends, shape);
    let patches: Vec<Patch> = groups.into_iter().filter_map(patch).collect();
    let near = |p: &Patch| sheet.cells.grid.within(&sheet.positions, p.frame.origin, p.radius * 1.5);
    let holes = |patch: &Patch| {
        let rows = near(patch).flat_map(|cell| sheet.rows(cell).iter().copied());
        patch.holes(points, sheet, rows, search)
    };
    let found: Vec<Vec<Hole>> = patches.par_iter().map(holes).collect();
    found.into_iter().flatten().collect()
}

/// Ends in loops no wider than a hole of width `widest` [m] has, by the number of their first position; and what hangs together farther,
/// in boxes.
fn loops(sheet: &Sheet, ends: &[End], widest: f64) -> (Vec<Vec<End>>, Vec<Vec<End>>) {
    let positions: Vec<Vec3> = ends.iter().map(|e| sheet.positions[e.index as usize]).collect();
    let reach = REACH * sheet.cell;
    let grid = Grid::new(&positions, reach);
    let mut parts = Parts::new(ends.len());
    for (i, end) in ends.iter().enumerate() {
        for j in grid.within(&positions, positions[i], reach).filter(|&j| j > i as u32) {
            if end.free.dot(&ends[j as usize].free) > 0.2 {
                parts.join(i as u32, j);
            }
        }
    }
    let mut by_root: Vec<(u32, End)> = (0u32..).zip(ends).map(|(i, e)| (parts.root(i), *e)).collect();
    by_root.sort_by_key(|(root, _)| *root);
    let groups =
        by_root.chunk_by(|a, b| a.0 == b.0).map(|group| group.iter().map(|g| g.1).collect::<Vec<End>>());
    let narrow = |group: &Vec<End>| {
        let positions: Vec<Vec3> = group.iter().map(|e| sheet.positions[e.index as usize]).collect();
        let (lo, hi) = geom::grid::bounds(&positions);
        (hi - lo).norm() <= 2.0 * (widest + reach)
    };
    let (loops, wide): (Vec<_>, Vec<_>) = groups.partition(narrow);
    (loops, wide.into_iter().flat_map(|group| boxes(sheet, group, 2.0 * (widest + 2.0 * reach))).collect())
}

/// Ends in overlapping boxes of width `side` [m]: whatever is half as wide lies whole in one of them.
fn boxes(sheet: &Sheet, group: Vec<End>, side: f64) -> Vec<Vec<End>> {
    let mut boxes: BTreeMap<[i64; 4], Vec<End>> = BTreeMap::new();
    for end in group {
        for shift in 0..8i64 {
            let half = |a: usize| 0.5 * (shift >> a & 1) as f64;
            let position = sheet.positions[end.index as usize];
            let [x, y, z] = [0, 1, 2].map(|a| (position[a] / side + half(a)).floor() as i64);
            boxes.entry([shift, x, y, z]).or_default().push(end);
        }
    }
    let mut all: Vec<Vec<End>> = boxes.into_values().collect();
    // A flat surface is cut in the same way by shifts across it.
    all.sort_by_key(|ends| ends.iter().map(|e| e.index).collect::<Vec<u32>>());
    all.dedup_by(|a, b| a.len() == b.len() && a.iter().zip(b.iter()).all(|(a, b)| a.index == b.index));
    all
}

/// Ends in a shape, or looking into it.
fn ends_of(sheet: &Sheet, ends: &[End], shape: &Shape) -> Vec<End> {
    let looks_in = |end: &&End| {
        let position = sheet.positions[end.index as usize];
        (0..8).any(|step| shape.contains(&(position + end.free * (0.5 * f64::from(step) * sheet.cell))))
    };
    ends.iter().filter(looks_in).copied().collect()
}

/// The surroundings of a loop of ends.
struct Patch<'a> {
    ends: Vec<End>,
    frame: Frame,
    /// Around the frame's origin [m].
    radius: f64,
    shape: Option<&'a Shape>,
}

impl<'a> Patch<'a> {
    fn new(sheet: &Sheet, ends: Vec<End>, shape: Option<&'a Shape>) -> Option<Patch<'a>> {
        if ends.len() < FEWEST_ENDS {
            return None;
        }
        let positions = ends.iter().map(|e| sheet.positions[e.index as usize]);
        let centre = positions.clone().sum::<Vec3>() / ends.len() as f64;
        let normals: Vec<Vec3> = ends.iter().map(|e| e.normal).collect();
        let frame = Frame::new(centre, &normals)?;
        let radius = positions.map(|p| (p - centre).norm()).fold(0.0, f64::max) + 5.0 * sheet.cell;
        ((2.0 * radius * CELLS / sheet.cell).powi(2) < MOST_CELLS).then_some(Patch {
            ends,
            frame,
            radius,
            shape,
        })
    }

    fn holes(
        &self,
        points: &[Vec3],
        sheet: &Sheet,
        rows: impl Iterator<Item = u32>,
        search: &Search,
    ) -> Vec<Hole> {
        let Some(surface) = self.surface(sheet) else { return Vec::new() };
        let tolerance = self.tolerance(&surface, sheet);
        let off = |p: &Vec3| (p.z - surface.height(p.x, p.y)).abs();
        let raster = Raster::new(self.radius, sheet.cell / CELLS);
        let local = rows.map(|r| (r, self.frame.local(&points[r as usize])));
        let near = |p: &Vec3| raster.at(p.x, p.y).is_some() && off(p) <= tolerance.max(COVERS * self.radius);
        let mut around: Vec<(u32, Vec3)> = local.filter(|(_, p)| near(p)).collect();
        let mut counts = vec![0u32; raster.len()];
        around.iter().filter_map(|(_, p)| raster.at(p.x, p.y)).for_each(|cell| counts[cell] += 1);
        let open = self.open(&raster, &counts, &surface, search);
        around.retain(|(_, p)| off(p) <= tolerance);
        let fewest = if self.shape.is_some() { 1 } else { FEWEST_CELLS };
        let parts = match self.shape {
            None => enclosed::holes(&raster, open),
            Some(_) => raster.parts(open).into_iter().map(sorted).collect(),
        };
        let parts = parts.into_iter().filter(|part| part.len() >= fewest);
        parts.filter_map(|part| self.hole(part, &raster, &surface, &around, search)).collect()
    }

    /// The same with a few points of each cell; the holes are returned without their surroundings.
    fn holes_of(&self, few: &Few, sheet: &Sheet, search: &Search) -> Vec<Hole> {
        let Some(surface) = self.surface(sheet) else { return Vec::new() };
        let covers = self.tolerance(&surface, sheet).max(COVERS * self.radius);
        let raster = Raster::new(self.radius, sheet.cell / CELLS);
        let counts = few.counts(sheet, (&self.frame, self.radius * 1.5), &raster, &surface, covers);
        let parts = enclosed::holes(&raster, self.open(&raster, &counts, &surface, search));
        let parts = parts.into_iter().filter(|part| part.len() >= FEWEST_CELLS);
        parts.filter_map(|part| self.hole(part, &raster, &surface, &[], search)).collect()
    }

    /// How far off the surface a point still belongs to it [m].
    fn tolerance(&self, surface: &Quadratic, sheet: &Sheet) -> f64 {
        (3.0 * surface.rms).max(1.5 * sheet.cell)
    }

    /// The quadratic through the positions around the ends.
    fn surface(&self, sheet: &Sheet) -> Option<Quadratic> {
        let reach = REACH * sheet.cell;
        let near =
            |e: &End| sheet.cells.grid.within(&sheet.positions, sheet.positions[e.index as usize], reach);
        let mut near: Vec<u32> = self.ends.iter().flat_map(near).collect();
        near.sort_unstable();
        near.dedup();
        let positions: Vec<Vec3> =
            near.iter().map(|&i| self.frame.local(&sheet.positions[i as usize])).collect();
        Quadratic::fit(&positions)
    }

    /// The open cells; in a shape, those that may be filled.
    fn open(&self, raster: &Raster, counts: &[u32], surface: &Quadratic, search: &Search) -> Vec<bool> {
        let window = (2 * WINDOW + 1) as f64 * raster.cell;
        let most = search.below * window * window;
        let mut open: Vec<bool> =
            raster.windows(counts, WINDOW).into_iter().map(|count| f64::from(count) <= most).collect();
        if let Some(shape) = self.shape {
            for (cell, open) in open.iter_mut().enumerate().filter(|(_, open)| **open) {
                let (u, v) = raster.middle(cell);
                *open = shape.contains(&self.frame.world(&Vec3::new(u, v, surface.height(u, v))));
            }
        }
        open
    }

    fn hole(
        &self,
        open: Vec<usize>,
        raster: &Raster,
        surface: &Quadratic,
        around: &[(u32, Vec3)],
        search: &Search,
    ) -> Option<Hole> {
        let positions: Vec<Vec3> = open
            .iter()
            .map(|&cell| {
                let (u, v) = raster.middle(cell);
                Vec3::new(u, v, surface.height(u, v))
            })
            .collect();
        let (lo, hi) = geom::grid::bounds(&positions);
        let width = (hi - lo).max() + (1.0 + GROW) * raster.cell;
        let reach = 0.5 * (hi - lo).norm() + 5.0 * CELLS * raster.cell;
        let middle = (lo + hi) / 2.0;
        let near = |p: &&(u32, Vec3)| (p.1 - middle).xy().norm() <= reach;
        (self.shape.is_some() || width <= search.widest).then(|| Hole {
            frame: self.frame,
            surface: *surface,
            raster: *raster,
            centre: self.frame.world(&(positions.iter().sum::<Vec3>() / positions.len() as f64)),
            width,
            around: around.iter().filter(near).copied().collect(),
            open,
        })
    }
}

fn sorted(mut cells: Vec<usize>) -> Vec<usize> {
    cells.sort_unstable();
    cells
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
