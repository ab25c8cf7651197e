//! The point of a triangle nearest to a position.

use crate::Vec3;

/// The part of a triangle that a nearest point lies on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Feature {
    /// The inside of the triangle.
    Face,
    /// Edge `i` runs from corner `i` to corner `i + 1` (mod 3).
    Edge(u8),
    /// Corner `i`.
    Corner(u8),
}

/// Square of the least height-to-length ratio at which a triangle defines a plane; flatter ones are
/// treated as their edges, which is exact to a part in 10¹² of their size.
const FLAT: f64 = 1e-24;

/// The point of triangle `tri` [m] nearest to `p` [m].
#[inline]
pub fn closest_point(tri: [Vec3; 3], p: Vec3) -> Vec3 {
    closest_feature(tri, p).0
}

/// The point of triangle `tri` [m] nearest to `p` [m], and the feature it lies on.
///
/// A point that projects inside lies on the face; every other one has its nearest point on one of the three
/// edges. Triangles without area (needles, single points) have edges only.
#[inline]
pub fn closest_feature(tri: [Vec3; 3], p: Vec3) -> (Vec3, Feature) {
    let [a, b, c] = tri;
    let (ab, ac, bc) = (b - a, c - a, c - b);
    let normal = ab.cross(&ac);
    let area = normal.norm_squared();
    let longest = ab.norm_squared().max(ac.norm_squared()).max(bc.norm_squared());
    if area > FLAT * longest * longest {
        // Barycentric weights, each the signed area of the triangle that p makes with one edge.
        let wa = bc.cross(&(p - b)).dot(&normal);
        let wb = -ac.cross(&(p - c)).dot(&normal);
        let wc = ab.cross(&(p - a)).dot(&normal);
        if wa > 0.0 && wb > 0.0 && wc > 0.0 {
            return (p - normal * (normal.dot(&(p - a)) / area), Feature::Face);
        }
    }
    let edges = [on_segment(a, b, p), on_segment(b, c, p), on_segment(c, a, p)];
    let mut best = (f64::INFINITY, a, Feature::Corner(0));
    for (i, (point, share)) in (0u8..).zip(edges) {
        let distance = (p - point).norm_squared();
        if distance < best.0 {
            let feature = match share {
                s if s <= 0.0 => Feature::Corner(i),
                s if s >= 1.0 => Feature::Corner((i + 1) % 3),
                _ => Feature::Edge(i),
            };
            best = (distance, point, feature);
        }
    }
    (best.1, best.2)
}

/// Nearest point of the segment from `a` to `b`, and its share of the way.
#[inline]
fn on_segment(a: Vec3, b: Vec3, p: Vec3) -> (Vec3, f64) {
    let along = b - a;
    let length = along.norm_squared();
    let share = if length > 0.0 { ((p - a).dot(&along) / length).clamp(0.0, 1.0) } else { 0.0 };
    // From the nearer end, so that both ends are met exactly.
    if share <= 0.5 { (a + along * share, share) } else { (b - along * (1.0 - share), share) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn brute(tri: [Vec3; 3], p: Vec3) -> f64 {
        let n = 400;
        let mut best = f64::INFINITY;
        for i in 0..=n {
            for j in 0..=n - i {
                let (u, v) = (i as f64 / n as f64, j as f64 / n as f64);
                best = best.min((tri[0] * (1.0 - u - v) + tri[1] * u + tri[2] * v - p).norm());
            }
        }
        best
    }

    #[test]
    fn no_sampled_point_of_the_triangle_is_nearer() {
        let mut state = 3u64;
        let mut next = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let mut place = |s: f64| Vec3::new(s * next(), s * next(), s * next());
        for round in 0..60 {
            let mut tri = [place(1.0), place(1.0), place(1.0)];
            if round % 4 == 1 {
                tri[2] = tri[0] + (tri[1] - tri[0]) * 0.3; // a needle
            }
            if round % 4 == 2 {
                tri[2] = tri[1];
            }
            let p = place(3.0);
            let found = (closest_point(tri, p) - p).norm();
            let sampled = brute(tri, p);
            assert!(found <= sampled + 1e-12 && found > sampled - 0.01, "{found} {sampled}");
        }
    }

    #[test]
    fn features_are_named() {
        let tri = [Vec3::zeros(), Vec3::x(), Vec3::y()];
        let at = |x, y, z| closest_feature(tri, Vec3::new(x, y, z));
        assert_eq!(at(0.25, 0.25, 2.0), (Vec3::new(0.25, 0.25, 0.0), Feature::Face));
        assert_eq!(at(0.5, -1.0, 1.0), (Vec3::new(0.5, 0.0, 0.0), Feature::Edge(0)));
        assert_eq!(at(2.0, -0.5, 0.0), (Vec3::x(), Feature::Corner(1)));
        assert_eq!(at(-1.0, -1.0, 0.0), (Vec3::zeros(), Feature::Corner(0)));
    }

    #[test]
    fn a_triangle_that_is_a_point() {
        let p = Vec3::new(1.0, 2.0, 3.0);
        assert_eq!(closest_point([p; 3], Vec3::zeros()), p);
    }
}
