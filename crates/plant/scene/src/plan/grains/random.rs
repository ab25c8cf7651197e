//! Random numbers of a scene.

use crate::keys::Diameter;
pub(in crate::plan) use geom::random::{generator, random_orientation, unit};
use rand_pcg::Pcg64Mcg;

/// A diameter of the range [m].
pub(in crate::plan) fn diameter(range: Diameter, random: &mut Pcg64Mcg) -> f64 {
    range.low + (range.high - range.low) * unit(random)
}
