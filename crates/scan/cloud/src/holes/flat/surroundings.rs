//! The surroundings of a loop, laid flat, and the holes in them.

use super::enclosed;
use super::frame::Frame;
use super::raster::Raster;
use super::thinned::Thinned;
use crate::holes::hole::{CELLS, GROW, Hole, Search, Threshold};
use crate::holes::surface::levels::{EXAMINED, Level};
use crate::holes::surface::sheet::{End, REACH, Sheet};
use geom::{Quadratic, Shape, Vec3};

/// Half the window, in cells of the patch.
const WINDOW: usize = 2;
/// Fewest open cells of a hole: less is chance.
const FEWEST_CELLS: usize = 6;
/// Fewest ends of a loop.
const FEWEST_ENDS: usize = 4;
/// Points this far off the surface of a patch, as a share of its radius, still cover it: a stone that rises out of
/// its shadow is no hole in the ground. A wall scanned from both sides must be thicker, or cropped to one side.
const COVERS: f64 = 0.5;
/// Scale that the surface is fitted at, in spacings.
const FITTED: f64 = 2.5;
/// Most cells of one patch.
const MOST_CELLS: f64 = 16e6;
/// The ring around the open cells of a hole that must be as dense as the scale demands, in cells: its windows hold nothing of the hole.
const RIM: [f64; 2] = [4.5, 7.5];
/// There a window is thin whose points are fewer than this many times what an open one may have: 45 % of what is there on average.
const THIN: f64 = 1.8;
/// Share of the ring whose windows must hold points of the surface [–], and share of these that may be thin.
const FILLED: f64 = 0.6;
const MOST_THIN: f64 = 0.25;
/// Of the spacings at the ends of a loop, sorted, the share that the scale is taken from: the sparser side must not look open.
const SPARSER: f64 = 0.75;

/// The surroundings of a loop of ends.
pub(crate) struct Surroundings<'a> {
    ends: Vec<End>,
    pub frame: Frame,
    /// Around the frame's origin [m].
    pub radius: f64,
    /// Twice the width of a cell [m].
    scale: f64,
    /// What the surface is fitted at [m].
    fit: f64,
    /// Open where the density is at most this [1/m²].
    below: f64,
    shape: Option<&'a Shape>,
}

impl<'a> Surroundings<'a> {
    pub fn new(
        level: &Level,
        ends: Vec<End>,
        shape: Option<&'a Shape>,
        search: &Search,
    ) -> Option<Surroundings<'a>> {
        if ends.len() < FEWEST_ENDS {
            return None;
        }
        let sheet = &level.sheet;
        let positions = ends.iter().map(|e| sheet.positions[e.index as usize]);
        let centre = positions.clone().sum::<Vec3>() / ends.len() as f64;
        let normals: Vec<Vec3> = ends.iter().map(|e| e.normal).collect();
        let frame = Frame::new(centre, &normals)?;
        let (scale, fit, below) = match search.threshold {
            Threshold::Below(below) => (sheet.cell, sheet.cell, below),
            Threshold::Local(field) => {
                let mut spacings: Vec<f64> = positions.clone().map(|p| field.at(&p)).collect();
                spacings.sort_by(f64::total_cmp);
                let spacing = spacings[(SPARSER * (spacings.len() - 1) as f64) as usize];
                let below = (EXAMINED * spacing).powi(-2);
                (EXAMINED * spacing * level.wider, FITTED * spacing * level.wider, below)
            }
        };
        let radius = positions.map(|p| (p - centre).norm()).fold(0.0, f64::max) + 5.0 * scale;
        ((2.0 * radius * CELLS / scale).powi(2) < MOST_CELLS).then_some(Surroundings {
            ends,
            frame,
            radius,
            scale,
            fit,
            below,
            shape,
        })
    }

    /// The holes, from all points of the level around.
    pub fn holes(&self, level: &Level, rows: impl Iterator<Item = u32>, search: &Search) -> Vec<Hole> {
        let Some(surface) = self.surface(&level.sheet) else { return Vec::new() };
        let tolerance = self.tolerance(&surface);
        let off = |p: &Vec3| (p.z - surface.height(p.x, p.y)).abs();
        let raster = Raster::new(self.radius, self.scale / CELLS);
        let local = rows.map(|r| (level.row(r), self.frame.local(&level.points[r as usize])));
        let near = |p: &Vec3| raster.at(p.x, p.y).is_some() && off(p) <= tolerance.max(COVERS * self.radius);
        let mut around: Vec<(u32, Vec3)> = local.filter(|(_, p)| near(p)).collect();
        let mut counts = vec![0u32; raster.len()];
        around.iter().filter_map(|(_, p)| raster.at(p.x, p.y)).for_each(|cell| counts[cell] += 1);
        let windows = raster.windows(&counts, WINDOW);
        let open = self.open(&raster, &windows, &surface);
        around.retain(|(_, p)| off(p) <= tolerance);
        let is_local = matches!(search.threshold, Threshold::Local(_));
        let fewest = if self.shape.is_some() { 1 } else { FEWEST_CELLS + 4 * usize::from(is_local) };
        let parts = match self.shape {
            None => enclosed::holes(&raster, open),
            Some(_) => raster.parts(open).into_iter().map(sorted).collect(),
        };
        let mut counts = vec![0u32; raster.len()];
        around.iter().filter_map(|(_, p)| raster.at(p.x, p.y)).for_each(|cell| counts[cell] += 1);
        let windows = raster.windows(&counts, WINDOW);
        let is_edged =
            |part: &Vec<usize>| self.shape.is_some() || !is_local || self.is_edged(part, &raster, &windows);
        let parts = parts.into_iter().filter(|part| part.len() >= fewest && is_edged(part));
        parts.filter_map(|part| self.hole(part, &raster, &surface, &around, search)).collect()
    }

    /// The same with a few points of each cell; the holes are returned without their surroundings.
    pub fn holes_of(&self, thinned: &Thinned, level: &Level, search: &Search) -> Vec<Hole> {
        let Some(surface) = self.surface(&level.sheet) else { return Vec::new() };
        let covers = self.tolerance(&surface).max(COVERS * self.radius);
        let raster = Raster::new(self.radius, self.scale / CELLS);
        let counts =
            thinned.counts(&level.sheet, (&self.frame, self.radius * 1.5), &raster, &surface, covers);
        let parts = enclosed::holes(&raster, self.open(&raster, &raster.windows(&counts, WINDOW), &surface));
        let parts = parts.into_iter().filter(|part| part.len() >= FEWEST_CELLS);
        parts.filter_map(|part| self.hole(part, &raster, &surface, &[], search)).collect()
    }

    /// How far off the surface a point still belongs to it [m].
    fn tolerance(&self, surface: &Quadratic) -> f64 {
        (3.0 * surface.rms).max(1.5 * self.fit)
    }

    /// The quadratic through the positions around the ends.
    fn surface(&self, sheet: &Sheet) -> Option<Quadratic> {
        let reach = REACH * self.fit;
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
    fn open(&self, raster: &Raster, windows: &[u32], surface: &Quadratic) -> Vec<bool> {
        let most = self.most(raster);
        let mut open: Vec<bool> = windows.iter().map(|&count| f64::from(count) <= most).collect();
        if let Some(shape) = self.shape {
            for (cell, open) in open.iter_mut().enumerate().filter(|(_, open)| **open) {
                let (u, v) = raster.middle(cell);
                *open = shape.contains(&self.frame.world(&Vec3::new(u, v, surface.height(u, v))));
            }
        }
        open
    }

    /// Most points of an open window.
    fn most(&self, raster: &Raster) -> f64 {
        self.below * ((2 * WINDOW + 1) as f64 * raster.cell).powi(2)
    }

    /// Whether the surface around is as dense as the scale demands: one that is sparser has random holes.
    fn is_edged(&self, part: &[usize], raster: &Raster, windows: &[u32]) -> bool {
        let [inner, outer] = RIM.map(|radius| raster.grown(part, radius));
        let most = self.most(raster);
        let (mut ring, mut filled, mut thin) = (0u32, 0u32, 0u32);
        for cell in (0..raster.len()).filter(|&cell| outer[cell] && !inner[cell]) {
            ring += 1;
            filled += u32::from(windows[cell] > 0);
            thin += u32::from(windows[cell] > 0 && f64::from(windows[cell]) < THIN * most);
        }
        f64::from(filled) > FILLED * f64::from(ring) && f64::from(thin) <= MOST_THIN * f64::from(filled)
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
            fit: self.fit,
            around: around.iter().filter(near).copied().collect(),
            open,
        })
    }
}

fn sorted(mut cells: Vec<usize>) -> Vec<usize> {
    cells.sort_unstable();
    cells
}
