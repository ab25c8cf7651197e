//! Whether many positions are inside a closed mesh: by the parity of the faces that a ray crosses.

use crate::Vec3;
use crate::mesh::{MeshError, TriMesh};
use crate::tree::Tree;
use std::sync::OnceLock;

/// Most columns per face on average; a face about as long as it is wide is in fewer than ten.
const ENTRIES: usize = 32;

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
    /// Built when a distance is first needed.
    tree: OnceLock<Tree>,
}

impl Inside {
    /// Volume of the mesh [m³].
    pub fn volume(&self) -> f64 {
        self.mesh.volume().abs()
    }

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
        let (starts, faces, tree) = (Vec::new(), Vec::new(), OnceLock::new());
        let mut inside = Inside { mesh, lo, hi, columns: [side, side], starts, faces, tree };
        // Long faces lie in many columns: with fewer columns they lie in fewer.
        while inside.columns[0] > 1 && inside.count_entries() > ENTRIES * inside.mesh.faces.len() {
            inside.columns = inside.columns.map(|side| side.div_ceil(2));
        }
        inside.sort();
        Ok(inside)
    }

    /// First and last column that a face can lie in, along y and z.
    fn columns_of(&self, tri: &[Vec3; 3]) -> ([usize; 2], [usize; 2]) {
        let (lo, hi) = (tri[0].inf(&tri[1]).inf(&tri[2]), tri[0].sup(&tri[1]).sup(&tri[2]));
        (self.column(&lo), self.column(&hi))
    }

    fn count_entries(&self) -> usize {
        let count = |tri: [Vec3; 3]| {
            let ([y0, z0], [y1, z1]) = self.columns_of(&tri);
            (y1 - y0 + 1) * (z1 - z0 + 1)
        };
        self.mesh.triangles().map(count).sum()
    }

    fn sort(&mut self) {
        let mut entries: Vec<(u32, u32)> = Vec::new();
        for (face, tri) in (0u32..).zip(self.mesh.triangles()) {
            let ([y0, z0], [y1, z1]) = self.columns_of(&tri);
            for z in z0..=z1 {
                entries.extend((y0..=y1).map(|y| ((z * self.columns[0] + y) as u32, face)));
            }
        }
        entries.sort_unstable();
        self.starts = vec![0; self.columns[0] * self.columns[1] + 1];
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

    /// The lowest and the highest corner [m].
    pub fn bounds(&self) -> (Vec3, Vec3) {
        (self.lo, self.hi)
    }

    /// Distance from `p` [m] to the surface [m].
    pub fn distance(&self, p: &Vec3) -> f64 {
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

    /// A star of long teeth: each face would be in hundreds of columns.
    #[test]
    fn long_faces_do_not_take_a_column_each() {
        const TEETH: u32 = 4000;
        let corner = |i: u32, z: f64| {
            let (radius, angle) =
                ([1.0, 0.3][i as usize % 2], std::f64::consts::TAU * f64::from(i) / f64::from(TEETH));
            Vec3::new(radius * angle.cos(), radius * angle.sin(), z)
        };
        let vertices = [0.0, 1.0].into_iter().flat_map(|z| (0..TEETH).map(move |i| corner(i, z))).collect();
        let mut faces = Vec::new();
        for i in 0..TEETH {
            let j = (i + 1) % TEETH;
            faces.extend([[i, j, TEETH + j], [i, TEETH + j, TEETH + i]]);
            if i > 0 && j > 0 {
                faces.extend([[0, j, i], [TEETH, TEETH + i, TEETH + j]]);
            }
        }
        let inside = Inside::new(&TriMesh::new(vertices, faces).unwrap()).unwrap();
        assert!(inside.faces.len() <= ENTRIES * inside.mesh.faces.len(), "{} entries", inside.faces.len());
        let has = |r: f64, i: f64| {
            let angle = std::f64::consts::TAU * i / f64::from(TEETH);
            inside.contains(&Vec3::new(r * angle.cos(), r * angle.sin(), 0.5))
        };
        assert!(has(0.2, 7.3) && has(0.9, 2000.0) && !has(0.9, 2001.0) && !has(1.1, 2000.0));
    }

    #[test]
    fn open_meshes_are_refused() {
        let mut mesh = cuboid(Vec3::zeros(), Vec3::repeat(1.0));
        mesh.faces.pop();
        assert_eq!(Inside::new(&mesh).unwrap_err(), MeshError::Open { open: 3 });
    }
}
