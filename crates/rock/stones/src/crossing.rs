//! Whether meshes overlap, exactly, and whether a mesh crosses itself.

use crate::stone::around;
use crate::triangles::{folded, meet, segment_meets};
use geom::mesh::TriMesh;
use geom::{Boxes, Vec3};
use rayon::prelude::*;

/// Crossings that are counted.
const MOST: usize = 1000;

/// Pairs of faces of a mesh that meet elsewhere than in the corners and edges that they share; the first [`MOST`], in order.
pub(crate) fn of_itself(mesh: &TriMesh, boxes: &Boxes) -> Vec<(usize, usize)> {
    let pairs = |face: usize| {
        let mut found = Vec::new();
        let (centre, reach) = ball_around(&mesh.triangle(face));
        boxes.near(centre, reach, |other| {
            if other as usize > face && faces_cross(mesh, face, other as usize) {
                found.push((face, other as usize));
            }
        });
        found.sort_unstable();
        found
    };
    let all: Vec<(usize, usize)> = (0..mesh.faces.len()).into_par_iter().flat_map_iter(pairs).collect();
    all.into_iter().take(MOST).collect()
}

/// A ball that holds the box of a triangle: centre and radius [m].
pub(crate) fn ball_around(triangle: &[Vec3; 3]) -> (Vec3, f64) {
    let [lo, hi] = around(*triangle);
    // Beyond what rounding takes from it.
    ((lo + hi) / 2.0, (hi - lo).norm() * 0.500_001)
}

fn faces_cross(mesh: &TriMesh, first: usize, second: usize) -> bool {
    let (f, g) = (mesh.faces[first], mesh.faces[second]);
    let (a, b) = (mesh.triangle(first), mesh.triangle(second));
    let [p, q] = [around(a), around(b)];
    if (0..3).any(|k| p[0][k] > q[1][k] || q[0][k] > p[1][k]) {
        return false;
    }
    let shared: Vec<(usize, usize)> =
        (0..3).filter_map(|i| g.iter().position(|v| *v == f[i]).map(|j| (i, j))).collect();
    match shared[..] {
        [] => meet(&a, &b),
        [(i, j)] => {
            // The edges opposite to the shared corner.
            segment_meets(&a[(i + 1) % 3], &a[(i + 2) % 3], &b)
                || segment_meets(&b[(j + 1) % 3], &b[(j + 2) % 3], &a)
        }
        [(i, j), (k, l)] => folded(&a[i], &a[k], &a[3 - i - k], &b[3 - j - l]),
        _ => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stone::tests::ball;

    #[test]
    fn neighbouring_faces_of_a_closed_mesh_do_not_count() {
        let mesh = ball(0.1, 3);
        let boxes = Boxes::new(&mesh.triangles().map(around).collect::<Vec<_>>());
        assert_eq!(of_itself(&mesh, &boxes), []);
        // One corner pushed through the ball: faces around it cross the far side.
        let mut pushed = mesh.clone();
        pushed.vertices[0] *= -1.1;
        let boxes = Boxes::new(&pushed.triangles().map(around).collect::<Vec<_>>());
        assert!(!of_itself(&pushed, &boxes).is_empty());
    }
}
