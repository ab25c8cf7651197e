//! The mesh over a hole, and the smooth height that its points get.

use super::pivot::pivot;
use super::spline::{Sample, Spline};
use super::volume;
use crate::holes::flat::raster::Raster;
use crate::holes::hole::{GROW, Hole};
use geom::Vec3;
use serde::Serialize;
use std::collections::HashMap;
use std::str::FromStr;

/// Most samples that the surface is fitted to: it costs their number cubed.
const MOST_SAMPLES: usize = 160;
/// Width of the surroundings that are used, in scales of the fit.
const RING: f64 = 3.0;
/// Share of the open cells that a mesh must cover.
const CLOSED: f64 = 0.95;

/// How a hole is meshed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mesher {
    /// A ball rolls over the hole; the surface is as smooth as its surroundings say.
    #[default]
    BallPivoting,
    /// Signed distances that are diffused; the surface of a membrane.
    Volumetric,
}

impl FromStr for Mesher {
    type Err = String;

    fn from_str(text: &str) -> Result<Mesher, String> {
        match text {
            "ball-pivoting" => Ok(Mesher::BallPivoting),
            "volumetric" => Ok(Mesher::Volumetric),
            _ => Err(format!("'{text}' is not ball-pivoting or volumetric")),
        }
    }
}

/// The mesh over one hole, in the hole's frame.
pub(crate) struct Cover {
    /// Cells that may get points.
    pub mask: Vec<bool>,
    /// Scanned points around the hole: rows of the cloud and their local positions [m].
    pub corners: Vec<(u32, Vec3)>,
    /// Local positions of the mesh's vertices [m].
    pub positions: Vec<Vec3>,
    /// Triangles over `positions`.
    pub faces: Vec<[u32; 3]>,
    /// Points per area of the surroundings [1/m²].
    pub density: f64,
    /// The largest ball that was rolled [m].
    pub ball: f64,
    /// Share of the open cells under the mesh [–].
    pub covered: f64,
    heights: Heights,
}

/// Why a hole has no cover.
pub(crate) struct FallsThrough;

impl Cover {
    /// Meshes a hole with balls of the given radii [m]; with growing ones of its own when none is given.
    pub fn new(hole: &Hole, mesher: Mesher, balls: &[f64]) -> Result<Cover, FallsThrough> {
        let raster = &hole.raster;
        let mask = raster.grown(&hole.open, GROW);
        let ring = raster.grown(&hole.open, GROW + RING * hole.fit / raster.cell);
        let in_ring = |(_, p): &&(u32, Vec3)| raster.at(p.x, p.y).is_some_and(|cell| ring[cell]);
        let around: Vec<(u32, Vec3)> = hole.around.iter().filter(in_ring).copied().collect();
        let density = density(hole, &mask, &ring, &around).ok_or(FallsThrough)?;
        let corners = thinned(raster, &around);
        if mesher == Mesher::Volumetric {
            return Ok(Cover::by_volume(hole, (mask, corners), &around, density));
        }
        // The ball rolls over the patch laid flat, where neither curvature nor noise holds it up.
        let flat: Vec<Vec3> = corners.iter().map(|(_, p)| Vec3::new(p.x, p.y, 0.0)).collect();
        let own = own_balls(hole);
        let balls = if balls.is_empty() { &own } else { balls };
        let over_hole = |face: &[u32; 3]| {
            let middle = face.iter().map(|&i| flat[i as usize]).sum::<Vec3>() / 3.0;
            raster.at(middle.x, middle.y).is_some_and(|cell| mask[cell])
        };
        let faces = pivot(&flat, &vec![Vec3::z(); flat.len()], balls);
        let faces: Vec<[u32; 3]> = faces.into_iter().filter(over_hole).collect();
        let covered = covered(hole, &flat, &faces);
        let heights = Heights::new(hole, &mask, &around);
        let ball = balls.iter().copied().fold(0.0, f64::max);
        let positions = corners.iter().map(|c| c.1).collect();
        Ok(Cover { mask, corners, positions, faces, density, ball, covered, heights })
    }

    /// A mesh of two triangles a cell, at the heights where the diffused field is zero.
    fn by_volume(
        hole: &Hole,
        (mask, corners): (Vec<bool>, Vec<(u32, Vec3)>),
        around: &[(u32, Vec3)],
        density: f64,
    ) -> Cover {
        let raster = &hole.raster;
        let (first, side) = Heights::window(raster, &mask);
        let nodes = volume::heights(hole, around, first, side);
        let corner = |i: usize| i as f64 * raster.cell - raster.half;
        let position = |n: usize| {
            let (u, v) = (corner(first.0 + n % side.0), corner(first.1 + n / side.0));
            Vec3::new(u, v, hole.surface.height(u, v) + nodes[n])
        };
        let positions = (0..nodes.len()).map(position).collect();
        let mut faces = Vec::new();
        for cell in (0..raster.len()).filter(|&cell| mask[cell]) {
            let n = (cell / raster.side - first.1) * side.0 + cell % raster.side - first.0;
            let [a, b, c, d] = [n, n + 1, n + 1 + side.0, n + side.0].map(|n| n as u32);
            faces.extend([[a, b, c], [a, c, d]]);
        }
        let heights = Heights { raster: *raster, first, side, nodes };
        Cover { mask, corners, positions, faces, density, ball: 0.0, covered: 1.0, heights }
    }

    /// Whether the mesh leaves no hole in the hole.
    pub fn is_closed(&self) -> bool {
        self.covered >= CLOSED
    }

    /// Height of the smooth surface [m].
    pub fn height(&self, hole: &Hole, u: f64, v: f64) -> f64 {
        hole.surface.height(u, v) + self.heights.at(u, v)
    }

    /// Local corners of a face, without height [m].
    pub fn triangle(&self, face: [u32; 3]) -> [Vec3; 3] {
        face.map(|i| self.positions[i as usize])
    }
}

/// Balls from the scale of the search to one that no hole of this width lets through.
fn own_balls(hole: &Hole) -> Vec<f64> {
    let scale = hole.fit;
    let mut balls = vec![0.75 * scale];
    while balls[balls.len() - 1] < 2.0 * hole.width {
        balls.push(balls[balls.len() - 1] * 2.0);
    }
    balls
}

/// Points per area of the surface in the ring around the mask.
fn density(hole: &Hole, mask: &[bool], ring: &[bool], around: &[(u32, Vec3)]) -> Option<f64> {
    let raster = &hole.raster;
    let mut occupied = vec![false; raster.len()];
    let mut count = 0u32;
    for cell in around.iter().filter_map(|(_, p)| raster.at(p.x, p.y)).filter(|&cell| !mask[cell]) {
        occupied[cell] = true;
        count += 1;
    }
    // Cells beyond the rim of the surface have no area: only those next to a point count.
    let cells: Vec<usize> = (0..raster.len()).filter(|&cell| occupied[cell]).collect();
    let near = raster.grown(&cells, 1.5);
    let area = |cell: usize| {
        let (u, v) = raster.middle(cell);
        raster.cell * raster.cell * hole.surface.stretch(u, v)
    };
    let whole: f64 = (0..raster.len()).filter(|&c| near[c] && ring[c] && !mask[c]).map(area).sum();
    (count >= 8 && whole > 0.0).then(|| f64::from(count) / whole)
}

/// At most one point a cell, the first: corners enough to hold the mesh.
fn thinned(raster: &Raster, around: &[(u32, Vec3)]) -> Vec<(u32, Vec3)> {
    let mut taken = vec![false; raster.len()];
    let first =
        |(_, p): &&(u32, Vec3)| raster.at(p.x, p.y).is_some_and(|c| !std::mem::replace(&mut taken[c], true));
    around.iter().filter(first).copied().collect()
}

/// Share of the open cells whose middle is under some face.
fn covered(hole: &Hole, flat: &[Vec3], faces: &[[u32; 3]]) -> f64 {
    let raster = &hole.raster;
    let mut under = vec![false; raster.len()];
    for face in faces {
        let tri = face.map(|i| flat[i as usize]);
        let (lo, hi) = geom::grid::bounds(&tri);
        let index =
            |c: f64| (((c + raster.half) / raster.cell).floor().max(0.0) as usize).min(raster.side - 1);
        for y in index(lo.y)..=index(hi.y) {
            for x in index(lo.x)..=index(hi.x) {
                let cell = y * raster.side + x;
                under[cell] = under[cell] || holds(&tri, raster.middle(cell));
            }
        }
    }
    hole.open.iter().filter(|&&cell| under[cell]).count() as f64 / hole.open.len() as f64
}

pub(crate) fn holds([a, b, c]: &[Vec3; 3], (u, v): (f64, f64)) -> bool {
    let side = |p: &Vec3, q: &Vec3| (q.x - p.x) * (v - p.y) - (q.y - p.y) * (u - p.x);
    side(a, b) >= 0.0 && side(b, c) >= 0.0 && side(c, a) >= 0.0
}

/// What the quadratic leaves, at the corners of the cells of a window of the raster.
struct Heights {
    raster: Raster,
    first: (usize, usize),
    side: (usize, usize),
    nodes: Vec<f64>,
}

impl Heights {
    fn new(hole: &Hole, mask: &[bool], around: &[(u32, Vec3)]) -> Heights {
        let raster = hole.raster;
        let (lo, side) = Heights::window(&raster, mask);
        let corner = |i: usize| i as f64 * raster.cell - raster.half;
        let spline = Spline::fit(&samples(hole, around));
        let node = |i: usize| {
            let (u, v) = (corner(lo.0 + i % side.0), corner(lo.1 + i / side.0));
            spline.as_ref().map_or(0.0, |spline| spline.height(u, v) - hole.surface.height(u, v))
        };
        Heights { raster, first: lo, side, nodes: (0..side.0 * side.1).map(node).collect() }
    }

    /// The first cell of the window that holds the mask, and its nodes along u and v.
    fn window(raster: &Raster, mask: &[bool]) -> ((usize, usize), (usize, usize)) {
        let (mut lo, mut hi) = ((usize::MAX, usize::MAX), (0, 0));
        for cell in (0..raster.len()).filter(|&cell| mask[cell]) {
            let (x, y) = (cell % raster.side, cell / raster.side);
            lo = (lo.0.min(x), lo.1.min(y));
            hi = (hi.0.max(x), hi.1.max(y));
        }
        (lo, (hi.0 + 2 - lo.0.min(hi.0), hi.1 + 2 - lo.1.min(hi.1)))
    }

    /// Between the four nodes around a position.
    fn at(&self, u: f64, v: f64) -> f64 {
        let along = |c: f64, first: usize, side: usize| {
            let t = ((c + self.raster.half) / self.raster.cell - first as f64).clamp(0.0, (side - 1) as f64);
            let i = (t as usize).min(side - 2);
            (i, t - i as f64)
        };
        let (x, s) = along(u, self.first.0, self.side.0);
        let (y, t) = along(v, self.first.1, self.side.1);
        let node = |x: usize, y: usize| self.nodes[y * self.side.0 + x];
        let low = node(x, y) * (1.0 - s) + node(x + 1, y) * s;
        let high = node(x, y + 1) * (1.0 - s) + node(x + 1, y + 1) * s;
        low * (1.0 - t) + high * t
    }
}

/// Mean positions of the points of squares, so wide that they are not too many, and at least as wide as the scale of the fit. A mean lies
/// on the surface: the mean of what the quadratic leaves is taken, which bends less.
fn samples(hole: &Hole, around: &[(u32, Vec3)]) -> Vec<Sample> {
    let mut scale = hole.fit;
    loop {
        let samples = means(hole, around, scale);
        if samples.len() <= MOST_SAMPLES {
            return samples;
        }
        scale *= 1.3;
    }
}

fn means(hole: &Hole, around: &[(u32, Vec3)], scale: f64) -> Vec<Sample> {
    let mut number: HashMap<(i64, i64), usize> = HashMap::new();
    let mut sums: Vec<(Vec3, f64)> = Vec::new();
    for (_, p) in around {
        let square = ((p.x / scale).floor() as i64, (p.y / scale).floor() as i64);
        let at = *number.entry(square).or_insert_with(|| {
            sums.push((Vec3::zeros(), 0.0));
            sums.len() - 1
        });
        sums[at].0 += Vec3::new(p.x, p.y, p.z - hole.surface.height(p.x, p.y));
        sums[at].1 += 1.0;
    }
    let mean = |(sum, count): (Vec3, f64)| {
        let mean = sum / count;
        Sample { position: mean + Vec3::z() * hole.surface.height(mean.x, mean.y), count }
    };
    sums.into_iter().map(mean).collect()
}
