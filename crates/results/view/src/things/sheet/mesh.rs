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
    let parts = kept(mesh);
    let mesh = mesh.welded();
    debug_assert_eq!(parts.len(), mesh.faces.len());
    let (lines, closed) = edges(&mesh);
    Sheet {
        surface,
        vertices: mesh.vertices,
        faces: mesh.faces,
        parts,
        lines,
        ink: 0.65,
        closed,
        whole: true,
    }
}

/// Numbers of the faces that welding keeps: those with three different corners.
fn kept(mesh: &TriMesh) -> Vec<u32> {
    let whole = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|v| mesh.vertices[v as usize]);
        a != b && b != c && c != a
    };
    mesh.faces.iter().zip(0..).filter(|(face, _)| whole(face)).map(|(_, number)| number).collect()
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

    /// The part of a run is the number of a face in its file, also where some faces have no area.
    #[test]
    fn faces_that_welding_drops_do_not_shift_the_numbers_of_others() {
        let at = |x: f64, y: f64| Vec3::new(x, y, 0.0);
        let vertices = vec![at(0.0, 0.0), at(1.0, 0.0), at(0.0, 1.0), at(-0.0, 0.0), at(1.0, 1.0)];
        let mesh = TriMesh { vertices, faces: vec![[0, 1, 2], [0, 3, 1], [1, 4, 2]] };
        assert_eq!((kept(&mesh), mesh.welded().faces.len()), (vec![0, 2], 2));
    }

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
