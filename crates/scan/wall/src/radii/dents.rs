//! Dents far deeper than asked for: where neighbours are so far apart that the wall cannot have its roughness.
//!
//! Of points at least S apart with none farther than S from one of them, neighbours are at most 2 S apart, and about 1.35 S on average: with
//! one radius the deepest dent is about twice the mean one. Between scanned points voids of a radius of up to 0.6 S may stay, which
//! `cloud-fill --for-spacing` does not fill: there neighbours are up to 3.2 S apart, and dents (3.2/1.35)² = 5.6 times the mean. A dent more
//! than six times as deep as asked is where points are missing.

use super::pairs::Pairs;
use super::solve::{ChangedPair, changed};
use geom::Vec3;
use serde::Serialize;

/// A dent is deep from this many times the roughness asked for.
pub const DEEP: f64 = 6.0;

/// Where a wall cannot have the roughness that was asked for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DeepDents {
    /// Pairs with deep dents.
    pub pairs: usize,
    /// Share of the wall that they are, each pair counted by the square of its distance [–].
    pub share: f64,
    /// The deepest dent, or the gap of spheres that do not meet [m].
    pub deepest: f64,
    /// What was asked for there [m].
    pub asked: f64,
    /// Distance of these neighbours [m].
    pub distance: f64,
    /// Where [m].
    pub at: [f64; 3],
}

/// The deep dents of spheres of these radii [m] on these points [m]; `asked` is the roughness at each [m].
pub(crate) fn find(points: &[Vec3], found: &Pairs, asked: &[f64], radii: &[f64]) -> Option<DeepDents> {
    let is_deep = |c: &ChangedPair| c.made > DEEP * c.asked;
    let deep: Vec<ChangedPair> =
        changed(&found.pairs, &found.lengths, asked, radii).filter(is_deep).collect();
    let worst = deep.iter().max_by(|a, b| a.made.total_cmp(&b.made).then(b.pair.cmp(&a.pair)))?;
    let square = |pair: usize| found.lengths[pair] * found.lengths[pair];
    let whole: f64 = (0..found.lengths.len()).map(square).sum();
    let (i, j) = found.pairs[worst.pair];
    Some(DeepDents {
        pairs: deep.len(),
        share: deep.iter().map(|c| square(c.pair)).sum::<f64>() / whole,
        deepest: worst.made,
        asked: worst.asked,
        distance: found.lengths[worst.pair],
        at: ((points[i as usize] + points[j as usize]) * 0.5).into(),
    })
}
