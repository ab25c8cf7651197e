//! Samples whose surface is a manifold.
//!
//! The surface between nodes inside and outside has the faces of cubes around the nodes as its pattern. It is a manifold when nowhere two nodes of one
//! kind touch only across an edge or a corner (a well-composed set: Latecki, Eckhardt & Rosenfeld 1995, doi:10.1006/cviu.1995.1006).
//! Where they do, the node nearest to the surface becomes inside, until none is left: only outside nodes change, so it ends.

use crate::samples::Samples;

/// Makes the samples well-composed; how many nodes changed. Nodes of the border must be outside, and stay so.
pub(crate) fn compose(samples: &mut Samples) -> usize {
    let mut changed = 0;
    let mut open: Vec<usize> = (0..samples.values.len()).collect();
    while !open.is_empty() {
        let mut next = Vec::new();
        for index in open {
            while let Some(node) = critical(samples, index) {
                // A tiny depth: the surface stays where it was.
                samples.values[node] = (1e-3 * samples.step) as f32;
                changed += 1;
                next.extend(around(samples, node));
            }
        }
        next.sort_unstable();
        next.dedup();
        open = next;
    }
    changed
}

/// Cells (by their first node) that have this node as a corner.
fn around(samples: &Samples, node: usize) -> impl Iterator<Item = usize> + use<> {
    let [i, j, k] = samples.node(node);
    let size = samples.size;
    (0..8).filter_map(move |c| {
        let at = [i.checked_sub(c & 1)?, j.checked_sub(c >> 1 & 1)?, k.checked_sub(c >> 2)?];
        Some((at[2] * size[1] + at[1]) * size[0] + at[0])
    })
}

/// The six sides and, as pairs of opposite corners, the four diagonals of a cell.
const SIDES: [[usize; 4]; 6] =
    [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];

/// The node of a cell to be made inside, if the cell has a critical pattern.
fn critical(samples: &Samples, cell: usize) -> Option<usize> {
    let node = samples.node(cell);
    if (0..3).any(|a| node[a] + 1 >= samples.size[a]) {
        return None;
    }
    let corners: [usize; 8] = std::array::from_fn(|c| {
        samples.index([node[0] + (c & 1), node[1] + (c >> 1 & 1), node[2] + (c >> 2)])
    });
    let inside = corners.map(|n| samples.values[n] > 0.0);
    let count = inside.iter().filter(|i| **i).count();
    if count == 0 || count == 8 {
        return None;
    }
    // The outside node of least depth that is not on the border.
    let best = |nodes: &mut dyn Iterator<Item = usize>| {
        nodes
            .filter(|c| !inside[*c] && !samples.on_border(samples.node(corners[*c])))
            .max_by(|a, b| samples.values[corners[*a]].total_cmp(&samples.values[corners[*b]]))
            .map(|c| corners[c])
    };
    for side in SIDES {
        let [a, b, c, d] = side.map(|c| inside[c]);
        if a == c && b == d && a != b {
            return best(&mut side.into_iter());
        }
    }
    // Two opposite corners alone, of either kind.
    let alone = |c: usize| {
        inside[c] == inside[7 - c] && (0..8).all(|o| o == c || o == 7 - c || inside[o] != inside[c])
    };
    if (count == 2 || count == 6) && (0..4).any(alone) {
        return best(&mut (0..8));
    }
    None
}
