//! Triangle meshes: area, volume, nearest point, and whether a position is inside.

use crate::{Transform, Vec3};
use std::collections::HashMap;
use thiserror::Error;

pub use crate::inside::Inside;
use crate::triangle::solid_angle;
pub use crate::triangle::{Feature, closest_feature, closest_point};

/// Triangles over shared vertices; seen from outside, corners run anticlockwise.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TriMesh {
    /// Positions of the vertices [m].
    pub vertices: Vec<Vec3>,
    /// Three vertex numbers per face.
    pub faces: Vec<[u32; 3]>,
}

/// What makes a mesh unfit for a use.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum MeshError {
    /// A face names a vertex that is not there.
    #[error("face {face} names vertex {vertex}, but there are {vertices} vertices")]
    NoSuchVertex {
        /// Number of the face.
        face: usize,
        /// The vertex it names.
        vertex: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A coordinate that is NaN or infinite.
    #[error("vertex {0} has a coordinate that is not finite")]
    NotFinite(usize),
    /// Edges that do not join exactly two faces.
    #[error(
        "mesh is not closed: {open} of its edges do not join two faces; close the mesh, because its inside is needed"
    )]
    Open {
        /// How many such edges.
        open: usize,
    },
    /// No face at all.
    #[error("mesh has no face")]
    Empty,
}

impl TriMesh {
    /// Checks that faces name existing vertices and that positions are finite.
    ///
    /// # Errors
    /// A face names a missing vertex, or a vertex is not finite.
    pub fn new(vertices: Vec<Vec3>, faces: Vec<[u32; 3]>) -> Result<TriMesh, MeshError> {
        let count = vertices.len();
        if let Some(bad) = vertices.iter().position(|v| !v.iter().all(|c| c.is_finite())) {
            return Err(MeshError::NotFinite(bad));
        }
        for (face, corners) in faces.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= count) {
                return Err(MeshError::NoSuchVertex { face, vertex, vertices: count });
            }
        }
        Ok(TriMesh { vertices, faces })
    }

    /// Multiplies all lengths.
    pub fn scale(&mut self, factor: f64) {
        self.vertices.iter_mut().for_each(|v| *v *= factor);
    }

    /// Transforms all vertices; faces keep their orientation, because a [`Transform`] does not mirror.
    pub fn transform(&mut self, by: &Transform) {
        self.vertices.iter_mut().for_each(|v| *v = by.point(v));
    }

    /// Corners of face `face` [m].
    pub fn triangle(&self, face: usize) -> [Vec3; 3] {
        self.faces[face].map(|v| self.vertices[v as usize])
    }

    /// Corners of every face [m], in order.
    pub fn triangles(&self) -> impl Iterator<Item = [Vec3; 3]> + '_ {
        self.faces.iter().map(|f| f.map(|v| self.vertices[v as usize]))
    }

    /// Sum of the areas of the faces [m²].
    pub fn area(&self) -> f64 {
        self.triangles().map(area).sum()
    }

    /// Enclosed volume [m³]; negative when the faces look inwards, meaningless when the mesh is open.
    pub fn volume(&self) -> f64 {
        let Some(&origin) = self.vertices.first() else { return 0.0 };
        let signed = |[a, b, c]: [Vec3; 3]| (a - origin).dot(&(b - origin).cross(&(c - origin))) / 6.0;
        self.triangles().map(signed).sum()
    }

    /// The same surface with vertices at equal positions merged (STL and triangle soups repeat them).
    pub fn welded(&self) -> TriMesh {
        let mut seen: HashMap<[u64; 3], u32> = HashMap::new();
        let mut vertices = Vec::new();
        let mut renamed = Vec::with_capacity(self.vertices.len());
        for v in &self.vertices {
            // Adding zero makes one of the two zeros.
            let key = [v.x, v.y, v.z].map(|c| (c + 0.0).to_bits());
            renamed.push(*seen.entry(key).or_insert_with(|| {
                vertices.push(*v);
                vertices.len() as u32 - 1
            }));
        }
        let faces = self.faces.iter().map(|f| f.map(|v| renamed[v as usize]));
        let faces = faces.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        TriMesh { vertices, faces }
    }

    /// Number of edges that do not join exactly two faces; 0 for a closed surface.
    pub fn open_edges(&self) -> usize {
        let mut count: HashMap<(u32, u32), u32> = HashMap::new();
        for &[a, b, c] in &self.faces {
            for (u, v) in [(a, b), (b, c), (c, a)] {
                *count.entry((u.min(v), u.max(v))).or_default() += 1;
            }
        }
        count.values().filter(|&&n| n != 2).count()
    }

    /// The point of the surface nearest to `p` [m], and its face; checks every face. `None` without faces.
    pub fn closest(&self, p: Vec3) -> Option<(Vec3, usize)> {
        let mut best: Option<(f64, Vec3, usize)> = None;
        for (face, tri) in self.triangles().enumerate() {
            let point = closest_point(tri, p);
            let distance = (point - p).norm_squared();
            if best.is_none_or(|(least, ..)| distance < least) {
                best = Some((distance, point, face));
            }
        }
        best.map(|(_, point, face)| (point, face))
    }

    /// How often the surface winds around `p` [–]: 1 inside a closed mesh, 0 outside, between in an open one.
    pub fn winding(&self, p: Vec3) -> f64 {
        self.triangles().map(|triangle| solid_angle(&triangle, &p)).sum::<f64>()
            / (4.0 * std::f64::consts::PI)
    }

    /// Whether `p` [m] is inside a closed mesh; checks every face (for many positions use [`Inside`]).
    pub fn contains(&self, p: &Vec3) -> bool {
        self.winding(*p).abs() > 0.5
    }
}

/// Area of a triangle [m²].
pub fn area([a, b, c]: [Vec3; 3]) -> f64 {
    0.5 * (b - a).cross(&(c - a)).norm()
}

/// A closed box from `lo` to `hi` [m] of twelve faces that look outwards.
pub fn cuboid(lo: Vec3, hi: Vec3) -> TriMesh {
    let corner = |i: usize| {
        let side = |a: usize| if i >> a & 1 == 0 { lo[a] } else { hi[a] };
        Vec3::new(side(0), side(1), side(2))
    };
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriMesh { vertices: (0..8).map(corner).collect(), faces }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn box_has_its_area_and_volume_anywhere() {
        let at = Vec3::new(1e3, -2e3, 5.0);
        let mesh = cuboid(at, at + Vec3::new(1.0, 2.0, 3.0));
        assert!((mesh.area() - 22.0).abs() < 1e-9 && (mesh.volume() - 6.0).abs() < 1e-9);
        assert_eq!(mesh.open_edges(), 0);
        let open = TriMesh { faces: mesh.faces[1..].to_vec(), ..mesh };
        assert_eq!(open.open_edges(), 3);
    }

    #[test]
    fn welding_a_soup_closes_it() {
        let mesh = cuboid(Vec3::zeros(), Vec3::repeat(1.0));
        let vertices: Vec<Vec3> = mesh.triangles().flatten().collect();
        let faces = (0..12).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
        let soup = TriMesh::new(vertices, faces).unwrap();
        assert_eq!(soup.open_edges(), 36);
        let welded = soup.welded();
        assert_eq!((welded.open_edges(), welded.vertices.len()), (0, 8));
    }

    #[test]
    fn winding_and_nearest_point() {
        let mesh = cuboid(Vec3::zeros(), Vec3::repeat(1.0));
        assert!(mesh.contains(&Vec3::new(0.5, 0.2, 0.9)) && !mesh.contains(&Vec3::new(0.5, 1.2, 0.9)));
        let (point, _) = mesh.closest(Vec3::new(0.5, 0.5, 3.0)).unwrap();
        assert!((point - Vec3::new(0.5, 0.5, 1.0)).norm() < 1e-15);
    }

    #[test]
    fn wrong_vertices_are_refused() {
        assert!(TriMesh::new(vec![Vec3::zeros()], vec![[0, 0, 1]]).is_err());
        assert!(TriMesh::new(vec![Vec3::repeat(f64::NAN)], vec![]).is_err());
    }
}
