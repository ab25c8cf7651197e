//! A tree of boxes over the faces of a mesh: finds the nearest one.

use crate::Vec3;
use crate::mesh::TriMesh;
use crate::triangle::closest_point;

/// Faces of a leaf.
const LEAF: usize = 4;

/// Boxes in the order of a walk: each is followed by its first half, and knows where its second one starts.
#[derive(Debug, Clone, Default)]
pub(crate) struct Tree {
    boxes: Vec<Node>,
    faces: Vec<u32>,
}

#[derive(Debug, Clone)]
struct Node {
    lo: Vec3,
    hi: Vec3,
    /// First and last face (exclusive) of the box, in the order of the tree.
    faces: [u32; 2],
    /// The second half; 0 for a leaf.
    second: u32,
}

impl Tree {
    /// Halves the faces at the middle one along the longest side, again and again.
    pub(crate) fn new(mesh: &TriMesh) -> Tree {
        let mut tree = Tree { boxes: Vec::new(), faces: (0..mesh.faces.len() as u32).collect() };
        let mut open = vec![(0, mesh.faces.len(), usize::MAX)];
        while let Some((first, last, parent)) = open.pop() {
            let node = tree.boxes.len();
            if let Some(parent) = tree.boxes.get_mut(parent) {
                parent.second = node as u32;
            }
            let run = &mut tree.faces[first..last];
            let corners: Vec<Vec3> = run.iter().flat_map(|&f| mesh.triangle(f as usize)).collect();
            let (lo, hi) = crate::grid::bounds(&corners);
            if last - first > LEAF {
                let longest = (hi - lo).imax();
                let middle = |f: &u32| mesh.triangle(*f as usize).iter().map(|p| p[longest]).sum::<f64>();
                run.sort_by(|a, b| middle(a).total_cmp(&middle(b)).then(a.cmp(b)));
                let half = usize::midpoint(first, last);
                open.push((half, last, node));
                open.push((first, half, usize::MAX));
            }
            tree.boxes.push(Node { lo, hi, faces: [first as u32, last as u32], second: 0 });
        }
        tree
    }

    /// Distance [m] from `p` to the nearest face of the mesh that the tree was made of.
    pub(crate) fn distance(&self, mesh: &TriMesh, p: &Vec3) -> f64 {
        let to_box = |node: &Node| (p - p.sup(&node.lo).inf(&node.hi)).norm_squared();
        let mut best = f64::INFINITY;
        let mut open = vec![0usize];
        while let Some(at) = open.pop() {
            let Some(node) = self.boxes.get(at).filter(|node| to_box(node) < best) else { continue };
            if node.second == 0 {
                for &face in &self.faces[node.faces[0] as usize..node.faces[1] as usize] {
                    best = best.min((closest_point(mesh.triangle(face as usize), *p) - p).norm_squared());
                }
                continue;
            }
            let halves = [at + 1, node.second as usize];
            let nearer = usize::from(to_box(&self.boxes[halves[1]]) < to_box(&self.boxes[halves[0]]));
            open.extend([halves[1 - nearer], halves[nearer]]);
        }
        best.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cuboid;

    #[test]
    fn the_nearest_face_is_that_of_a_look_at_every_face() {
        let mut mesh = cuboid(Vec3::zeros(), Vec3::repeat(1.0));
        for k in 0..60 {
            let at = Vec3::new(f64::from(k % 7), f64::from(k % 11), f64::from(k % 13)) * 1.7;
            let next = cuboid(at, at + Vec3::new(0.3, 0.5, 0.2));
            let shift = mesh.vertices.len() as u32;
            mesh.vertices.extend(next.vertices);
            mesh.faces.extend(next.faces.iter().map(|f| f.map(|v| v + shift)));
        }
        let tree = Tree::new(&mesh);
        for k in 0..100 {
            let p = Vec3::new(f64::from(k * 31 % 17), f64::from(k * 7 % 19), f64::from(k * 3 % 23)) * 1.1;
            let (best, _) = mesh.closest(p).unwrap();
            assert!((tree.distance(&mesh, &p) - (best - p).norm()).abs() < 1e-12);
        }
    }
}
