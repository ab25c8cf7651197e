//! Sampling from coarse to fine.

use super::View;
use geom::Vec3;
use remesh::Samples;

/// Nodes of a block along each side.
const BLOCK: usize = 8;
/// Deeper than this many steps a value is not needed.
const DEPTH: f64 = 2.0;

/// Signed distances in a box with about `cells` cells along its longest side; far from the surface they are only bounds.
pub fn carve(views: &[View], [lo, hi]: &[Vec3; 2], cells: usize) -> Samples {
    let mut samples = Samples::over(lo, hi, cells, 2, 0.0);
    let (order, step) = (spread(views.len()), samples.step);
    let deep = DEPTH * step;
    samples.in_blocks(BLOCK, |block| {
        let middle = block.between(block.count.map(|n| (n - 1) as f64 / 2.0));
        let reach = block.count.iter().map(|c| (*c as f64 - 1.0).powi(2)).sum::<f64>().sqrt() / 2.0 * step;
        // Perspective changes the distance a little over a block.
        let bound = 1.2 * reach + deep;
        let at_middle = least(views, &order, &middle, -bound);
        for at in block.nodes() {
            let value = if at_middle.abs() > bound {
                at_middle.signum() * deep
            } else {
                least(views, &order, &block.place(at), -deep).clamp(-deep, deep)
            };
            *block.value(at) = value as f32;
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
