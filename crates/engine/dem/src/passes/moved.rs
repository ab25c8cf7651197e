//! What passes behind the move share: they add accelerations that the move did not have, and watch margins.

use geom::Vec3;
use laws::simd::{Row, Row4};

/// Adds an acceleration `a` [m/s²] of the instant before a move of `dt` [s] to a particle that has moved without it: to its position, its
/// predicted velocity and its acceleration.
#[inline(always)]
pub fn accelerate(row: &mut Row, acceleration: &mut Row4, a: &Vec3, dt: f64) {
    for axis in 0..3 {
        row[axis] += dt * dt * a[axis];
        row[4 + axis] += 1.5 * dt * a[axis];
        acceleration[axis] += a[axis];
    }
}

/// Whether a particle has left its margin, or will within `ahead` [s], before contacts are looked for.
#[inline(always)]
pub fn has_left(row: &Row, home: &Row4, ahead: f64) -> bool {
    let margin = (home[3] - ahead * row.velocity().norm()).max(0.0);
    (row.position() - home.vector()).norm_squared() > margin * margin
}
