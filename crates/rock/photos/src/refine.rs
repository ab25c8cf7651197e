//! From the hull inwards: where photographs agree on a place of the surface, the surface moves there.
//!
//! ```text
//! o* = argmax over o of  mean NCC of the patch around x − o n, as the photographs show it       x on the surface, n its normal
//! u  = argmin  Σ w (u − o*)² + λ Σ over edges (u_i − u_j)²                                     w = max(0, NCC − 0.6)²
//! ```
//!
//! NCC at an offset is averaged over the neighbours on the surface first: where a patch has few speckles it is high at some wrong offsets, but
//! not at the same ones beside it. Most offsets are inwards, so that a wrong one takes something off the stone.
//!
//! The patch is a square in the plane across n; the most frontal photograph that sees x is compared with others some degrees beside it. NCC is the
//! normalized correlation of light, as in Furukawa & Ponce (2010), doi:10.1109/TPAMI.2009.161. The moved surface is closed again by its winding
//! number, and it never leaves the hull. Hollows that no silhouette shows come out only so.

mod patch;

use crate::hull::View;
use crate::rendered::raster::{NONE, faces};
use geom::Vec3;
use geom::mesh::TriMesh;
use rayon::prelude::*;
use remesh::{soup, surface};
use serde::Serialize;

pub use patch::Crop;

/// A photograph for correlation: its view, and its light around the stone.
#[derive(Debug, Clone)]
pub struct Shot {
    /// Camera and silhouette.
    pub view: View,
    /// Light around the stone.
    pub crop: Crop,
}

/// Steps inwards that are tried, and outwards, each half a cell.
const INWARDS: i32 = 12;
const OUTWARDS: i32 = 2;
/// Weight of the differences between neighbours.
const SMOOTH: f64 = 0.05;
/// Passes of the smoothing.
const PASSES: usize = 60;
/// Correlations that count.
const LEAST: f64 = 0.6;
/// A correlation must be better than that of the surface by this for it to move.
const MARGIN: f64 = 0.08;
/// Times that correlations are averaged over neighbours.
const SHARED: usize = 6;
/// Rounds; each sees the surface of the one before.
const ROUNDS: usize = 3;

/// What was done.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Refinement {
    /// Share of the vertices whose photographs agree [–].
    pub agreed: f64,
    /// Mean correlation of those [–].
    pub correlation: f64,
}

/// Moves the surface of a hull to where photographs agree; `cells` along the longest side.
pub fn refine(hull: &TriMesh, shots: &[Shot], cells: usize, done: impl Fn(usize)) -> (TriMesh, Refinement) {
    let (lo, hi) = geom::grid::bounds(&hull.vertices);
    let step = (hi - lo).max() / cells as f64;
    let mut mesh = hull.clone();
    let mut refinement = Refinement { agreed: 0.0, correlation: 0.0 };
    for round in 0..ROUNDS {
        let normals = normals(&mesh);
        let seen: Vec<Vec<bool>> = shots.par_iter().map(|s| visible(&mesh, s, step)).collect();
        let of = |v: usize| {
            let shots: Vec<&Shot> = (0..shots.len()).filter(|k| seen[*k][v]).map(|k| &shots[k]).collect();
            curve(&mesh.vertices[v], &normals[v], &shots, step)
        };
        let curves: Vec<Option<Curve>> = (0..mesh.vertices.len()).into_par_iter().map(of).collect();
        let beside = neighbours(&mesh);
        let found: Vec<Option<(f64, f64)>> =
            shared(curves, &beside).iter().map(|c| c.as_ref().and_then(|c| best(c, step / 2.0))).collect();
        let agreed: Vec<f64> = found.iter().flatten().map(|f| f.1).collect();
        refinement.agreed = agreed.len() as f64 / found.len() as f64;
        refinement.correlation = agreed.iter().sum::<f64>() / agreed.len().max(1) as f64;
        let moves = smoothed(&beside, &found);
        for (v, p) in mesh.vertices.iter_mut().enumerate() {
            *p -= normals[v] * moves[v];
            // Back into the hull.
            let out = shots.iter().map(|s| s.view.distance(p)).fold(f64::INFINITY, f64::min);
            if out < 0.0 {
                *p += normals[v] * out.max(-step);
            }
        }
        done(round + 1);
    }
    // Once only: each time a coarse grid takes a little off round sides.
    (surface(soup::sample(&mesh, cells)).unwrap_or(mesh), refinement)
}

/// Unit normals of the vertices, weighted by area.
fn normals(mesh: &TriMesh) -> Vec<Vec3> {
    let mut sum = vec![Vec3::zeros(); mesh.vertices.len()];
    for (f, [a, b, c]) in mesh.faces.iter().zip(mesh.triangles()) {
        let across = (b - a).cross(&(c - a));
        f.iter().for_each(|v| sum[*v as usize] += across);
    }
    sum.into_iter().map(|n| n.try_normalize(0.0).unwrap_or_else(Vec3::z)).collect()
}

/// Whether a photograph sees each vertex: no face is nearer by more than two steps.
fn visible(mesh: &TriMesh, shot: &Shot, step: f64) -> Vec<bool> {
    let ([w, h], longest) = (shot.view.field.frame(), 480.0);
    let factor = (longest / w.max(h)).min(1.0);
    let (width, height) = ((w * factor).round() as usize, (h * factor).round() as usize);
    let camera = shot.view.camera.resized(factor);
    let image = faces(mesh, &camera, width, height, 1);
    let eye = camera.eye();
    let of = |p: &Vec3| {
        let ([x, y], depth) = camera.project(p);
        let (u, v) = (x.round(), y.round());
        if !(depth > 0.0 && u >= 0.0 && v >= 0.0 && u < width as f64 && v < height as f64) {
            return false;
        }
        let face = image[v as usize * width + u as usize];
        if face == NONE {
            return true;
        }
        let [a, b, c] = mesh.triangle(face as usize);
        let (n, ray) = ((b - a).cross(&(c - a)), (p - eye).normalize());
        let along = n.dot(&(a - eye)) / n.dot(&ray);
        (p - eye).norm() < along + 2.0 * step
    };
    mesh.vertices.iter().map(of).collect()
}

/// Correlations at the offsets that are tried, the farthest outwards first.
type Curve = [f64; (OUTWARDS + INWARDS + 1) as usize];

/// Correlations of a vertex; `None` where no two photographs see it.
fn curve(place: &Vec3, normal: &Vec3, shots: &[&Shot], step: f64) -> Option<Curve> {
    let chosen = patch::chosen(place, normal, shots)?;
    let mut all = [0.0; (OUTWARDS + INWARDS + 1) as usize];
    let mut known = false;
    for (value, k) in all.iter_mut().zip(-OUTWARDS..=INWARDS) {
        let at = place - normal * (f64::from(k) * step / 2.0);
        if let Some(score) = patch::correlation(&at, normal, &chosen) {
            (*value, known) = (score, true);
        }
    }
    known.then_some(all)
}

/// Vertices beside each vertex.
fn neighbours(mesh: &TriMesh) -> Vec<Vec<u32>> {
    let mut beside: Vec<Vec<u32>> = vec![Vec::new(); mesh.vertices.len()];
    for &[a, b, c] in &mesh.faces {
        for (v, w) in [(a, b), (b, c), (c, a)] {
            beside[v as usize].push(w);
        }
    }
    beside
}

/// Means of correlations over neighbours: a chance agreement is at another offset there.
fn shared(mut curves: Vec<Option<Curve>>, beside: &[Vec<u32>]) -> Vec<Option<Curve>> {
    for _ in 0..SHARED {
        curves = (0..curves.len())
            .into_par_iter()
            .map(|v| {
                let mut sum = curves[v]?;
                let mut count = 1.0;
                for near in beside[v].iter().filter_map(|w| curves[*w as usize]) {
                    sum.iter_mut().zip(near).for_each(|(s, n)| *s += n);
                    count += 1.0;
                }
                Some(sum.map(|s| s / count))
            })
            .collect();
    }
    curves
}

/// The best offset inwards [m], and its correlation; `None` where photographs do not agree.
fn best(all: &Curve, delta: f64) -> Option<(f64, f64)> {
    let top = (0..all.len()).max_by(|a, b| all[*a].total_cmp(&all[*b]))?;
    // Where the surface is right by a small margin it stays: most of a hull is right.
    let here = all[OUTWARDS as usize];
    if here > LEAST && here > all[top] - MARGIN {
        return Some((0.0, here));
    }
    if all[top] <= LEAST || top == 0 || top + 1 == all.len() {
        return None;
    }
    // The top of a parabola through three.
    let (a, b, c) = (all[top - 1], all[top], all[top + 1]);
    let bend = a - 2.0 * b + c;
    let shift = if bend < 0.0 { (0.5 * (a - c) / bend).clamp(-0.5, 0.5) } else { 0.0 };
    Some(((top as f64 + shift - f64::from(OUTWARDS)) * delta, all[top]))
}

/// Offsets of all vertices from those that are known.
fn smoothed(beside: &[Vec<u32>], found: &[Option<(f64, f64)>]) -> Vec<f64> {
    // Of a vertex and its neighbours the middle one: single wrong offsets go.
    let middle = |v: usize| {
        let all = beside[v].iter().map(|w| *w as usize).chain([v]).filter_map(|w| found[w]);
        let mut near: Vec<f64> = all.map(|f| f.0).collect();
        near.sort_by(f64::total_cmp);
        found[v].and_then(|(_, score)| near.get(near.len() / 2).map(|o| (*o, (score - LEAST).powi(2))))
    };
    let data: Vec<Option<(f64, f64)>> = (0..found.len()).map(middle).collect();
    let mut at: Vec<f64> = data.iter().map(|d| d.map_or(0.0, |d| d.0)).collect();
    for _ in 0..PASSES {
        at = (0..at.len())
            .into_par_iter()
            .map(|v| {
                let (o, w) = data[v].unwrap_or((0.0, 1e-4));
                let sum: f64 = beside[v].iter().map(|n| at[*n as usize]).sum();
                (w * o + SMOOTH * sum) / (w + SMOOTH * beside[v].len() as f64)
            })
            .collect();
    }
    at
}
