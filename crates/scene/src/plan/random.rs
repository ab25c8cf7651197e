//! Random numbers of a scene.

use crate::keys::Diameter;
pub(super) use geom::random::{generator, unit};
use nalgebra::{Quaternion, UnitQuaternion};
use rand_pcg::Pcg64Mcg;
use std::f64::consts::TAU;

/// A diameter of the range [m].
pub(super) fn diameter(range: Diameter, random: &mut Pcg64Mcg) -> f64 {
    range.low + (range.high - range.low) * unit(random)
}

/// A random orientation, uniformly distributed: Shoemake (1992), Graphics Gems III.
pub(super) fn orientation(random: &mut Pcg64Mcg) -> UnitQuaternion<f64> {
    let (share, a, b) = (unit(random), TAU * unit(random), TAU * unit(random));
    let (p, q) = ((1.0 - share).sqrt(), share.sqrt());
    let (i, j) = (p * libm::sin(a), p * libm::cos(a));
    UnitQuaternion::new_normalize(Quaternion::new(q * libm::cos(b), i, j, q * libm::sin(b)))
}
