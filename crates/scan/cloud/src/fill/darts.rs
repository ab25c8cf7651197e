//! Points on the mesh of a hole: blue noise, random, or on a grid.

use super::mesh::cover::Cover;
use crate::holes::hole::Hole;
use geom::Vec3;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use serde::Serialize;
use std::str::FromStr;

/// Darts thrown for each point that may fit.
const DARTS: f64 = 40.0;
/// Points per area of a full Poisson-disk sample, times the least distance squared (random sequential packing of
/// discs covers 0.547 of a plane).
pub(crate) const PACKING: f64 = 0.697;

/// How the points of a hole are spread.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Poisson disk: nowhere nearer than the spacing, no preferred direction.
    #[default]
    BlueNoise,
    /// Every position with the same probability, whatever is there.
    Random,
    /// A square grid along the coordinate axes.
    Grid,
}

impl FromStr for Method {
    type Err = String;

    fn from_str(text: &str) -> Result<Method, String> {
        match text {
            "blue-noise" => Ok(Method::BlueNoise),
            "random" => Ok(Method::Random),
            "grid" => Ok(Method::Grid),
            _ => Err(format!("'{text}' is not blue-noise, random or grid")),
        }
    }
}

/// Local positions [m] of the points that a hole gets; `spacing` [m] is their least distance (of a grid: its step).
pub(crate) fn throw(hole: &Hole, cover: &Cover, method: Method, spacing: f64, seed: u64) -> Vec<Vec3> {
    let target = Target::new(hole, cover);
    let wanted = PACKING * target.area / (spacing * spacing);
    if cover.faces.is_empty() {
        return Vec::new();
    }
    let keep_off = match method {
        Method::BlueNoise => spacing,
        // The same number on the same area; the band where the mesh overlaps the scan stays as it is.
        Method::Random => spacing / 2.0,
        Method::Grid => spacing * 0.7,
    };
    let mut taken = PointGrid::new(hole, cover, spacing.max(keep_off));
    let mut points = Vec::new();
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    match method {
        Method::Grid => {
            for (u, v) in grid(hole, cover, spacing) {
                let p = target.lift(u, v);
                if target.takes(u, v) && !taken.any(p, keep_off) {
                    points.push(p);
                }
            }
        }
        Method::BlueNoise | Method::Random => {
            let full = method == Method::BlueNoise;
            let tries = if full { DARTS * wanted } else { wanted };
            for _ in 0..tries.ceil() as usize {
                let (u, v) = target.dart(&mut random);
                let p = target.lift(u, v);
                if target.takes(u, v) && !taken.any(p, keep_off) {
                    points.push(p);
                    if full {
                        taken.add(p);
                    }
                }
            }
        }
    }
    points
}

/// The mesh as a target.
struct Target<'a> {
    hole: &'a Hole,
    cover: &'a Cover,
    /// Sum of the flat areas up to and with each face [m²].
    areas: Vec<f64>,
    /// Of the surface [m²].
    area: f64,
}

impl<'a> Target<'a> {
    fn new(hole: &'a Hole, cover: &'a Cover) -> Target<'a> {
        let (mut sum, mut area) = (0.0, 0.0);
        let areas = cover.faces.iter().map(|&face| {
            let [a, b, c] = cover.triangle(face);
            let flat = 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)).abs();
            let middle = (a + b + c) / 3.0;
            sum += flat;
            area += flat * hole.surface.stretch(middle.x, middle.y);
            sum
        });
        let areas = areas.collect();
        Target { hole, cover, areas, area }
    }

    /// A random position on the mesh, each with the same probability.
    fn dart(&self, random: &mut Pcg64Mcg) -> (f64, f64) {
        let mut share = || (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
        let at = share() * self.areas[self.areas.len() - 1];
        let face = self.areas.partition_point(|&a| a <= at).min(self.areas.len() - 1);
        let [a, b, c] = self.cover.triangle(self.cover.faces[face]);
        let (s, t) = (share(), share());
        let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
        let p = a + (b - a) * s + (c - a) * t;
        (p.x, p.y)
    }

    fn takes(&self, u: f64, v: f64) -> bool {
        self.hole.raster.at(u, v).is_some_and(|cell| self.cover.mask[cell])
    }

    fn lift(&self, u: f64, v: f64) -> Vec3 {
        Vec3::new(u, v, self.cover.height(self.hole, u, v))
    }
}

/// Crossings of lines through multiples of `step` of the world that are under some face.
fn grid(hole: &Hole, cover: &Cover, step: f64) -> Vec<(f64, f64)> {
    let shift = [hole.frame.u, hole.frame.v].map(|axis| hole.frame.origin.dot(&axis).rem_euclid(step));
    let mut found = Vec::new();
    for &face in &cover.faces {
        let tri = cover.triangle(face);
        let (lo, hi) = geom::grid::bounds(&tri);
        let lines = |a: usize| {
            let first = ((lo[a] + shift[a]) / step).ceil() as i64;
            let last = ((hi[a] + shift[a]) / step).floor() as i64;
            (first..=last).map(move |i| (i, i as f64 * step - shift[a]))
        };
        for (j, v) in lines(1) {
            found.extend(
                lines(0)
                    .filter(|(_, u)| super::mesh::cover::holds(&tri, (*u, v)))
                    .map(|(i, u)| ((j, i), (u, v))),
            );
        }
    }
    // A crossing on an edge is under both of its faces.
    found.sort_by_key(|(key, _)| *key);
    found.dedup_by_key(|(key, _)| *key);
    found.into_iter().map(|(_, position)| position).collect()
}

/// Points in square cells over the patch, to ask what is near.
struct PointGrid {
    lo: (f64, f64),
    cell: f64,
    side: (usize, usize),
    /// First point of each cell, plus one.
    heads: Vec<u32>,
    /// The next point of the same cell, plus one.
    points: Vec<(Vec3, u32)>,
}

impl PointGrid {
    /// Holds the scanned points around the mask.
    fn new(hole: &Hole, cover: &Cover, cell: f64) -> PointGrid {
        let corners = cover.corners.iter().map(|(_, p)| *p);
        let positions: Vec<Vec3> = corners.chain(cover.positions.iter().copied()).collect();
        let (lo, hi) = geom::grid::bounds(&positions);
        let extent = (hi - lo).map(|e| e.max(cell));
        // At most a few million cells.
        let cell = cell.max((extent.x * extent.y / 4e6).sqrt());
        let side = ((extent.x / cell) as usize + 1, (extent.y / cell) as usize + 1);
        let heads = vec![0; side.0 * side.1];
        let mut near = PointGrid { lo: (lo.x, lo.y), cell, side, heads, points: Vec::new() };
        hole.around.iter().for_each(|(_, p)| near.add(*p));
        near
    }

    fn cell(&self, p: Vec3) -> (i64, i64) {
        (((p.x - self.lo.0) / self.cell).floor() as i64, ((p.y - self.lo.1) / self.cell).floor() as i64)
    }

    fn slot(&self, x: i64, y: i64) -> Option<usize> {
        let inside = (0..self.side.0 as i64).contains(&x) && (0..self.side.1 as i64).contains(&y);
        inside.then(|| y as usize * self.side.0 + x as usize)
    }

    fn add(&mut self, p: Vec3) {
        let (x, y) = self.cell(p);
        if let Some(slot) = self.slot(x, y) {
            self.points.push((p, self.heads[slot]));
            self.heads[slot] = self.points.len() as u32;
        }
    }

    /// Whether a point is nearer than `distance` (at most a cell).
    fn any(&self, p: Vec3, distance: f64) -> bool {
        let (x, y) = self.cell(p);
        (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy))).any(|(dx, dy)| {
            let mut next = self.slot(x + dx, y + dy).map_or(0, |slot| self.heads[slot]);
            while next != 0 {
                let (q, after) = self.points[next as usize - 1];
                if (p - q).norm_squared() < distance * distance {
                    return true;
                }
                next = after;
            }
            false
        })
    }
}
