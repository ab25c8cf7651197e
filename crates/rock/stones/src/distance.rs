//! Spheres by the inner Euclidean distance, greedily: the next sphere is the inscribed one that covers most of what no sphere covers yet.
//!
//! Candidates are the centres of grid cells inside; the radius of each is its distance to the surface, so a sphere never leaves the stone. The gain of
//! a candidate only falls as others are taken, so its old value is a bound, and only candidates at the head of a queue are looked at again
//! (lazy greedy: Minoux 1978, doi:10.1007/BFb0006528). What n spheres cover is at least 1 − 1/e of what n of these candidates can cover (Nemhauser,
//! Wolsey & Fisher 1978, doi:10.1007/BF01588971), where no overlap limit forbids it.

use crate::clump::{ClumpSettings, Sphere};
use crate::samples::Samples;
use crate::stone::Stone;
use rayon::prelude::*;
use std::collections::BinaryHeap;

/// Takes spheres until `enough` of them or of the volume are there; covers them in `samples`.
pub(crate) fn spheres(
    stone: &Stone,
    settings: &ClumpSettings,
    samples: &mut Samples,
    least_radius: f64,
    enough: impl Fn(usize, f64) -> bool,
) -> Vec<Sphere> {
    let candidate = |&cell: &u32| {
        let place = samples.place(cell);
        (place, stone.inside.distance(&place))
    };
    let candidates: Vec<Sphere> =
        samples.inside.par_iter().map(candidate).filter(|(_, r)| *r >= least_radius).collect();
    // No ball holds more cells than one that is wider by half the diagonal of a cell.
    let bound = |r: f64| (geom::sphere::volume(r + 0.87 * samples.cell) / samples.cell.powi(3)).ceil() as u32;
    let mut queue: BinaryHeap<(u32, std::cmp::Reverse<usize>)> =
        candidates.iter().enumerate().map(|(k, c)| (bound(c.1), std::cmp::Reverse(k))).collect();
    let mut taken: Vec<Sphere> = Vec::new();
    while let Some((_, std::cmp::Reverse(k))) = queue.pop() {
        let sphere = candidates[k];
        if taken.iter().any(|other| overlap(&sphere, other) > settings.overlap) {
            continue;
        }
        let gain = samples.gain(sphere);
        if gain == 0 {
            continue;
        }
        if queue.peek().is_some_and(|next| (gain, std::cmp::Reverse(k)) < *next) {
            queue.push((gain, std::cmp::Reverse(k)));
            continue;
        }
        samples.cover(sphere);
        taken.push(sphere);
        if enough(taken.len(), samples.uncovered()) {
            break;
        }
    }
    taken
}

/// Depth in which two spheres overlap, over the diameter of the smaller one [–]: 0 if they touch, 1 if the larger one just holds the other.
pub(crate) fn overlap(a: &Sphere, b: &Sphere) -> f64 {
    (a.1 + b.1 - (a.0 - b.0).norm()) / (2.0 * a.1.min(b.1))
}
