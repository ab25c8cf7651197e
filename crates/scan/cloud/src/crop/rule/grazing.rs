//! Points in the air between two surfaces, and surfaces that are seen edgewise.
//!
//! ```text
//! around    the 12 n points nearest in direction, seen from one of n viewpoints; ρ: how far the farthest of them is off the line of sight
//! jump      the range of one of them differs by more than ρ tan ANGLE: towards it, the surface has more than ANGLE to its normal
//! grazing   two or more jumps to what is nearer and two or more to what is farther
//! clear     not grazing, and a sixth of those around without a jump
//! goes      a point that is grazing from some viewpoint and clear from none
//! ```
//!
//! A beam that meets an edge is reflected by what is in front and by what is behind, and its point lies between: a mixed pixel. Points on the edge
//! itself have jumps to one side only. The test of the angle is that of Tang, Huber & Akinci (2007), doi:10.1109/3DIM.2007.5, for neighbours in all
//! directions instead of those of a scan line. Of merged scans, a surface is clear to the scanner that has measured it; a mixed pixel is to none: from
//! elsewhere it has no surface around it.

use geom::Vec3;
use kiddo::{ImmutableKdTree, SquaredEuclidean};
use rayon::prelude::*;
use std::num::NonZero;

/// Points around, for each viewpoint up to [`MOST`]: the scans lie in one another.
const AROUND: usize = 12;
/// See [`AROUND`].
const MOST: usize = 4;
/// Jumps to each side.
const JUMPS: usize = 2;
/// Of the points around, one of so many on the same surface.
const SAME: usize = 6;
/// Fewer points cannot be judged.
pub const FEWEST: usize = AROUND + 1;

/// How a viewpoint sees a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Look {
    Grazing,
    Clear,
    Neither,
}

/// Rows of the finite `points` [m] that stay, seen from `eyes` [m], in order. Fewer than [`FEWEST`] stay.
pub fn faced(points: &[Vec3], eyes: &[Vec3], degrees: f64) -> Vec<u32> {
    let slope = libm::tan(degrees.to_radians());
    let (mut grazing, mut clear) = (vec![false; points.len()], vec![false; points.len()]);
    for eye in eyes {
        let Some(view) = View::new(points, eye, AROUND * eyes.len().min(MOST)) else { break };
        let looks: Vec<Look> = (0..points.len()).into_par_iter().map(|i| view.look(i, slope)).collect();
        for ((grazing, clear), look) in grazing.iter_mut().zip(&mut clear).zip(looks) {
            *grazing |= look == Look::Grazing;
            *clear |= look == Look::Clear;
        }
    }
    (0u32..)
        .zip(grazing.iter().zip(&clear))
        .filter(|(_, (grazing, clear))| !**grazing || **clear)
        .map(|(i, _)| i)
        .collect()
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
    fn new(points: &[Vec3], eye: &Vec3, around: usize) -> Option<View> {
        let and_self =
            NonZero::new(around.min(points.len().saturating_sub(1)) + 1).filter(|n| n.get() >= FEWEST)?;
        let ranges: Vec<f64> = points.iter().map(|p| (p - eye).norm()).collect();
        // The eye itself has no direction, and a range of 0.
        let unit = |(p, range): (&Vec3, &f64)| ((p - eye) / range.max(f64::MIN_POSITIVE)).into();
        let directions: Vec<[f64; 3]> = points.iter().zip(&ranges).map(unit).collect();
        let tree = ImmutableKdTree::new_from_slice(&directions).ok()?;
        Some(View { directions, ranges, tree, and_self })
    }

    fn look(&self, i: usize, slope: f64) -> Look {
        let query = self.tree.query(&self.directions[i]);
        let found = query.nearest_n::<SquaredEuclidean<f64>>(self.and_self).execute();
        let farthest = found.iter().map(|n| n.distance).fold(0.0, f64::max).sqrt();
        let jump = self.ranges[i] * farthest * slope;
        let steps = || found.iter().map(|n| self.ranges[n.item as usize] - self.ranges[i]);
        let (nearer, farther) =
            (steps().filter(|s| *s < -jump).count(), steps().filter(|s| *s > jump).count());
        match found.len() - nearer - farther {
            _ if nearer >= JUMPS && farther >= JUMPS => Look::Grazing,
            // The point itself is one of them.
            same if SAME * (same - 1) >= found.len() - 1 => Look::Clear,
            _ => Look::Neither,
        }
    }
}
