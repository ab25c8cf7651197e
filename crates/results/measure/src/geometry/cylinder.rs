//! Volume of the part of a ball that lies in a cylinder, by quadrature along the cylinder's axis.
//!
//! ```text
//! V = ∫ A(ρ(h), R, D) dh      ρ(h) = √(r² − h²)
//! ```
//!
//! A is the area that two discs share (radii ρ and R, centres D apart). The integral is cut where the discs begin to
//! touch or one covers the other: A has square-root-like ends there, which h = ½(h₀ + h₁) − ½(h₁ − h₀) cos u makes
//! smooth in u, so that Gauss–Legendre with 24 nodes in u converges quickly: the error is below 1e-9 of the ball.

use geom::{Vec3, quadrature::gauss_legendre};
use std::f64::consts::PI;
use std::sync::OnceLock;

const NODES: usize = 24;

/// Volume [m³] of the part of a ball in the cylinder from `start` to `end` [m] of radius `wide` [m].
pub fn in_cylinder(centre: &Vec3, radius: f64, start: &Vec3, end: &Vec3, wide: f64) -> f64 {
    let axis = end - start;
    let length = axis.norm();
    let from = centre - start;
    let along = from.dot(&axis) / length;
    let off = (from - axis * (along / length)).norm();
    if off >= wide + radius {
        return 0.0;
    }
    let (low, high) = ((-along).clamp(-radius, radius), (length - along).clamp(-radius, radius));
    // Heights above the ball's centre where the discs touch from outside or from inside.
    let kink = |rho: f64| (0.0..radius).contains(&rho).then(|| (radius * radius - rho * rho).sqrt());
    let mut cuts = vec![low, high];
    for h in [off - wide, wide - off, wide + off].into_iter().filter_map(kink) {
        cuts.extend([-h, h].into_iter().filter(|h| low < *h && *h < high));
    }
    cuts.sort_by(f64::total_cmp);
    let disc = |h: f64| (radius * radius - h * h).max(0.0).sqrt();
    cuts.windows(2).map(|piece| integral(piece[0], piece[1], |h| shared(disc(h), wide, off))).sum()
}

/// Area [m²] that two discs share.
fn shared(r: f64, s: f64, distance: f64) -> f64 {
    if distance >= r + s {
        return 0.0;
    }
    if distance <= (r - s).abs() {
        return PI * r.min(s) * r.min(s);
    }
    let d = distance;
    let acos = |c: f64| libm::acos(c.clamp(-1.0, 1.0));
    let (a, b) = ((d * d + r * r - s * s) / (2.0 * d * r), (d * d + s * s - r * r) / (2.0 * d * s));
    let kite = (-d + r + s) * (d + r - s) * (d - r + s) * (d + r + s);
    r * r * acos(a) + s * s * acos(b) - 0.5 * kite.max(0.0).sqrt()
}

fn integral(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let half = 0.5 * (high - low);
    let term = |(x, w): &(f64, f64)| {
        let u = 0.5 * PI * (x + 1.0);
        w * f(low + half * (1.0 - libm::cos(u))) * libm::sin(u)
    };
    half * 0.5 * PI * nodes().iter().map(term).sum::<f64>()
}

fn nodes() -> &'static [(f64, f64)] {
    static ONCE: OnceLock<Vec<(f64, f64)>> = OnceLock::new();
    ONCE.get_or_init(|| gauss_legendre(NODES))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ball::{in_box, volume};

    const START: Vec3 = Vec3::new(0.1, 0.2, 0.3);

    #[test]
    fn a_wide_cylinder_is_a_slab_and_a_whole_one_takes_the_ball() {
        let end = START + Vec3::new(0.0, 0.0, 2.0);
        let centre = Vec3::new(0.15, 0.25, 0.4);
        let slab = in_box(&centre, 0.3, &Vec3::new(-9.0, -9.0, 0.3), &Vec3::new(9.0, 9.0, 2.3));
        assert!((in_cylinder(&centre, 0.3, &START, &end, 5.0) / slab - 1.0).abs() < 1e-12);
        let inside = in_cylinder(&(START + Vec3::new(0.0, 0.0, 1.0)), 0.3, &START, &end, 0.5);
        assert!((inside / volume(0.3) - 1.0).abs() < 1e-12);
    }

    /// A bore through the centre leaves a ring of height h whose volume is that of a ball of diameter h.
    #[test]
    fn a_bored_ball_keeps_a_napkin_ring() {
        let (centre, bore, radius) = (Vec3::new(1.0, 2.0, 3.0), 0.31, 0.5);
        let direction = Vec3::new(1.0, -2.0, 0.5).normalize();
        let (start, end) = (centre - direction * 2.0, centre + direction * 2.0);
        let ring = volume(radius) - in_cylinder(&centre, radius, &start, &end, bore);
        let half: f64 = radius * radius - bore * bore;
        assert!((ring / volume(half.sqrt()) - 1.0).abs() < 1e-10, "{ring}");
    }

    #[test]
    fn two_discs_share_what_points_count() {
        assert!((shared(1.0, 1.0, 1.0) - (2.0 * PI / 3.0 - 0.75f64.sqrt())).abs() < 1e-14);
        let n = 1000;
        let at = |k: usize| (k as f64 + 0.5) / n as f64 - 0.5;
        let points = (0..n * n).map(|k| (at(k % n), at(k / n)));
        let both = points.filter(|(x, y)| x * x + y * y <= 0.25 && (x - 0.4).powi(2) + y * y <= 0.09);
        let counted = both.count() as f64 / (n * n) as f64;
        assert!((shared(0.5, 0.3, 0.4) - counted).abs() < 1e-4, "{counted}");
    }

    #[test]
    fn off_the_axis_it_agrees_with_a_fine_sum_of_slices() {
        for (off, wide) in [(0.4, 0.2), (0.1, 0.3), (0.6, 0.4), (0.5, 0.5), (0.05, 0.06)] {
            let centre = START + Vec3::new(off, 0.0, 0.2);
            let value = in_cylinder(&centre, 0.45, &START, &(START + Vec3::new(0.0, 0.0, 0.5)), wide);
            let n = 400_000;
            let (low, high) = (-0.2f64, 0.3f64);
            let step = (high - low) / n as f64;
            let rho = |k: usize| (0.45f64.powi(2) - (low + (k as f64 + 0.5) * step).powi(2)).sqrt();
            let sum: f64 = (0..n).map(|k| shared(rho(k), wide, off) * step).sum();
            assert!((value - sum).abs() < 1e-9 * volume(0.45), "{off} {wide}: {value} {sum}");
        }
    }
}
