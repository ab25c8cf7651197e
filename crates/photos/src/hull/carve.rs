//! Sampling from coarse to fine.

use super::View;
use geom::Vec3;
use rayon::prelude::*;
use remesh::Samples;

/// Nodes of a block along each side.
const BLOCK: usize = 8;
/// Deeper than this many steps a value is not needed.
const DEPTH: f64 = 2.0;

/// Signed distances in a box with about `cells` cells along its longest side; far from the surface they are only bounds.
pub fn carve(views: &[View], [lo, hi]: &[Vec3; 2], cells: usize) -> Samples {
    let mut samples = Samples::over(lo, hi, cells, 2, 0.0);
    let (order, step, size) = (spread(views.len()), samples.step, samples.size);
    let deep = DEPTH * step;
    let origin = samples.origin;
    // Layers of blocks along z, each by one thread.
    let layer = size[0] * size[1] * BLOCK;
    samples.values.par_chunks_mut(layer).enumerate().for_each(|(k, values)| {
        let depth = values.len() / (size[0] * size[1]);
        for (j, i) in
            (0..size[1]).step_by(BLOCK).flat_map(|j| (0..size[0]).step_by(BLOCK).map(move |i| (j, i)))
        {
            let count = [BLOCK.min(size[0] - i), BLOCK.min(size[1] - j), depth];
            let first = [i, j, k * BLOCK];
            let place = |a: [f64; 3]| origin + Vec3::from(a) * step;
            let middle = place([0, 1, 2].map(|a| first[a] as f64 + (count[a] - 1) as f64 / 2.0));
            let reach = count.iter().map(|c| (*c as f64 - 1.0).powi(2)).sum::<f64>().sqrt() / 2.0 * step;
            // Perspective changes the distance a little over a block.
            let bound = 1.2 * reach + deep;
            let at_middle = least(views, &order, &middle, -bound);
            for c in 0..count.iter().product() {
                let at = [c % count[0], c / count[0] % count[1], c / count[0] / count[1]];
                let value = if at_middle.abs() > bound {
                    at_middle.signum() * deep
                } else {
                    let p = place([0, 1, 2].map(|a| (first[a] + at[a]) as f64));
                    least(views, &order, &p, -deep).clamp(-deep, deep)
                };
                values[(at[2] * size[1] + j + at[1]) * size[0] + i + at[0]] = value as f32;
            }
        }
    });
    samples
}

/// The least distance over all views; once below `enough` any value below it.
fn least(views: &[View], order: &[usize], p: &Vec3, enough: f64) -> f64 {
    let mut least = f64::from(f32::MAX);
    for k in order {
        least = least.min(views[*k].distance(p));
        if least < enough {
            break;
        }
    }
    least
}

/// Numbers below n in an order in which neighbours come late: views from other sides exclude more.
pub(crate) fn spread(n: usize) -> Vec<usize> {
    let gcd = |mut a: usize, mut b: usize| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let near = (n as f64 * 0.382) as usize;
    let stride = (near.max(1)..=n.max(1)).find(|s| gcd(*s, n) == 1).unwrap_or(1);
    (0..n).map(|k| k * stride % n).collect()
}
