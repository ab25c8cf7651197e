//! A unit sphere of triangles about as large as each other.

use geom::Vec3;
use geom::mesh::TriMesh;
use nalgebra::UnitQuaternion;

/// An octahedron, turned; the edges of its faces are halved so many times.
pub(crate) fn sphere(turn: &UnitQuaternion<f64>, levels: u32) -> TriMesh {
    let mut mesh = TriMesh {
        vertices: [Vec3::x(), Vec3::y(), Vec3::z()].iter().flat_map(|a| [turn * a, turn * -a]).collect(),
        faces: vec![[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]],
    };
    for _ in 0..levels {
        let mut vertices = Vec::new();
        for [a, b, c] in mesh.triangles() {
            let [d, e, f] = [(a, b), (b, c), (c, a)].map(|(p, q)| ((p + q) / 2.0).normalize());
            vertices.extend([a, d, f, d, b, e, f, e, c, d, e, f]);
        }
        let faces = (0..vertices.len() as u32 / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        mesh = TriMesh { vertices, faces }.welded();
    }
    mesh
}
