//! Random numbers of a scene.

use crate::keys::OneOrRange;
pub(in crate::plan) use geom::random::{generator, random_orientation, unit};
use rand_pcg::Pcg64Mcg;

/// Streams of random numbers, one for each kind of entry: another number makes other scenes of the same keys.
pub(in crate::plan) const FILL: u64 = 1;
pub(in crate::plan) const INSERT: u64 = 2;
pub(in crate::plan) const CLUMPS: u64 = 4;

/// A diameter of the range [m].
pub(in crate::plan) fn diameter(range: OneOrRange, random: &mut Pcg64Mcg) -> f64 {
    range.low + (range.high - range.low) * unit(random)
}
