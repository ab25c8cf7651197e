//! Sectors around an axis.

use std::f64::consts::TAU;

/// The sector, of `count` equal ones, in which a point lies, from its coordinates across the axis.
pub(super) fn sector([x, y]: [f64; 2], count: usize) -> usize {
    let share = libm::atan2(y, x).rem_euclid(TAU) / TAU;
    ((share * count as f64) as usize).min(count - 1)
}
