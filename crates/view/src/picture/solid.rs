//! Clumps that are polyhedra: a sphere sits on each vertex of a mesh, faces and edges are between them.
//!
//! A run records the spheres of a clump and its volume, not its mesh. Where the hull of the centres has that volume, the mesh is the hull.
//! What is drawn is what touches others: the mesh with round edges, all places within the radius of the spheres of it.

use super::rods::{Rod, RodShape};
use crate::spheres::Spheres;
use geom::{Vec3, hull::hull_faces, mesh::TriMesh};
use record::ClumpRecord;

/// Volume of the hull over that of the clump [–]: a mesh that was thinned has a little less, one with dents a smaller volume than its hull.
const CONVEX: std::ops::Range<f64> = 0.85..1.03;

/// By how much of their radius spheres may be off the places of the record [–]: frames may be in single precision.
const MISFIT: f64 = 0.02;

/// A convex polyhedron.
pub(super) struct Solid {
    spheres: Vec<(Vec3, f64)>,
    /// Corners by their sphere.
    faces: Vec<[u32; 3]>,
    edges: Vec<[u32; 2]>,
}

impl Solid {
    /// The polyhedron of a clump; none where it is not convex, or no polyhedron.
    pub fn of(clump: &ClumpRecord) -> Option<Solid> {
        let spheres: Vec<(Vec3, f64)> =
            clump.spheres.iter().map(|s| (Vec3::new(s[0], s[1], s[2]), s[3])).collect();
        let vertices: Vec<Vec3> = spheres.iter().map(|s| s.0).collect();
        let mesh = TriMesh { faces: hull_faces(&vertices)?, vertices };
        let one_size = spheres.iter().all(|s| (s.1 / spheres[0].1 - 1.0).abs() < MISFIT);
        if !one_size || !CONVEX.contains(&(mesh.volume() / clump.volume)) {
            return None;
        }
        let faces = mesh.faces;
        let sides = |f: &[u32; 3]| [[f[0], f[1]], [f[1], f[2]], [f[2], f[0]]];
        let edges = faces.iter().flat_map(sides).filter(|[a, b]| a < b).collect();
        Some(Solid { spheres, faces, edges })
    }

    /// Whether these rows are its spheres, in its order, at any size and orientation.
    pub fn fits(&self, spheres: &Spheres, rows: &[u32]) -> bool {
        if rows.len() != self.spheres.len() {
            return false;
        }
        let at = |k: usize| spheres.at(rows[k] as usize);
        let scale = spheres.radius[rows[0] as usize] / self.spheres[0].1;
        let near = |a: f64, b: f64| (a - b).abs() <= MISFIT * spheres.radius[rows[0] as usize];
        let far = |k: usize, n: usize| scale * (self.spheres[k].0 - self.spheres[n].0).norm();
        let last = rows.len() - 1;
        (0..rows.len()).all(|k| {
            near(spheres.radius[rows[k] as usize], scale * self.spheres[k].1)
                && [0, last / 2, last].iter().all(|&n| near((at(k) - at(n)).norm(), far(k, n)))
        })
    }

    /// Its edges and faces between these spheres.
    pub fn rods(&self, spheres: &Spheres, rows: &[u32], colour: [f32; 3]) -> Vec<Rod> {
        let at = |k: u32| spheres.at(rows[k as usize] as usize);
        let radius = spheres.radius[rows[0] as usize];
        let edge = |[a, b]: &[u32; 2]| Rod {
            ends: [at(*a), at(*b)],
            radii: [radius; 2],
            shape: RodShape::Cone,
            colour,
        };
        let face = |f: &[u32; 3]| {
            let [a, b, c] = f.map(at);
            let out = (b - a).cross(&(c - a)).try_normalize(0.0)? * radius;
            let (ends, shape) = ([a + out, b + out], RodShape::Face(c + out));
            Some(Rod { ends, radii: [radius; 2], shape, colour })
        };
        self.edges.iter().map(edge).chain(self.faces.iter().filter_map(face)).collect()
    }
}
