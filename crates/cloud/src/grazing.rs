//! Points in the air between two surfaces, and surfaces that are seen edgewise.
//!
//! ```text
//! around    the K points nearest in direction, seen from the viewpoint; ρ: how far the farthest of them is off the line of sight
//! jump      the range of one of them differs by more than ρ tan ANGLE: towards it, the surface has more than ANGLE to its normal
//! grazing   from every viewpoint, two or more jumps to what is nearer and two or more to what is farther
//! ```
//!
//! A beam that meets an edge is reflected by what is in front and by what is behind, and its point lies between: a mixed pixel. Points on the edge
//! itself have jumps to one side only. The test of the angle is that of Tang, Huber & Akinci (2007), doi:10.1109/3DIM.2007.5, for neighbours in all
//! directions instead of those of a scan line. Where scans are merged, what other scanners saw behind a surface is farther, but nothing is nearer.

use geom::Vec3;
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use rayon::prelude::*;
use std::num::NonZero;

/// Points around.
const AROUND: usize = 12;
/// Jumps to each side.
const JUMPS: usize = 2;

/// Rows of the finite `points` [m] that are not grazing from some viewpoint of `eyes` [m], in order. Too few points are not.
pub fn faced(points: &[Vec3], eyes: &[Vec3], degrees: f64) -> Vec<u32> {
    let mut grazing = vec![true; points.len()];
    for eye in eyes {
        let sees: Vec<bool> = match View::new(points, eye) {
            Some(view) => (0..points.len()).into_par_iter().map(|i| !view.is_grazing(i, degrees)).collect(),
            None => vec![true; points.len()],
        };
        grazing.iter_mut().zip(sees).for_each(|(grazing, sees)| *grazing &= !sees);
    }
    (0u32..).zip(grazing).filter(|(_, grazing)| !grazing).map(|(i, _)| i).collect()
}

/// Points as a viewpoint sees them.
struct View {
    /// Unit vectors to the points.
    directions: Vec<[f64; 3]>,
    /// Distances [m].
    ranges: Vec<f64>,
    tree: ImmutableKdTree<f64, 3>,
    and_self: NonZero<usize>,
}

impl View {
    /// `None`: there are too few.
    fn new(points: &[Vec3], eye: &Vec3) -> Option<View> {
        let and_self = NonZero::new(AROUND + 1).filter(|n| n.get() <= points.len())?;
        let ranges: Vec<f64> = points.iter().map(|p| (p - eye).norm()).collect();
        // The eye itself has no direction, and a range of 0.
        let unit = |(p, range): (&Vec3, &f64)| ((p - eye) / range.max(f64::MIN_POSITIVE)).into();
        let directions: Vec<[f64; 3]> = points.iter().zip(&ranges).map(unit).collect();
        let tree = ImmutableKdTree::new_from_slice(&directions).ok()?;
        Some(View { directions, ranges, tree, and_self })
    }

    fn is_grazing(&self, i: usize, degrees: f64) -> bool {
        let found =
            self.tree.query(&self.directions[i]).nearest_n::<SquaredEuclidean<f64>>(self.and_self).execute();
        let farthest = found.iter().map(|n| n.distance).fold(0.0, f64::max).sqrt();
        let jump = self.ranges[i] * farthest * degrees.to_radians().tan();
        let steps = || found.iter().map(|n| self.ranges[n.item as usize] - self.ranges[i]);
        steps().filter(|s| *s < -jump).count() >= JUMPS && steps().filter(|s| *s > jump).count() >= JUMPS
    }
}
