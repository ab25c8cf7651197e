//! A mesh as a sheet: its lines are its rims and the edges where it bends.

use super::Sheet;
use crate::WallSurface;
use geom::{Vec3, mesh::TriMesh};
use std::collections::BTreeMap;

/// Cosine of the angle between two faces [–] above which their common edge is not drawn: 25°.
const FLAT: f64 = 0.906;

/// The same for meshes of many faces, which are scans more often than constructions: 50°.
const ROUGH: f64 = 0.643;

/// Many faces.
const MANY: usize = 500;

/// The sheet of a mesh.
pub fn sheet<'a>(surface: &'a WallSurface, mesh: &TriMesh) -> Sheet<'a> {
    let mesh = mesh.welded();
    let (lines, closed) = edges(&mesh);
    Sheet { surface, vertices: mesh.vertices, faces: mesh.faces, lines, ink: 0.65, closed, whole: true }
}

/// Edges of one face, of more than two, or between two faces that bend; and whether all edges are of two faces.
fn edges(mesh: &TriMesh) -> (Vec<[Vec3; 2]>, bool) {
    let mut faces: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for (face, [a, b, c]) in mesh.faces.iter().enumerate() {
        for [u, v] in [[a, b], [b, c], [c, a]] {
            faces.entry([*u.min(v), *u.max(v)]).or_default().push(face);
        }
    }
    let normal = |face: usize| {
        let [a, b, c] = mesh.triangle(face);
        (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default()
    };
    let flat = if mesh.faces.len() > MANY { ROUGH } else { FLAT };
    let closed = faces.values().all(|on| on.len() == 2);
    let bends = |on: &Vec<usize>| match on[..] {
        [one, other] => normal(one).dot(&normal(other)).abs() < flat,
        _ => true,
    };
    let drawn = faces.into_iter().filter(|(_, on)| bends(on));
    (drawn.map(|(ends, _)| ends.map(|v| mesh.vertices[v as usize])).collect(), closed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_a_folded_square_the_fold_and_the_rim_are_drawn_and_the_diagonals_are_not() {
        let corner = |x: f64, z: f64| [Vec3::new(x, 0.0, z), Vec3::new(x, 1.0, z)];
        let vertices = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0)].concat();
        let faces = vec![[0, 2, 3], [0, 3, 1], [2, 4, 5], [2, 5, 3]];
        let (lines, closed) = edges(&TriMesh { vertices, faces });
        assert!(lines.len() == 7 && !closed);
        assert!(edges(&geom::mesh::cuboid(Vec3::zeros(), Vec3::repeat(1.0))).1);
    }
}
