//! Volume and moment of inertia of a solid sphere.

use std::f64::consts::PI;

/// Moment of inertia over m r² [–].
pub const INERTIA: f64 = 0.4;
/// m r² over the moment of inertia [–].
pub const INVERSE_INERTIA: f64 = 2.5;

/// Volume of a sphere [m³].
#[inline]
pub fn volume(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius * radius * radius
}
