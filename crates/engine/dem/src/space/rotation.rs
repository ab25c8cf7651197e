//! Turns a rigid body whose angular momentum L is constant.
//!
//! ```text
//! H = |L|²/2I₁ + (1/I₃ − 1/I₁) l₃²/2 + (1/I₂ − 1/I₁) l₂²/2          l = Rᵀ L, the body's own components
//! ```
//!
//! The flow of each part is a turn: about L by |L|/I₁ Δt (which changes no l and so commutes with the others), about the body's
//! third axis by (1/I₃ − 1/I₁) l₃ Δt, about its second in the same way. Composed as half the third, the second, half the third:
//! of second order, symplectic, reversible; exact for a symmetric body (I₁ = I₂), and L is kept to the last bit because it is
//! not touched. Splitting around a symmetric top: Touma & Wisdom (1994), Astron. J. 107, doi:10.1086/116931; compared with others:
//! Fassò (2003), J. Comput. Phys. 189, doi:10.1016/S0021-9991(03)00234-8.

use geom::Vec3;
use nalgebra::{Quaternion, UnitQuaternion};

/// The turn after `dt` [s] of a body with turn `q` (its axes to space), angular momentum `momentum` in space [kg·m²/s], and
/// 1/I along its axes [1/(kg·m²)].
pub fn turned(q: &UnitQuaternion<f64>, momentum: &Vec3, inverse: &[f64; 3], dt: f64) -> UnitQuaternion<f64> {
    let mut own = q.inverse_transform_vector(momentum);
    let (second, third) = (inverse[1] - inverse[0], inverse[2] - inverse[0]);
    let mut q = spun(&(momentum * (inverse[0] * dt))).into_inner() * q.quaternion();
    let mut about = |axis: usize, rate: f64| {
        let mut angle = Vec3::zeros();
        angle[axis] = rate * own[axis];
        let turn = spun(&angle);
        q *= turn.quaternion();
        own = turn.inverse_transform_vector(&own);
    };
    if second == 0.0 {
        if third != 0.0 {
            about(2, third * dt);
        }
    } else {
        about(2, 0.5 * third * dt);
        about(1, second * dt);
        about(2, 0.5 * third * dt);
    }
    UnitQuaternion::new_unchecked(q / q.norm())
}

/// The turn about a vector by its length [rad], with sine and cosine that are the same on every platform: for the small turns of a step
/// their series, to the last digit.
pub fn spun(v: &Vec3) -> UnitQuaternion<f64> {
    let square = 0.25 * v.norm_squared();
    let (share, cosine) = if square < SMALL {
        let share = 0.5 - square * (1.0 / 12.0 - square * (1.0 / 240.0 - square * (1.0 / 10080.0)));
        (share, 1.0 - square * (0.5 - square * (1.0 / 24.0 - square * (1.0 / 720.0))))
    } else {
        let half = square.sqrt();
        (0.5 * libm::sin(half) / half, libm::cos(half))
    };
    let vector = v * share;
    UnitQuaternion::new_unchecked(Quaternion::new(cosine, vector.x, vector.y, vector.z))
}

/// Squares of half a turn whose eighth power is beyond the last digit.
const SMALL: f64 = 1e-4;

/// ω = R I⁻¹ Rᵀ L [rad/s].
pub fn spin(q: &UnitQuaternion<f64>, momentum: &Vec3, inverse: &[f64; 3]) -> Vec3 {
    let own = q.inverse_transform_vector(momentum);
    q.transform_vector(&own.component_mul(&Vec3::from(*inverse)))
}

/// L = R I Rᵀ ω [kg·m²/s].
pub fn momentum(q: &UnitQuaternion<f64>, spin: &Vec3, inverse: &[f64; 3]) -> Vec3 {
    let own = q.inverse_transform_vector(spin);
    q.transform_vector(&own.component_div(&Vec3::from(*inverse)))
}
