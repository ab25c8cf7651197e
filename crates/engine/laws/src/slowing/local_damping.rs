//! Local damping: a force against the motion of each particle, in proportion to the force that is not in balance.
//!
//! ```text
//! F_d = −α |F| sign(v),  M_d = −α |M| sign(ω)       by component; F, M: all that acts on the particle (contacts, bonds, weight, fluid)
//! ```
//!
//! Cundall (1987), in Analytical and Computational Methods in Engineering Rock Mechanics.

use primitives::Vec3;

/// The acceleration against a velocity, of all other accelerations together.
#[inline]
pub fn against(factor: f64, all: &Vec3, velocity: &Vec3) -> Vec3 {
    let one = |axis: usize| {
        let v = velocity[axis];
        let sign = if v == 0.0 { 0.0 } else { v.signum() };
        -factor * all[axis].abs() * sign
    };
    Vec3::new(one(0), one(1), one(2))
}
