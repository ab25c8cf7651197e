//! The faces and edges of polyhedra, as rods.

use super::rod::{Rod, RodShape};
use crate::things::{solid::Solid, spheres::Spheres};

/// Edges and faces of a polyhedron between the spheres of these rows.
pub(super) fn rods(solid: &Solid, spheres: &Spheres, rows: &[u32], colour: [f32; 3]) -> Vec<Rod> {
    let at = |k: u32| spheres.at(rows[k as usize] as usize);
    let radius = spheres.radius(rows[0] as usize);
    let edge =
        |[a, b]: &[u32; 2]| Rod { ends: [at(*a), at(*b)], radii: [radius; 2], shape: RodShape::Cone, colour };
    let face = |f: &[u32; 3]| {
        let [a, b, c] = f.map(at);
        let out = (b - a).cross(&(c - a)).try_normalize(0.0)? * radius;
        let (ends, shape) = ([a + out, b + out], RodShape::Face(c + out));
        Some(Rod { ends, radii: [radius; 2], shape, colour })
    };
    let (faces, edges) = solid.parts();
    edges.iter().map(edge).chain(faces.iter().filter_map(face)).collect()
}
