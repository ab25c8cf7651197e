//! A solid sphere.

use core::f64::consts::PI;

/// Volume of a sphere [m³].
#[inline]
pub fn volume(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius * radius * radius
}
