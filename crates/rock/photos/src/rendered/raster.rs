//! What each sample of a photograph sees: the nearest triangle.

use crate::camera::Camera;
use geom::mesh::TriMesh;
use rayon::prelude::*;

/// No face.
pub(crate) const NONE: u32 = u32::MAX;

/// Corners of a triangle on the picture of samples, its face, and 1/depth of the corners.
struct Drawn {
    at: [[f64; 2]; 3],
    inverse: [f64; 3],
    face: usize,
}

/// Of w × h samples, `samples` a pixel along each side: the face that is seen, or [`NONE`].
pub(crate) fn faces(mesh: &TriMesh, camera: &Camera, w: usize, h: usize, samples: usize) -> Vec<u32> {
    let n = samples as f64;
    let projected: Vec<([f64; 2], f64)> = mesh
        .vertices
        .iter()
        .map(|v| {
            let (p, depth) = camera.project(v);
            (p.map(|c| (c + 0.5) * n - 0.5), depth)
        })
        .collect();
    let drawn = |face: usize| {
        let corners = mesh.faces[face].map(|v| projected[v as usize]);
        let visible = corners.iter().all(|c| c.1 > 0.0);
        visible.then(|| Drawn { at: corners.map(|c| c.0), inverse: corners.map(|c| 1.0 / c.1), face })
    };
    let all: Vec<Drawn> = (0..mesh.faces.len()).filter_map(drawn).collect();
    let band = h.div_ceil(16).max(1);
    let mut out = vec![NONE; w * h];
    out.par_chunks_mut(w * band).enumerate().for_each(|(k, rows)| {
        let mut depth = vec![0.0; rows.len()];
        let (first, last) = (k * band, k * band + rows.len() / w);
        for triangle in &all {
            draw(triangle, [w, first, last], &mut depth, rows);
        }
    });
    out
}

fn draw(t: &Drawn, [w, first, last]: [usize; 3], depth: &mut [f64], rows: &mut [u32]) {
    let [a, b, c] = t.at;
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if area == 0.0 {
        return;
    }
    let range = |axis: usize, from: usize, to: usize| {
        let values = t.at.map(|p| p[axis]);
        let lo = values.iter().fold(f64::INFINITY, |m, v| m.min(*v)).max(from as f64).ceil();
        let hi = values.iter().fold(f64::NEG_INFINITY, |m, v| m.max(*v)).min(to as f64 - 1.0);
        (lo as usize, if hi < lo { 0 } else { hi as usize + 1 })
    };
    let ((x0, x1), (y0, y1)) = (range(0, 0, w), range(1, first, last));
    for y in y0..y1 {
        for x in x0..x1 {
            let p = [x as f64, y as f64];
            let side = |q: [f64; 2], r: [f64; 2]| {
                ((r[0] - q[0]) * (p[1] - q[1]) - (r[1] - q[1]) * (p[0] - q[0])) / area
            };
            let weights = [side(b, c), side(c, a), side(a, b)];
            if weights.iter().any(|s| *s < 0.0) {
                continue;
            }
            let inverse: f64 = (0..3).map(|k| weights[k] * t.inverse[k]).sum();
            let at = (y - first) * w + x;
            if inverse > depth[at] {
                depth[at] = inverse;
                rows[at] = t.face as u32;
            }
        }
    }
}
