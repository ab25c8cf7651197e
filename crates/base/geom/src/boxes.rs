//! A tree of boxes: which of many bodies of any size may be near a position.
//!
//! Bodies are halved at the median of their centres along the longest side, down to a few of them; a node is the box of
//! all below it. The tree is a function of the boxes and their order alone.

use crate::Vec3;
use primitives::BoxTree;

/// Bodies of a leaf.
const LEAF: usize = 4;

/// Boxes of bodies, ready to be searched.
#[derive(Debug, Clone, Default)]
pub struct Boxes {
    /// Children of node k are 2k + 1 and 2k + 2.
    nodes: Vec<[Vec3; 2]>,
    /// Numbers of the bodies, and their boxes, leaf by leaf.
    order: Vec<u32>,
    boxes: Vec<[Vec3; 2]>,
}

impl Boxes {
    /// A tree of boxes (lowest, highest corner [m]).
    pub fn new(boxes: &[[Vec3; 2]]) -> Boxes {
        let leaves = boxes.len().div_ceil(LEAF).next_power_of_two();
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut nodes = vec![none(); 2 * leaves - 1];
        fill(&mut nodes, 0, boxes, &mut order, leaves);
        let sorted = order.iter().map(|&k| boxes[k as usize]).collect();
        Boxes { nodes, order, boxes: sorted }
    }

    /// Box of all of them; from ∞ to −∞ when there is none.
    pub fn bounds(&self) -> [Vec3; 2] {
        self.nodes.first().copied().unwrap_or(none())
    }

    /// The tree, to be searched.
    pub fn tree(&self) -> BoxTree<'_> {
        BoxTree { nodes: &self.nodes, order: &self.order, boxes: &self.boxes }
    }

    /// Calls `found` with the number of each body whose box is within `reach` [m] of `p`, in the order of the tree.
    pub fn near(&self, p: Vec3, reach: f64, found: impl FnMut(u32)) {
        self.tree().near(&p, reach, found);
    }
}

fn none() -> [Vec3; 2] {
    [Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)]
}

fn fill(nodes: &mut [[Vec3; 2]], node: usize, boxes: &[[Vec3; 2]], order: &mut [u32], leaves: usize) {
    let all = order.iter().map(|&k| boxes[k as usize]);
    nodes[node] = all.fold(none(), |[lo, hi], [a, b]| [lo.inf(&a), hi.sup(&b)]);
    if leaves == 1 {
        return;
    }
    let centre = |k: u32| boxes[k as usize][0] + boxes[k as usize][1];
    let points = order.iter().map(|&k| centre(k));
    let [lo, hi] = points.fold(none(), |[lo, hi], c| [lo.inf(&c), hi.sup(&c)]);
    let longest = (0..3).max_by(|&a, &b| (hi[a] - lo[a]).total_cmp(&(hi[b] - lo[b]))).unwrap_or(0);
    let middle = order.len() / 2;
    if middle < order.len() {
        order.select_nth_unstable_by(middle, |&a, &b| {
            centre(a)[longest].total_cmp(&centre(b)[longest]).then(a.cmp(&b))
        });
    }
    let (first, second) = order.split_at_mut(middle);
    fill(nodes, 2 * node + 1, boxes, first, leaves / 2);
    fill(nodes, 2 * node + 2, boxes, second, leaves / 2);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a box comes within `reach` of `p`.
    fn close([lo, hi]: &[Vec3; 2], p: &Vec3, reach: f64) -> bool {
        let outside = |a: usize| (lo[a] - p[a]).max(p[a] - hi[a]).max(0.0);
        let [x, y, z] = [outside(0), outside(1), outside(2)];
        x * x + y * y + z * z <= reach * reach
    }

    /// Boxes of sizes from 1 mm to 1 m, against trying every one.
    #[test]
    fn finds_what_brute_force_finds() {
        let mut state = 7u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut place = || Vec3::new(next(), next(), next());
        for count in [0, 1, 3, 4, 5, 17, 700] {
            let boxes: Vec<[Vec3; 2]> = (0..count)
                .map(|k| {
                    let (p, size) = (place(), if k % 50 == 0 { 1.0 } else { 0.001 });
                    [p, p + place() * size]
                })
                .collect();
            let tree = Boxes::new(&boxes);
            for _ in 0..50 {
                let p = place() * 1.4;
                let mut found = Vec::new();
                tree.near(p, 0.1, |k| found.push(k));
                found.sort_unstable();
                let all = (0..count as u32).filter(|&k| close(&boxes[k as usize], &p, 0.1));
                assert_eq!(found, all.collect::<Vec<u32>>());
            }
        }
    }
}
