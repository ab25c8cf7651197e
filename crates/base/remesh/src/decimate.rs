//! Fewer faces: edges collapse where that changes the surface least.
//!
//! ```text
//! Q(x) = Σ over the planes of the faces around  area (n·x + d)²        of both ends of an edge
//! x    = argmin Q(x)  with the volume as it is:  g·x = h
//! g    = Σ (b − a) × (c − a),  h = Σ a·(b × c)      over the faces around
//! ```
//!
//! Garland & Heckbert (1997), doi:10.1145/258734.258849. Volume: Lindstrom & Turk (1998), doi:10.1109/VISUAL.1998.745314. An edge collapses only if
//! its ends have two common neighbours (the surface stays a manifold: Dey et al. 1999), and no face turns over.

mod quadric;

use geom::Vec3;
use geom::mesh::TriMesh;
use quadric::Quadric;
use std::cmp::Ordering;
use std::collections::{BTreeSet, BinaryHeap};

/// Least cosine between a face before and after, and least height of a face over its longest edge: at first, and then where no edge is left.
const STRICT: [[f64; 2]; 3] = [[0.9, 0.2], [0.7, 0.1], [0.3, 0.02]];

/// An edge that may collapse.
struct Collapse {
    cost: f64,
    ends: [u32; 2],
    /// Changes of both ends when this was computed.
    versions: [u32; 2],
    place: Vec3,
}

impl Ord for Collapse {
    fn cmp(&self, other: &Self) -> Ordering {
        // The least cost is the greatest of the heap; equal ones by their ends.
        other.cost.total_cmp(&self.cost).then_with(|| other.ends.cmp(&self.ends))
    }
}
impl PartialOrd for Collapse {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl PartialEq for Collapse {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Collapse {}

/// A mesh whose edges collapse.
struct Collapsing {
    vertices: Vec<Vec3>,
    faces: Vec<Option<[u32; 3]>>,
    around: Vec<Vec<u32>>,
    quadrics: Vec<Quadric>,
    versions: Vec<u32>,
    left: usize,
}

/// A closed manifold mesh with `faces` faces, or as few as keep it one. The volume stays.
pub fn decimate(mesh: &TriMesh, faces: usize) -> TriMesh {
    let mut work = Collapsing::new(mesh);
    for strict in STRICT {
        // An edge that could not collapse may do so when its neighbours have changed.
        let mut before = usize::MAX;
        while work.left > faces.max(4) && work.left < before {
            before = work.left;
            work.run(faces.max(4), strict);
        }
    }
    work.mesh()
}

impl Collapsing {
    fn new(mesh: &TriMesh) -> Collapsing {
        let count = mesh.vertices.len();
        let (mut around, mut quadrics) = (vec![Vec::new(); count], vec![Quadric::default(); count]);
        for (face, corners) in (0u32..).zip(&mesh.faces) {
            let plane = Quadric::of_face(mesh.triangle(face as usize));
            for v in corners {
                around[*v as usize].push(face);
                quadrics[*v as usize] += plane;
            }
        }
        let faces = mesh.faces.iter().map(|f| Some(*f)).collect();
        let vertices = mesh.vertices.clone();
        Collapsing { vertices, faces, around, quadrics, versions: vec![0; count], left: mesh.faces.len() }
    }

    /// Collapses edges, the cheapest first, down to `faces` faces.
    fn run(&mut self, faces: usize, strict: [f64; 2]) {
        let mut heap: BinaryHeap<Collapse> = BinaryHeap::new();
        for &[a, b, c] in self.faces.iter().flatten() {
            let edges = [(a, b), (b, c), (c, a)];
            heap.extend(edges.into_iter().filter(|(a, b)| a < b).map(|(a, b)| self.collapse(a, b)));
        }
        while self.left > faces {
            let Some(next) = heap.pop() else { break };
            let [a, b] = next.ends;
            if next.versions != [a, b].map(|v| self.versions[v as usize]) {
                continue;
            }
            // Faces around may have changed since.
            let fresh = self.collapse(a, b);
            if fresh.cost > next.cost && heap.peek().is_some_and(|other| other.cost < fresh.cost) {
                heap.push(fresh);
            } else if self.may(&fresh, strict) {
                self.apply(&fresh);
                heap.extend(self.neighbours(a).into_iter().map(|v| self.collapse(a.min(v), a.max(v))));
            }
        }
    }

    fn corners(&self, face: u32) -> [u32; 3] {
        self.faces[face as usize].unwrap_or_default()
    }

    fn triangle(&self, face: u32) -> [Vec3; 3] {
        self.corners(face).map(|v| self.vertices[v as usize])
    }

    fn neighbours(&self, v: u32) -> BTreeSet<u32> {
        self.around[v as usize].iter().flat_map(|f| self.corners(*f)).filter(|w| *w != v).collect()
    }

    /// Faces around both ends, each once.
    fn faces_around(&self, a: u32, b: u32) -> Vec<u32> {
        let own = &self.around[a as usize];
        let others = self.around[b as usize].iter().filter(|f| !own.contains(f));
        own.iter().chain(others).copied().collect()
    }

    fn collapse(&self, a: u32, b: u32) -> Collapse {
        let (p, q) = (self.vertices[a as usize], self.vertices[b as usize]);
        let middle = (p + q) / 2.0;
        let sum = self.quadrics[a as usize] + self.quadrics[b as usize];
        let (mut g, mut h) = (Vec3::zeros(), 0.0);
        for face in self.faces_around(a, b) {
            let [u, v, w] = self.triangle(face).map(|c| c - middle);
            g += (v - u).cross(&(w - u));
            h += u.dot(&v.cross(&w));
        }
        let length = (q - p).norm();
        let place = sum.least(&middle, &g, h).filter(|x| (x - middle).norm() < 2.0 * length);
        let place = place.unwrap_or(middle);
        // Edges on a plane cost nothing: the short ones first.
        let cost = sum.at(&place) + 1e-9 * length * length * sum.weight();
        Collapse { cost, ends: [a, b], versions: [a, b].map(|v| self.versions[v as usize]), place }
    }

    /// Whether the surface stays a manifold and no face turns over or becomes a needle.
    fn may(&self, collapse: &Collapse, [turn, thin]: [f64; 2]) -> bool {
        let [a, b] = collapse.ends;
        let (of_a, of_b) = (self.neighbours(a), self.neighbours(b));
        if of_a.intersection(&of_b).count() != 2 || (of_a.len() == 3 && of_b.len() == 3) {
            return false;
        }
        self.faces_around(a, b).into_iter().all(|face| {
            let corners = self.corners(face);
            if corners.contains(&a) && corners.contains(&b) {
                return true;
            }
            let old = self.triangle(face);
            let new =
                [0, 1, 2].map(|k| if corners[k] == a || corners[k] == b { collapse.place } else { old[k] });
            let ((before, wide_before), (after, wide)) = (shape(old), shape(new));
            // What was a needle has no side to turn over from, and may become a wider one.
            wide > thin.min(wide_before) && (wide_before < 0.02 || before.dot(&after) > turn)
        })
    }

    fn apply(&mut self, collapse: &Collapse) {
        let [a, b] = collapse.ends;
        self.vertices[a as usize] = collapse.place;
        let other = self.quadrics[b as usize];
        self.quadrics[a as usize] += other;
        for face in std::mem::take(&mut self.around[b as usize]) {
            let corners = self.corners(face);
            if corners.contains(&a) {
                self.faces[face as usize] = None;
                self.left -= 1;
                for v in corners {
                    self.around[v as usize].retain(|f| *f != face);
                }
            } else {
                self.faces[face as usize] = Some(corners.map(|v| if v == b { a } else { v }));
                self.around[a as usize].push(face);
            }
        }
        // Everything around is measured again.
        self.versions[a as usize] += 1;
        self.versions[b as usize] += 1;
    }

    fn mesh(self) -> TriMesh {
        let mut renamed = vec![u32::MAX; self.vertices.len()];
        let (mut vertices, mut faces) = (Vec::new(), Vec::with_capacity(self.left));
        for corners in self.faces.into_iter().flatten() {
            faces.push(corners.map(|v| {
                let name = &mut renamed[v as usize];
                if *name == u32::MAX {
                    *name = vertices.len() as u32;
                    vertices.push(self.vertices[v as usize]);
                }
                *name
            }));
        }
        TriMesh { vertices, faces }
    }
}

/// Unit normal of a face, and its height over its longest edge.
fn shape(t: [Vec3; 3]) -> (Vec3, f64) {
    let across = (t[1] - t[0]).cross(&(t[2] - t[0]));
    let longest = (0..3).map(|k| (t[(k + 1) % 3] - t[k]).norm_squared()).fold(0.0, f64::max);
    let size = across.norm();
    if size > 0.0 { (across / size, size / longest) } else { (Vec3::zeros(), 0.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Samples, surface};
    use geom::Moments;

    fn body(cells: usize, distance: impl Fn(&Vec3) -> f64) -> TriMesh {
        let mut samples = Samples::over(&Vec3::repeat(-1.0), &Vec3::repeat(1.0), cells, 2, 0.0);
        for index in 0..samples.values.len() {
            samples.values[index] = distance(&samples.place(samples.node(index))) as f32;
        }
        surface(samples).unwrap()
    }

    #[test]
    fn a_ball_keeps_its_volume_and_stays_closed() {
        let ball = body(40, |p| 0.9 - p.norm());
        let volume = ball.volume();
        for faces in [2000, 300, 60] {
            let few = decimate(&ball, faces);
            assert!(few.faces.len() <= faces && few.faces.len() + 2 > faces, "{}", few.faces.len());
            let moments = Moments::of_mesh(&few).unwrap();
            assert!((moments.volume / volume - 1.0).abs() < 1e-6, "{faces}: {}", moments.volume / volume);
        }
    }

    /// The flat sides of a box become few faces, and its edges stay.
    #[test]
    fn a_box_keeps_its_edges() {
        let block = body(40, |p| (Vec3::new(0.8, 0.6, 0.5) - p.abs()).min());
        let few = decimate(&block, 100);
        let (lo, hi) = geom::grid::bounds(&few.vertices);
        assert!((hi - lo - Vec3::new(1.6, 1.2, 1.0)).amax() < 0.06, "{lo} {hi}");
        assert_eq!(few.open_edges(), 0);
    }
}
