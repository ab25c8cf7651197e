//! Roots of lanes.

use super::Lane;

/// x^(1/3) of a positive number: from x^(1/4 + 1/16), which is within a factor of 3 for 1e-21 < x < 1e21, by Halley's steps,
/// each of which triples the digits.
#[inline(always)]
pub fn cube_root<R: Lane>(x: R) -> R {
    let quarter = x.sqrt().sqrt();
    let mut y = quarter * quarter.sqrt().sqrt();
    for _ in 0..5 {
        let cube = y * y * y;
        y = y * (cube + x + x) / (cube + cube + x);
    }
    y
}
