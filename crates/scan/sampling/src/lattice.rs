//! The point nearest to each node of a cubic grid: equal intervals along x, y and z, for flows with one direction.
//!
//! Nodes are whole multiples of the spacing, so that clouds sampled apart fit together. A point belongs
//! to the node it is nearest to; of the points of a node the nearest one is kept (the first in the file among equals).

use geom::Vec3;
use rayon::prelude::*;

/// Indices of the kept points, ascending; `forced` ones are all kept. `spacing` [m] is the distance between nodes.
pub(crate) fn lattice(points: &[Vec3], forced: Option<&[bool]>, spacing: f64) -> Vec<u32> {
    let is_forced = |i: u32| forced.is_some_and(|f| f[i as usize]);
    let mut near: Vec<([i64; 3], u64, u32)> = (0..points.len() as u32)
        .into_par_iter()
        .filter(|&i| !is_forced(i))
        .map(|i| {
            let scaled = points[i as usize] / spacing;
            let node = scaled.map(f64::round);
            let off = (scaled - node).norm_squared().to_bits();
            ([node.x as i64, node.y as i64, node.z as i64], off, i)
        })
        .collect();
    near.par_sort_unstable();
    near.dedup_by_key(|(node, _, _)| *node);
    let mut kept: Vec<u32> = near.into_iter().map(|(_, _, i)| i).collect();
    kept.extend((0..points.len() as u32).filter(|&i| is_forced(i)));
    kept.sort_unstable();
    kept
}
