//! Whether many positions are inside a closed mesh: by the parity of the faces that a ray crosses.

use crate::Vec3;
use crate::mesh::{MeshError, TriMesh};
use crate::tree::Tree;
use std::sync::OnceLock;

/// Faces of a closed mesh sorted into columns along x.
///
/// The ray goes along +x. Whether it meets a face is decided in the yz plane by the half-open crossing rule
/// with the ends of each edge in one order, so a ray through an edge or a vertex meets exactly one of the
/// faces that share it on each side, and parity never slips.
#[derive(Debug, Clone)]
pub struct Inside {
    mesh: TriMesh,
    lo: Vec3,
    hi: Vec3,
    columns: [usize; 2],
    starts: Vec<u32>,
    faces: Vec<u32>,
    /// Made when a distance is first needed.
    tree: OnceLock<Tree>,
}

impl Inside {
    /// Sorts the faces of a closed mesh; vertices at equal places count as one.
    ///
    /// # Errors
    /// An empty or an open mesh.
    pub fn new(mesh: &TriMesh) -> Result<Inside, MeshError> {
        let mesh = mesh.welded();
        if mesh.faces.is_empty() {
            return Err(MeshError::Empty);
        }
        let open = mesh.open_edges();
        if open > 0 {
            return Err(MeshError::Open { open });
        }
        let (lo, hi) = crate::grid::bounds(&mesh.vertices);
        let side = ((mesh.faces.len() as f64).sqrt().ceil() as usize).clamp(1, 1024);
        let columns = [side, side];
        let mut inside = Inside {
            mesh,
            lo,
            hi,
            columns,
            starts: vec![0; side * side + 1],
            faces: Vec::new(),
            tree: OnceLock::new(),
        };
        inside.sort();
        Ok(inside)
    }

    fn sort(&mut self) {
        let mut entries: Vec<(u32, u32)> = Vec::new();
        for (face, tri) in (0u32..).zip(self.mesh.triangles()) {
            let (lo, hi) = crate::grid::bounds(&tri);
            let ([y0, z0], [y1, z1]) = (self.column(&lo), self.column(&hi));
            for z in z0..=z1 {
                entries.extend((y0..=y1).map(|y| ((z * self.columns[0] + y) as u32, face)));
            }
        }
        entries.sort_unstable();
        for &(column, _) in &entries {
            self.starts[column as usize + 1] += 1;
        }
        for c in 1..self.starts.len() {
            self.starts[c] += self.starts[c - 1];
        }
        self.faces = entries.into_iter().map(|(_, face)| face).collect();
    }

    /// The column along x that holds `p`.
    fn column(&self, p: &Vec3) -> [usize; 2] {
        [1, 2].map(|a| {
            let extent = (self.hi[a] - self.lo[a]).max(f64::MIN_POSITIVE);
            let share = (p[a] - self.lo[a]) / extent * self.columns[a - 1] as f64;
            (share as usize).min(self.columns[a - 1] - 1)
        })
    }

    /// Distance from `p` [m] to the surface [m].
    pub(crate) fn distance(&self, p: &Vec3) -> f64 {
        self.tree.get_or_init(|| Tree::new(&self.mesh)).distance(&self.mesh, p)
    }

    /// Whether `p` [m] is inside.
    pub fn contains(&self, p: &Vec3) -> bool {
        if !(0..3).all(|a| p[a] >= self.lo[a] && p[a] <= self.hi[a]) {
            return false;
        }
        let [y, z] = self.column(p);
        let column = z * self.columns[0] + y;
        let run = self.starts[column] as usize..self.starts[column + 1] as usize;
        let met = self.faces[run].iter().filter(|&&f| meets(self.mesh.triangle(f as usize), p)).count();
        met % 2 == 1
    }
}

/// Whether the ray from `p` along +x meets the triangle.
fn meets(tri: [Vec3; 3], p: &Vec3) -> bool {
    let mut crossings = 0;
    for (u, v) in [(tri[0], tri[1]), (tri[1], tri[2]), (tri[2], tri[0])] {
        let (u, v) = if (u.z, u.y, u.x) <= (v.z, v.y, v.x) { (u, v) } else { (v, u) };
        if (u.z > p.z) != (v.z > p.z) && p.y < u.y + (v.y - u.y) * ((p.z - u.z) / (v.z - u.z)) {
            crossings += 1;
        }
    }
    if crossings != 1 {
        return false;
    }
    let normal = (tri[1] - tri[0]).cross(&(tri[2] - tri[0]));
    // A face seen edge-on has no area in the yz plane and is never crossed once.
    (tri[0] - p).dot(&normal) * normal.x > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cuboid;

    #[test]
    fn rays_through_edges_and_vertices_do_not_slip() {
        let inside = Inside::new(&cuboid(Vec3::zeros(), Vec3::repeat(1.0))).unwrap();
        for i in -4..=12 {
            for j in -4..=12 {
                for k in -4..=12 {
                    let p = Vec3::new(i as f64, j as f64, k as f64) / 8.0 + Vec3::new(1e-3, 0.0, 0.0);
                    let strictly = (0..3).all(|a| p[a] > 0.0 && p[a] < 1.0);
                    let out = (0..3).any(|a| p[a] < 0.0 || p[a] > 1.0);
                    let found = inside.contains(&p);
                    assert!(if found { !out } else { !strictly }, "{p}");
                }
            }
        }
    }

    #[test]
    fn agrees_with_the_winding_number() {
        // A tetrahedron in a general position.
        let vertices = vec![
            Vec3::new(0.1, 0.2, 0.0),
            Vec3::new(1.0, 0.1, 0.2),
            Vec3::new(0.3, 1.1, 0.1),
            Vec3::new(0.4, 0.5, 0.9),
        ];
        let mesh = TriMesh::new(vertices, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap();
        let inside = Inside::new(&mesh).unwrap();
        for i in 0..9 * 9 * 9 {
            let p = Vec3::new((i % 9) as f64, (i / 9 % 9) as f64, (i / 81) as f64) / 8.0;
            assert_eq!(inside.contains(&p), mesh.contains(&p), "{p}");
        }
    }

    #[test]
    fn open_meshes_are_refused() {
        let mut mesh = cuboid(Vec3::zeros(), Vec3::repeat(1.0));
        mesh.faces.pop();
        assert_eq!(Inside::new(&mesh).unwrap_err(), MeshError::Open { open: 3 });
    }
}
