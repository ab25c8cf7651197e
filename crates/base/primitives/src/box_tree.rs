//! The search of a tree of boxes: which of many bodies may be near a position.

use crate::Vec3;

/// A tree of boxes, as it lies in memory: whole, so that children are found by their number, and each leaf has a run of bodies.
#[derive(Debug, Clone, Copy)]
pub struct BoxTree<'a> {
    /// Lowest and highest corner of what is below each node [m]; children of node k are 2k + 1 and 2k + 2.
    pub nodes: &'a [[Vec3; 2]],
    /// Numbers of the bodies, leaf by leaf: each half of a node has half of them.
    pub order: &'a [u32],
    /// Their boxes in that order.
    pub boxes: &'a [[Vec3; 2]],
}

impl BoxTree<'_> {
    /// Calls `found` with the number of each body whose box is within `reach` [m] of `p`, in the order of the tree.
    #[inline(always)]
    pub fn near(&self, p: &Vec3, reach: f64, mut found: impl FnMut(u32)) {
        if self.order.is_empty() {
            return;
        }
        let (leaves, mut node) = (self.nodes.len().div_ceil(2), 0);
        loop {
            if self.nodes.get(node).is_some_and(|n| close(n, p, reach)) {
                if node + 1 < leaves {
                    node = 2 * node + 1;
                    continue;
                }
                let (from, to) = self.of_leaf(node);
                for k in from..to {
                    if close(&self.boxes[k], p, reach) {
                        found(self.order[k]);
                    }
                }
            }
            // On to the second half of the first node above that was left for its first half.
            while node.is_multiple_of(2) {
                if node == 0 {
                    return;
                }
                node = (node - 1) / 2;
            }
            node += 1;
        }
    }

    /// Where the bodies of a leaf begin and end: its number plus one is, in binary, the way down to it.
    #[inline(always)]
    fn of_leaf(&self, node: usize) -> (usize, usize) {
        let (way, mut from, mut to) = (node + 1, 0, self.order.len());
        for bit in (0..way.ilog2()).rev() {
            let middle = from + (to - from) / 2;
            *if way >> bit & 1 == 1 { &mut from } else { &mut to } = middle;
        }
        (from, to)
    }
}

/// Whether a box comes within `reach` of `p`.
#[inline(always)]
fn close([lo, hi]: &[Vec3; 2], p: &Vec3, reach: f64) -> bool {
    let outside = |lo: f64, hi: f64, p: f64| (lo - p).max(p - hi).max(0.0);
    let (x, y, z) = (outside(lo.x, hi.x, p.x), outside(lo.y, hi.y, p.y), outside(lo.z, hi.z, p.z));
    x * x + y * y + z * z <= reach * reach
}
