//! Any triangles → signed distances whose surface is closed.
//!
//! Inside is where the triangles wind around a place by more than one half. Near triangles the value is the distance to them; across holes it
//! follows the winding number, which is smooth there, so that the surface goes on.

use crate::samples::Samples;
use crate::winding::Winding;
use geom::Vec3;
use geom::mesh::{TriMesh, closest_point};
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Distances are exact within this many steps.
const BAND: f64 = 2.0;
/// Nodes of a block along each side.
const BLOCK: usize = 6;
/// A node that is nearer to a triangle, in steps, lies on it: its own winding number says nothing.
const ON: f64 = 1e-6;
/// How far from a triangle, in steps, winding numbers say where the inside is.
const BESIDE: f64 = 0.01;
/// Most pieces of a triangle.
const CUTS: usize = 1 << 18;
/// Where the winding numbers of a block are this far from one half, all of it is on one side.
const CLEAR: f64 = 0.2;

/// What was found about the triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Orientation {
    /// Pieces that hang together across edges of two faces.
    pub pieces: usize,
    /// Faces that were turned to the other side.
    pub turned: usize,
}

/// Turns faces so that neighbours look to the same side, and each piece encloses a volume above 0.
pub fn orient(mesh: &mut TriMesh) -> Orientation {
    let mut beside: HashMap<(u32, u32), Vec<u32>> = HashMap::new();
    for (face, f) in (0u32..).zip(&mesh.faces) {
        for (a, b) in edges(f) {
            beside.entry((a.min(b), a.max(b))).or_default().push(face);
        }
    }
    let mut found = Orientation::default();
    let (mut seen, mut turned) = (vec![false; mesh.faces.len()], vec![false; mesh.faces.len()]);
    for start in 0..mesh.faces.len() {
        if seen[start] {
            continue;
        }
        found.pieces += 1;
        seen[start] = true;
        let mut piece = vec![start];
        let mut next = 0;
        while next < piece.len() {
            let face = piece[next];
            next += 1;
            for (a, b) in edges(&mesh.faces[face]) {
                let [f, g] = beside[&(a.min(b), a.max(b))][..] else { continue };
                let other = if f as usize == face { g } else { f } as usize;
                if !seen[other] {
                    seen[other] = true;
                    // Neighbours run along their edge in opposite directions.
                    if edges(&mesh.faces[other]).contains(&(a, b)) {
                        mesh.faces[other].swap(1, 2);
                        turned[other] = true;
                    }
                    piece.push(other);
                }
            }
        }
        outwards(mesh, &piece, &mut turned);
    }
    found.turned = turned.iter().filter(|t| **t).count();
    found
}

fn edges(&[a, b, c]: &[u32; 3]) -> [(u32, u32); 3] {
    [(a, b), (b, c), (c, a)]
}

/// Turns a whole piece if its volume, about its middle, is below 0.
fn outwards(mesh: &mut TriMesh, piece: &[usize], turned: &mut [bool]) {
    let corners = || piece.iter().map(|f| mesh.triangle(*f));
    let middle: Vec3 = corners().map(|t| t[0] + t[1] + t[2]).sum::<Vec3>() / (3.0 * piece.len() as f64);
    let volume: f64 = corners().map(|[a, b, c]| (a - middle).dot(&(b - middle).cross(&(c - middle)))).sum();
    if volume < 0.0 {
        for f in piece {
            mesh.faces[*f].swap(1, 2);
            turned[*f] = !turned[*f];
        }
    }
}

/// Samples whose inside is that of the triangles, with `cells` cells along the longest side.
pub fn sample(mesh: &TriMesh, cells: usize) -> Samples {
    let (lo, hi) = geom::grid::bounds(&mesh.vertices);
    let empty = Samples::over(&lo, &hi, cells, 3, f32::INFINITY);
    let winding = Winding::new(mesh);
    let mut samples = empty.clone();
    distances(mesh, &mut samples);
    if signed(&mut samples, &winding) {
        let (outline, step) = (without_inner(mesh, &winding, samples.step), samples.step);
        let on = std::mem::replace(&mut samples, empty).values;
        distances(&outline, &mut samples);
        signed(&mut samples, &winding);
        // Nodes on triangles that are gone: their own winding numbers say nothing.
        for (now, _) in samples.values.iter_mut().zip(on).filter(|(_, on)| *on == (ON * step) as f32) {
            *now = now.abs().max((ON * step) as f32);
        }
    }
    samples
}

/// Gives distances their signs; whether triangles lie inside, as those of bodies that overlap do.
fn signed(samples: &mut Samples, winding: &Winding) -> bool {
    let (step, inner) = (samples.step, AtomicBool::new(false));
    samples.in_blocks(BLOCK, |block| {
        let far = block.nodes().all(|at| block.value(at).is_infinite());
        let last = block.count.map(|n| n - 1);
        let corner = |c: usize| [0, 1, 2].map(|a| if c >> a & 1 == 1 { last[a] } else { 0 });
        let side = if far { clear((0..8).map(|c| winding.at(&block.place(corner(c))))) } else { None };
        for at in block.nodes() {
            let w = side.unwrap_or_else(|| winding.at(&block.place(at)) - 0.5);
            let distance = f64::from(*block.value(at));
            let on = distance <= ON * step;
            let twice = if on { is_inner(winding, &block.place(at), BESIDE * step) } else { w > 1.0 };
            *block.value(at) = if on {
                if twice { ON * step } else { 0.0 }
            } else if distance.is_finite() {
                distance.copysign(w)
            } else {
                (4.0 * w * step).clamp(-BAND * step, BAND * step)
            } as f32;
            if twice {
                inner.store(true, Relaxed);
            }
        }
    });
    inner.into_inner()
}

/// Whether the inside is all around a place, so far from it along each axis.
fn is_inner(winding: &Winding, place: &Vec3, far: f64) -> bool {
    let side = |c: usize, a: usize| if c >> a & 1 == 1 { far } else { -far };
    (0..8).all(|c| winding.at(&(place + Vec3::from([0, 1, 2].map(|a| side(c, a))))) > 0.5)
}

/// The triangles, cut into pieces of about a step, without those that have the inside on both sides: they are no surface.
fn without_inner(mesh: &TriMesh, winding: &Winding, step: f64) -> TriMesh {
    // Halved across the longest edge: a sliver becomes a row of pieces, not a square.
    let pieces = |triangle: [Vec3; 3]| {
        let (mut open, mut done) = (vec![triangle], Vec::new());
        while let Some(t) = open.pop() {
            let length = |k: usize| (t[(k + 1) % 3] - t[k]).norm();
            let longest = (0..3).max_by(|a, b| length(*a).total_cmp(&length(*b))).unwrap_or(0);
            if length(longest) <= step || done.len() + open.len() > CUTS {
                done.push(t);
                continue;
            }
            let [a, b, c] = [t[longest], t[(longest + 1) % 3], t[(longest + 2) % 3]];
            let middle = (a + b) / 2.0;
            open.extend([[middle, b, c], [a, middle, c]]);
        }
        done
    };
    let is_outline = |[a, b, c]: &[Vec3; 3]| {
        let middle = (a + b + c) / 3.0;
        let beside = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default() * (BESIDE * step);
        [middle + beside, middle - beside].iter().any(|p| winding.at(p) <= 0.5)
    };
    let triangles: Vec<[Vec3; 3]> = mesh.triangles().collect();
    let kept: Vec<[Vec3; 3]> = triangles.into_par_iter().flat_map_iter(pieces).filter(is_outline).collect();
    let faces = (0..kept.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    TriMesh { vertices: kept.into_flattened(), faces }
}

/// The side of a block of which these are the winding numbers of the corners, if it is clear.
fn clear(corners: impl Iterator<Item = f64>) -> Option<f64> {
    let (lo, hi) = corners.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), w| (lo.min(w), hi.max(w)));
    if lo > 0.5 + CLEAR {
        Some(0.5)
    } else if hi < 0.5 - CLEAR {
        Some(-0.5)
    } else {
        None
    }
}

/// Distances of the nodes near triangles.
fn distances(mesh: &TriMesh, samples: &mut Samples) {
    let (size, step, origin) = (samples.size, samples.step, samples.origin);
    let reach = BAND * step;
    let triangles: Vec<[Vec3; 3]> = mesh.triangles().collect();
    let range = |t: &[Vec3; 3], axis: usize| {
        let (lo, hi) = (
            t.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min),
            t.iter().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max),
        );
        let node = |v: f64| ((v - origin[axis]) / step).clamp(0.0, size[axis] as f64 - 1.0);
        (node(lo - reach).ceil() as usize, node(hi + reach).floor() as usize)
    };
    let slab = 8;
    samples.values.par_chunks_mut(size[0] * size[1] * slab).enumerate().for_each(|(k, values)| {
        let (first, last) = (k * slab, k * slab + values.len() / (size[0] * size[1]));
        for t in &triangles {
            let ((x0, x1), (y0, y1), (z0, z1)) = (range(t, 0), range(t, 1), range(t, 2));
            for z in z0.max(first)..(z1 + 1).min(last) {
                for (y, x) in (y0..=y1).flat_map(|y| (x0..=x1).map(move |x| (y, x))) {
                    let p = origin + Vec3::new(x as f64, y as f64, z as f64) * step;
                    let found = (closest_point(*t, p) - p).norm();
                    let value = &mut values[((z - first) * size[1] + y) * size[0] + x];
                    if found <= reach && (found as f32) < *value {
                        *value = found as f32;
                    }
                }
            }
        }
    });
}
