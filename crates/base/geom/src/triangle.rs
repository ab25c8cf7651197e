//! The point of a triangle nearest to a position, and the angle under which a triangle is seen.

use crate::Vec3;
pub use primitives::{Feature, closest_feature, closest_point};

/// The solid angle [sr] under which a triangle [m] is seen from `p`, above 0 from the side that its corners run around with the clock: van Oosterom &
/// Strackee (1983), IEEE Trans. Biomed. Eng. 30(2), doi:10.1109/TBME.1983.325207.
pub fn solid_angle(tri: &[Vec3; 3], p: &Vec3) -> f64 {
    let [a, b, c] = tri.map(|corner| corner - p);
    let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
    let across = a.dot(&b.cross(&c));
    let along = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
    2.0 * libm::atan2(across, along)
}
