//! The second way to mesh a hole: a field of signed distances, zero on the surface, that is diffused into the hole.
//!
//! ```text
//! φ(x) = Σ wₖ (x − pₖ)·nₖ / Σ wₖ,   wₖ = (1 − |x − pₖ|²/R²)²     where at least 3 points are within R of x: known
//! ∇²φ = 0                                                         elsewhere; ±h at the top and the bottom of the box
//! ```
//!
//! Weighted signed distances: Curless & Levoy (1996), doi:10.1145/237170.237269. Diffusion into what is not known: Davis, Marschner, Garr &
//! Levoy (2002), doi:10.1109/TDPVT.2002.1024098; theirs is stopped after some steps, here it has come to rest. Deviation: the box
//! is aligned with the hole's surroundings, and the sheet of the zero surface nearest to their quadratic is taken, so overhangs are
//! closed flat. The surface bends as little as a membrane may, so where it is curved it lies lower than that of the first way.

use crate::holes::hole::Hole;
use crate::holes::surface::sheet;
use geom::{Grid, Vec3};

/// Radius R, in scales of the search.
const REACH: f64 = 1.75;
/// Points that make a node known.
const KNOWN: usize = 3;
/// Most nodes of a box.
const MOST: f64 = 1.5e6;
/// Sweeps of over-relaxation, a node of the longest side, and its factor.
const SWEEPS: usize = 4;
const OVER: f64 = 1.9;

/// Nodes of a box: u fastest, then v, then the height over the quadratic w.
struct Field {
    first: (f64, f64),
    low: f64,
    step: (f64, f64),
    side: [usize; 3],
    values: Vec<f64>,
    known: Vec<bool>,
}

/// Heights over the hole's quadratic [m] at nodes of the raster: `side` of them along u and v from the corner of cell `first`.
pub(crate) fn heights(
    hole: &Hole,
    around: &[(u32, Vec3)],
    first: (usize, usize),
    side: (usize, usize),
) -> Vec<f64> {
    let scale = hole.fit;
    // Flattened by the quadratic: the field starts as the distance from it.
    let points: Vec<Vec3> =
        around.iter().map(|(_, p)| Vec3::new(p.x, p.y, p.z - hole.surface.height(p.x, p.y))).collect();
    let reach = REACH * scale;
    let (low, high) = points.iter().fold((0.0f64, 0.0f64), |(a, b), p| (a.min(p.z), b.max(p.z)));
    let (low, high) = (low - 2.0 * reach, high + 2.0 * reach);
    let across = hole.raster.cell;
    let layers = (MOST / (side.0 * side.1) as f64).max(8.0);
    let step = across.max((high - low) / layers);
    let count = ((high - low) / step).ceil() as usize + 1;
    let corner = |i: usize| i as f64 * across - hole.raster.half;
    let mut field = Field {
        first: (corner(first.0), corner(first.1)),
        low,
        step: (across, step),
        side: [side.0, side.1, count],
        values: Vec::new(),
        known: Vec::new(),
    };
    field.fill(&points, reach);
    field.diffuse();
    (0..side.0 * side.1).map(|column| field.zero(column)).collect()
}

impl Field {
    fn position(&self, node: usize) -> Vec3 {
        let [nu, nv, _] = self.side;
        let (u, v, w) = (node % nu, node / nu % nv, node / (nu * nv));
        let (across, up) = self.step;
        Vec3::new(
            self.first.0 + u as f64 * across,
            self.first.1 + v as f64 * across,
            self.low + w as f64 * up,
        )
    }

    /// Signed distances where points are near; elsewhere the height.
    fn fill(&mut self, points: &[Vec3], reach: f64) {
        let grid = Grid::new(points, reach);
        let normal = |p: &Vec3| {
            let near: Vec<Vec3> = grid.within(points, *p, reach).map(|j| points[j as usize] - p).collect();
            let normal = sheet::normal(&near).unwrap_or_else(Vec3::z);
            if normal.z < 0.0 { -normal } else { normal }
        };
        let normals: Vec<Vec3> = points.iter().map(normal).collect();
        let count = self.side.iter().product();
        for node in 0..count {
            let x = self.position(node);
            let (mut sum, mut weights, mut number) = (0.0, 0.0, 0);
            for k in grid.within(points, x, reach) {
                let off = x - points[k as usize];
                let share = 1.0 - off.norm_squared() / (reach * reach);
                sum += share * share * off.dot(&normals[k as usize]);
                weights += share * share;
                number += 1;
            }
            let known = number >= KNOWN && weights > 0.0;
            self.known.push(known);
            self.values.push(if known { sum / weights } else { x.z.clamp(-reach, reach) });
        }
    }

    /// Solves Laplace's equation where nothing is known, by over-relaxation; at the sides of the box nothing flows.
    fn diffuse(&mut self) {
        let [nu, nv, nw] = self.side;
        let longest = nu.max(nv);
        let (across, up) = (1.0 / (self.step.0 * self.step.0), 1.0 / (self.step.1 * self.step.1));
        for _ in 0..SWEEPS * longest {
            for node in nu * nv..nu * nv * nw.saturating_sub(1) {
                if self.known[node] {
                    continue;
                }
                let (u, v) = (node % nu, node / nu % nv);
                let (mut sum, mut weight) =
                    (up * (self.values[node - nu * nv] + self.values[node + nu * nv]), 2.0 * up);
                let mut add = |there: bool, other: usize| {
                    if there {
                        sum += across * self.values[other];
                        weight += across;
                    }
                };
                add(u > 0, node.wrapping_sub(1));
                add(u + 1 < nu, node + 1);
                add(v > 0, node.wrapping_sub(nu));
                add(v + 1 < nv, node + nu);
                let value = &mut self.values[node];
                *value += OVER * (sum / weight - *value);
            }
        }
    }

    /// Where the field of a column passes zero upwards, nearest to the quadratic [m]; zero when it does not.
    fn zero(&self, column: usize) -> f64 {
        let [nu, nv, nw] = self.side;
        let at = |w: usize| self.values[w * nu * nv + column];
        let crossing = |w: usize| {
            let (a, b) = (at(w), at(w + 1));
            (a < 0.0 && b >= 0.0).then(|| self.low + self.step.1 * (w as f64 + a / (a - b)))
        };
        let all = (0..nw - 1).filter_map(crossing);
        all.min_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0)
    }
}
