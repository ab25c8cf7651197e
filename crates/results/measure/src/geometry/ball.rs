//! Volume of the part of a ball that lies in a box, behind a plane, or in another ball, in closed form.
//!
//! The corner {x ≥ a, y ≥ b, z ≥ c} of the unit ball, for a, b, c ≥ 0 and a² + b² + c² < 1, has by the divergence
//! theorem (x·n is 1 on the sphere and −a, −b, −c on the planes)
//!
//! ```text
//! V = (S − a Aₐ − b A_b − c A_c) / 3          ρₐ = √(1 − a²)
//! S = 2π − Σ_pairs acos(−ab / ρₐρ_b) − Σ a φₐ  (Gauss–Bonnet; the arc on x = a turns by a φₐ)
//! φₐ = acos(b/ρₐ) − asin(c/ρₐ)                 angle of that arc
//! Aₐ = (ρₐ² φₐ − b (√(ρₐ² − b²) − c) − c (√(ρₐ² − c²) − b)) / 2
//! ```
//!
//! Negative a: {y ≥ b, z ≥ c} less the corner at −a, and so on. A box is eight corners with alternating signs, as in
//! Freireich, Kodam & Wassgren (2010), AIChE Journal 56(12), DOI 10.1002/aic.12223. Rounding is about 1e-15 of the ball.

use geom::{Plane, Vec3};
use std::f64::consts::PI;

pub use geom::sphere::volume;

/// Volume [m³] of the part of a ball between the corners `low` and `high` [m] of a box; corners may be infinite.
pub fn in_box(centre: &Vec3, radius: f64, low: &Vec3, high: &Vec3) -> f64 {
    let a = (low - centre) / radius;
    let b = (high - centre) / radius;
    if a.iter().all(|v| *v <= -1.0) && b.iter().all(|v| *v >= 1.0) {
        return volume(radius);
    }
    if a.iter().any(|v| *v >= 1.0) || b.iter().any(|v| *v <= -1.0) || (0..3).any(|k| a[k] >= b[k]) {
        return 0.0;
    }
    let mut sum = 0.0;
    for corner_of in 0..8 {
        let side = |axis: usize| if corner_of >> axis & 1 == 0 { a[axis] } else { b[axis] };
        let sign = if (corner_of as u32).count_ones().is_multiple_of(2) { 1.0 } else { -1.0 };
        sum += sign * corner(side(0).clamp(-1.0, 1.0), side(1).clamp(-1.0, 1.0), side(2).clamp(-1.0, 1.0));
    }
    sum.clamp(0.0, volume(1.0)) * radius * radius * radius
}

/// Volume [m³] of the part of a ball on the side of a plane that its normal points to.
pub fn behind(centre: &Vec3, radius: f64, plane: &Plane) -> f64 {
    cap((-plane.signed_distance(centre) / radius).clamp(-1.0, 1.0)) * radius * radius * radius
}

/// Volume [m³] that two balls share.
pub fn lens(distance: f64, r: f64, s: f64) -> f64 {
    if distance >= r + s {
        return 0.0;
    }
    if distance <= (r - s).abs() {
        return volume(r.min(s));
    }
    let (depth, difference) = (r + s - distance, r - s);
    PI * depth * depth * (distance * distance + 2.0 * distance * (r + s) - 3.0 * difference * difference)
        / (12.0 * distance)
}

/// Unit ball, z ≥ c.
fn cap(c: f64) -> f64 {
    PI / 3.0 * (1.0 - c) * (1.0 - c) * (2.0 + c)
}

/// Unit ball, y ≥ b and z ≥ c.
fn wedge(b: f64, c: f64) -> f64 {
    if b < 0.0 {
        cap(c) - wedge(-b, c)
    } else if c < 0.0 {
        cap(b) - wedge(b, -c)
    } else {
        2.0 * corner(b, c, 0.0)
    }
}

/// Unit ball, x ≥ a, y ≥ b and z ≥ c.
fn corner(a: f64, b: f64, c: f64) -> f64 {
    if a < 0.0 {
        return wedge(b, c) - corner(-a, b, c);
    }
    if b < 0.0 {
        return wedge(a, c) - corner(a, -b, c);
    }
    if c < 0.0 {
        return wedge(a, b) - corner(a, b, -c);
    }
    if a * a + b * b + c * c >= 1.0 {
        return 0.0;
    }
    let (phi_a, area_a) = arc(a, b, c);
    let (phi_b, area_b) = arc(b, c, a);
    let (phi_c, area_c) = arc(c, a, b);
    let turn = |p: f64, q: f64| libm::acos(-p * q / ((1.0 - p * p) * (1.0 - q * q)).sqrt());
    let sphere = 2.0 * PI - turn(a, b) - turn(b, c) - turn(c, a) - a * phi_a - b * phi_b - c * phi_c;
    ((sphere - a * area_a - b * area_b - c * area_c) / 3.0).max(0.0)
}

/// Angle of the arc, and area of the face, on x = a.
fn arc(a: f64, b: f64, c: f64) -> (f64, f64) {
    let squared = 1.0 - a * a;
    let rho = squared.sqrt();
    let phi = libm::acos((b / rho).min(1.0)) - libm::asin((c / rho).min(1.0));
    let chord = |p: f64| (squared - p * p).max(0.0).sqrt();
    (phi, 0.5 * (squared * phi - b * (chord(b) - c) - c * (chord(c) - b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By slices along z, each a disc cut by a rectangle, which is sampled finely.
    fn by_brute_force(centre: &Vec3, radius: f64, inside: impl Fn(&Vec3) -> bool) -> f64 {
        let n = 160;
        let step = 2.0 * radius / n as f64;
        let at = |k: usize| -radius + (k as f64 + 0.5) * step;
        let mut count = 0;
        for i in 0..n {
            for j in 0..n {
                for k in 0..n {
                    let p = Vec3::new(at(i), at(j), at(k));
                    count += usize::from(p.norm() <= radius && inside(&(centre + p)));
                }
            }
        }
        count as f64 * step * step * step
    }

    #[test]
    fn symmetric_cuts_are_halves_quarters_eighths() {
        let (centre, far) = (Vec3::new(1.0, 2.0, 3.0), Vec3::repeat(f64::INFINITY));
        let mut low = -far;
        for (axis, share) in [0.5, 0.25, 0.125].into_iter().enumerate() {
            low[axis] = centre[axis];
            let part = in_box(&centre, 0.3, &low, &far) / volume(0.3);
            assert!((part - share).abs() < 1e-14, "{part}");
        }
    }

    #[test]
    fn slabs_are_differences_of_caps() {
        let (mut low, mut high) = (Vec3::repeat(-9.0), Vec3::repeat(9.0));
        (low.y, high.y) = (0.1, 0.37);
        let cap = |h: f64| PI * h * h * (3.0 * 0.5 - h) / 3.0;
        let expected = cap(0.5 - 0.1) - cap(0.5 - 0.37);
        assert!((in_box(&Vec3::zeros(), 0.5, &low, &high) - expected).abs() < 1e-15);
    }

    #[test]
    fn any_box_agrees_with_brute_force() {
        let centre = Vec3::new(0.2, -0.1, 0.4);
        for (low, high) in [
            ([0.0, -0.5, 0.1], [0.5, 0.3, 0.9]),
            ([0.3, 0.1, 0.5], [2.0, 2.0, 2.0]),
            ([-0.4, -0.3, 0.0], [0.3, 0.0, 0.3]),
            ([0.1, -0.2, 0.3], [0.3, 0.0, 0.5]),
        ] {
            let (low, high) = (Vec3::from(low), Vec3::from(high));
            let inside = |p: &Vec3| (0..3).all(|k| low[k] <= p[k] && p[k] <= high[k]);
            let (exact, counted) = (in_box(&centre, 0.7, &low, &high), by_brute_force(&centre, 0.7, inside));
            assert!((exact - counted).abs() < 2e-3 * volume(0.7), "{exact} {counted}");
        }
    }

    #[test]
    fn cells_that_fill_space_share_a_ball_without_loss() {
        let (centre, edges) = (Vec3::new(0.03, -0.02, 0.11), [-9.0, -0.31, -0.02, 0.1, 0.35, 9.0]);
        let mut sum = 0.0;
        for x in edges.windows(2) {
            for y in edges.windows(2) {
                for z in edges.windows(2) {
                    sum += in_box(&centre, 0.5, &Vec3::new(x[0], y[0], z[0]), &Vec3::new(x[1], y[1], z[1]));
                }
            }
        }
        assert!((sum / volume(0.5) - 1.0).abs() < 1e-13, "{sum}");
    }

    #[test]
    fn two_balls_share_a_lens() {
        for (distance, r) in [(0.6, 0.4), (0.5, 0.2)] {
            let other = Vec3::new(distance, 0.0, 0.0);
            let counted = by_brute_force(&Vec3::zeros(), 0.5, |p| (p - other).norm() <= r);
            let exact = lens(distance, 0.5, r);
            assert!((exact - counted).abs() < 2e-4 * volume(0.5), "{exact} {counted}");
        }
        assert_eq!((lens(1.0, 0.5, 0.4), lens(0.05, 0.5, 0.4)), (0.0, volume(0.4)));
    }
}
