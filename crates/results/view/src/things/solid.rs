//! Clumps that are polyhedra: a sphere sits on each vertex of a mesh, faces and edges are between them.
//!
//! A run records the spheres of a clump and its volume, not its mesh. Where the hull of the centres has that volume, the mesh is the hull.
//! What is drawn is what touches others: the mesh with round edges, all places within the radius of the spheres of it.

use crate::things::spheres::Spheres;
use geom::{Vec3, hull::hull_faces, mesh::TriMesh};
use record::ClumpRecord;

/// Volume of the hull over that of the clump [–]: a mesh that was thinned has a little less, one with dents a smaller volume than its hull.
const CONVEX: std::ops::Range<f64> = 0.85..1.03;

/// By how much of their radius spheres may be off the places of the record [–]: frames may be in single precision.
const MISFIT: f64 = 0.02;

/// A convex polyhedron.
pub(crate) struct Solid {
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
        let scale = spheres.radius(rows[0] as usize) / self.spheres[0].1;
        let near = |a: f64, b: f64| (a - b).abs() <= MISFIT * spheres.radius(rows[0] as usize);
        let far = |k: usize, n: usize| scale * (self.spheres[k].0 - self.spheres[n].0).norm();
        let last = rows.len() - 1;
        (0..rows.len()).all(|k| {
            near(spheres.radius(rows[k] as usize), scale * self.spheres[k].1)
                && [0, last / 2, last].iter().all(|&n| near((at(k) - at(n)).norm(), far(k, n)))
        })
    }

    /// Its faces, outside by the radius of its spheres: the corners [m] and the normal [–] of each.
    pub fn panes(&self) -> Vec<([Vec3; 3], Vec3)> {
        let radius = self.spheres[0].1;
        let pane = |face: &[u32; 3]| {
            let normal = self.normal(face);
            (face.map(|k| self.spheres[k as usize].0 + normal * radius), normal)
        };
        self.faces.iter().map(pane).collect()
    }

    /// Triangles of its edges, rounded in two steps: place [m] and normal [–] of each corner.
    pub fn bevels(&self) -> Vec<[(Vec3, Vec3); 3]> {
        let radius = self.spheres[0].1;
        let owner = |a: u32, b: u32| {
            let sides = |f: &&[u32; 3]| [[f[0], f[1]], [f[1], f[2]], [f[2], f[0]]].contains(&[a, b]);
            self.faces.iter().find(sides).map(|face| self.normal(face))
        };
        let mut bevels = Vec::new();
        for &[a, b] in &self.edges {
            let (Some(first), Some(last)) = (owner(a, b), owner(b, a)) else { continue };
            let middle = (first + last).try_normalize(0.0).unwrap_or(first);
            for [n, m] in [[first, middle], [middle, last]] {
                let at = |k: u32, n: Vec3| (self.spheres[k as usize].0 + n * radius, n);
                bevels.push([at(a, n), at(b, n), at(b, m)]);
                bevels.push([at(a, n), at(b, m), at(a, m)]);
            }
        }
        bevels
    }

    /// Four of its spheres that span a volume, and where they are [m].
    pub fn frame(&self) -> [(u32, Vec3); 4] {
        let farthest = |of: &dyn Fn(&Vec3) -> f64| {
            let all = (0u32..).zip(&self.spheres).map(|(k, s)| (of(&s.0), k, s.0));
            let best = all.reduce(|best, one| if one.0 > best.0 { one } else { best });
            best.map_or((0, Vec3::zeros()), |(_, k, place)| (k, place))
        };
        let a = (0, self.spheres[0].0);
        let b = farthest(&|p| (p - a.1).norm_squared());
        let c = farthest(&|p| (b.1 - a.1).cross(&(p - a.1)).norm_squared());
        let d = farthest(&|p| (b.1 - a.1).cross(&(c.1 - a.1)).dot(&(p - a.1)).abs());
        [a, b, c, d]
    }

    /// How many spheres it has.
    pub fn len(&self) -> usize {
        self.spheres.len()
    }

    /// Corners of its faces, and ends of its edges, by their sphere.
    pub fn parts(&self) -> (&[[u32; 3]], &[[u32; 2]]) {
        (&self.faces, &self.edges)
    }

    fn normal(&self, face: &[u32; 3]) -> Vec3 {
        let [a, b, c] = face.map(|k| self.spheres[k as usize].0);
        (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default()
    }
}
