//! Spheres, and where rows wait that nothing may touch.

use crate::simd::Row;

/// Two rows that nothing ever touches: what the unused slots of a block point to.
pub const FAR: [Row; 2] = [
    Row([1e150, 1e150, 1e150, 0.0, 0.0, 0.0, 0.0, 1.0]),
    Row([-1e150, -1e150, -1e150, 0.0, 0.0, 0.0, 0.0, 1.0]),
];

/// How far away those are put that are out of the calculation [m]: no wall and no grain of a scene gets there.
const AWAY: f64 = 1e100;

/// Where row `k` waits until the next rebuild drops it: each at a different position, because two at one position would overlap.
pub fn away(k: usize) -> [f64; 3] {
    [-AWAY * (k + 1) as f64; 3]
}

/// Whether a row is out of the calculation. Its distance from a plane may be any number, also 0, and means nothing.
pub fn is_away(row: &Row) -> bool {
    row[0] <= -AWAY
}

/// m r²/I of a sphere [–].
pub const TURNS: f64 = 2.5;

/// Reciprocal of the moment of inertia of a sphere [1/(kg·m²)] of `radius` [m] and 1/m [1/kg].
#[inline(always)]
pub fn inverse_inertia(radius: f64, inverse_mass: f64) -> f64 {
    TURNS * inverse_mass / (radius * radius)
}
