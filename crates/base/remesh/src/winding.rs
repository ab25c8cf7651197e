//! How often a surface winds around many places: the generalized winding number.
//!
//! ```text
//! w(p) = Σ solid angle of the faces / 4π           1 inside, 0 outside, between them near holes
//! far from faces of area vector A about c:  solid angle = (c − p)·A/|c − p|³
//! ```
//!
//! Jacobson, Kavan & Sorkine-Hornung (2013), doi:10.1145/2461912.2461916; the tree of far terms: Barill, Dickson, Schmidt, Levin & Jacobson
//! (2018), doi:10.1145/3197517.3201337, first order.

use geom::Vec3;
use geom::mesh::TriMesh;
use geom::triangle::solid_angle;
use std::f64::consts::PI;

/// Faces of a leaf.
const LEAF: usize = 8;
/// Beyond this multiple of its radius a node is seen as one face.
const FAR: f64 = 4.0;

/// A node: its faces, and what they are from afar.
struct Node {
    faces: [usize; 2],
    /// Children, or 0 for a leaf.
    children: [usize; 2],
    centre: Vec3,
    area: Vec3,
    radius: f64,
}

/// A surface ready for many places.
pub struct Winding {
    nodes: Vec<Node>,
    triangles: Vec<[Vec3; 3]>,
}

impl Winding {
    /// Sorts the faces of a mesh, which may be open, into a tree.
    pub fn new(mesh: &TriMesh) -> Winding {
        let mut triangles: Vec<[Vec3; 3]> = mesh.triangles().collect();
        let mut nodes = Vec::new();
        let mut open = vec![(0, triangles.len(), None)];
        while let Some((first, last, parent)) = open.pop() {
            let number = nodes.len();
            if let Some((parent, side)) = parent {
                let parent: &mut Node = &mut nodes[parent];
                parent.children[side] = number;
            }
            nodes.push(node(&triangles[first..last], [first, last]));
            if last - first > LEAF {
                let middle = |t: &[Vec3; 3]| t[0] + t[1] + t[2];
                let (lo, hi) =
                    geom::grid::bounds(&triangles[first..last].iter().map(middle).collect::<Vec<_>>());
                let longest = (hi - lo).imax();
                triangles[first..last].sort_by(|a, b| middle(a)[longest].total_cmp(&middle(b)[longest]));
                let half = usize::midpoint(first, last);
                open.push((half, last, Some((number, 1))));
                open.push((first, half, Some((number, 0))));
            }
        }
        Winding { nodes, triangles }
    }

    /// The winding number at a place [–].
    pub fn at(&self, p: &Vec3) -> f64 {
        let (mut sum, mut open) = (0.0, vec![0]);
        while let Some(number) = open.pop() {
            let node = &self.nodes[number];
            let to = node.centre - p;
            let distance = to.norm();
            if distance > FAR * node.radius {
                sum += to.dot(&node.area) / distance.powi(3);
            } else if node.children[0] == 0 {
                sum += self.triangles[node.faces[0]..node.faces[1]]
                    .iter()
                    .map(|t| solid_angle(t, p))
                    .sum::<f64>();
            } else {
                open.extend(node.children);
            }
        }
        sum / (4.0 * PI)
    }
}

fn node(triangles: &[[Vec3; 3]], faces: [usize; 2]) -> Node {
    let (mut area, mut weight, mut centre) = (Vec3::zeros(), 0.0, Vec3::zeros());
    for [a, b, c] in triangles {
        let own = (b - a).cross(&(c - a)) / 2.0;
        area += own;
        weight += own.norm();
        centre += (a + b + c) / 3.0 * own.norm();
    }
    let centre =
        if weight > 0.0 { centre / weight } else { triangles.first().map_or(Vec3::zeros(), |t| t[0]) };
    let radius = triangles.iter().flatten().map(|p| (p - centre).norm()).fold(0.0, f64::max);
    Node { faces, children: [0; 2], centre, area, radius }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::mesh::cuboid;

    #[test]
    fn the_tree_agrees_with_the_sum_over_all_faces() {
        let mut mesh = TriMesh::default();
        for k in 0..60 {
            let at = Vec3::new(f64::from(k % 5), f64::from(k / 5 % 4), f64::from(k / 20)) * 0.37;
            let block = cuboid(at, at + Vec3::new(0.2, 0.31, 0.25));
            mesh.faces.extend(block.faces.iter().map(|f| f.map(|v| v + 8 * k as u32)));
            mesh.vertices.extend(block.vertices);
        }
        // Half of one block is missing.
        mesh.faces.truncate(mesh.faces.len() - 6);
        let winding = Winding::new(&mesh);
        for k in 0..500 {
            let at = [0.754_877_6, 0.569_840_2, 0.430_159_7].map(|g: f64| (0.5 + g * f64::from(k)).fract());
            let p = Vec3::new(2.4 * at[0] - 0.2, 1.8 * at[1] - 0.2, 1.2 * at[2] - 0.2);
            let (found, wanted) = (winding.at(&p), mesh.winding(p));
            assert!((found - wanted).abs() < 0.02, "{p}: {found}, not {wanted}");
        }
    }
}
