//! The distance from the centre of a stone to its surface as a sum of spherical harmonics.
//!
//! ```text
//! r(θ, φ) = Σ over l ≤ L, |m| ≤ l of  c_lm Y_lm(θ, φ),     c_lm = ∫ r Y_lm sin θ dθ dφ
//! power of degree l:  Σ over m of c_lm²                    the same in every orientation
//! ```
//!
//! Real, orthonormal Y_lm; Legendre functions by recursion: Holmes & Featherstone (2002), doi:10.1007/s00190-002-0216-2, unscaled. Stones as
//! harmonics: Garboczi (2002), doi:10.1016/S0008-8846(02)00836-0. Where the surface is met more than once, the farthest place counts.

use crate::stone::Stone;
use geom::{Vec3, quadrature::gauss_legendre};
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// L: details of about a twentieth of the circumference.
pub const DEGREE: usize = 20;
/// Coefficients up to L.
const COUNT: usize = (DEGREE + 1) * (DEGREE + 1);
/// Rings of the quadrature, and places of a ring.
const RINGS: usize = 40;
const PLACES: usize = 80;

/// Coefficients of a stone in its principal axes, for a volume of 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Harmonics {
    /// c_lm at l² + l + m.
    pub coefficients: Vec<f64>,
}

/// Number of l, m (m from −l to l).
fn at(l: usize, m: i64) -> usize {
    ((l * l + l) as i64 + m) as usize
}

/// All Y_lm of a direction.
fn all(direction: &Vec3) -> Vec<f64> {
    let n = direction.normalize();
    let (z, s) = (n.z, (n.x * n.x + n.y * n.y).sqrt());
    let phi = libm::atan2(n.y, n.x);
    let mut y = vec![0.0; COUNT];
    let mut diagonal = (0.25 / PI).sqrt();
    for m in 0..=DEGREE {
        if m > 0 {
            diagonal *= s * ((2 * m + 1) as f64 / (2 * m) as f64).sqrt();
        }
        let (mut before, mut now) = (0.0, diagonal);
        for l in m..=DEGREE {
            if l > m {
                let (l2, m2) = ((l * l) as f64, (m * m) as f64);
                let a = ((4.0 * l2 - 1.0) / (l2 - m2)).sqrt();
                let k = (l - 1) as f64;
                let b = ((k * k - m2) / (4.0 * k * k - 1.0)).max(0.0).sqrt();
                (before, now) = (now, a * (z * now - b * before));
            }
            let angle = m as f64 * phi;
            if m == 0 {
                y[at(l, 0)] = now;
            } else {
                let scaled = std::f64::consts::SQRT_2 * now;
                y[at(l, m as i64)] = scaled * libm::cos(angle);
                y[at(l, -(m as i64))] = scaled * libm::sin(angle);
            }
        }
    }
    y
}

impl Harmonics {
    /// Of a stone about its centre of mass, and the share of directions in which its surface is met more than once [–]; `None` when the centre
    /// is outside.
    pub fn of(stone: &Stone) -> Option<(Harmonics, f64)> {
        let size = stone.moments.volume.cbrt();
        let axes = principal(&stone.moments.inertia);
        if !stone.inside.contains(&stone.moments.centre) {
            return None;
        }
        let rings = gauss_legendre(RINGS);
        let place = |k: usize| {
            let (z, weight) = rings[k / PLACES];
            let phi = TAU * (k % PLACES) as f64 / PLACES as f64;
            let s = (1.0 - z * z).sqrt();
            let direction = Vec3::new(s * libm::cos(phi), s * libm::sin(phi), z);
            let (far, times) = farthest(stone, &(axes.transpose() * direction));
            (direction, weight * TAU / PLACES as f64, far / size, times)
        };
        let rays: Vec<(Vec3, f64, f64, usize)> = (0..RINGS * PLACES).into_par_iter().map(place).collect();
        let mut coefficients = vec![0.0; COUNT];
        for (direction, weight, r, _) in &rays {
            for (c, y) in coefficients.iter_mut().zip(all(direction)) {
                *c += weight * r * y;
            }
        }
        let more = rays.iter().filter(|r| r.3 > 1).count() as f64 / rays.len() as f64;
        Some((Harmonics { coefficients }, more))
    }

    /// r in a direction [–].
    pub fn radius(&self, direction: &Vec3) -> f64 {
        all(direction).iter().zip(&self.coefficients).map(|(y, c)| y * c).sum()
    }

    /// Σ c² of a degree.
    pub fn power(&self, l: usize) -> f64 {
        self.coefficients[l * l..(l + 1) * (l + 1)].iter().map(|c| c * c).sum()
    }

    /// Mirrored at the planes across the axes.
    pub fn mirrored(&self, [x, y, z]: [bool; 3]) -> Harmonics {
        let mut mirrored = self.clone();
        for l in 0..=DEGREE {
            for m in -(l as i64)..=(l as i64) {
                let odd = m.rem_euclid(2) == 1;
                let flips = [x && (odd != (m < 0)), y && m < 0, z && (l as i64 + m).rem_euclid(2) == 1];
                if flips.iter().filter(|f| **f).count() % 2 == 1 {
                    mirrored.coefficients[at(l, m)] *= -1.0;
                }
            }
        }
        mirrored
    }

    /// Between this (0) and another (1), with the power of each degree between theirs.
    pub fn between(&self, other: &Harmonics, t: f64) -> Harmonics {
        let mut mixed = Harmonics {
            coefficients: self
                .coefficients
                .iter()
                .zip(&other.coefficients)
                .map(|(a, b)| a + t * (b - a))
                .collect(),
        };
        for l in 3..=DEGREE {
            let (wanted, found) = (self.power(l) + t * (other.power(l) - self.power(l)), mixed.power(l));
            if found > 0.0 {
                let factor = (wanted / found).sqrt().min(3.0);
                mixed.coefficients[l * l..(l + 1) * (l + 1)].iter_mut().for_each(|c| *c *= factor);
            }
        }
        mixed
    }
}

/// Rows are the principal axes, the shortest inertia (the longest extent) last; right-handed.
fn principal(inertia: &Matrix3<f64>) -> Matrix3<f64> {
    let eigen = inertia.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
    let [a, b, _] = order.map(|k| eigen.eigenvectors.column(k).into_owned());
    Matrix3::from_rows(&[a.transpose(), b.transpose(), a.cross(&b).transpose()])
}

/// The farthest place of the surface in a direction from the centre of mass [m], and how often it is met.
fn farthest(stone: &Stone, direction: &Vec3) -> (f64, usize) {
    let (mut far, mut times) = (0.0f64, 0usize);
    for t in stone.mesh.triangles() {
        let [a, b, c] = t.map(|p| p - stone.moments.centre);
        let (u, v) = (b - a, c - a);
        let across = direction.cross(&v);
        let d = u.dot(&across);
        if d == 0.0 {
            continue;
        }
        let s = -a.dot(&across) / d;
        let q = (-a).cross(&u);
        let w = direction.dot(&q) / d;
        let along = v.dot(&q) / d;
        if s >= 0.0 && w >= 0.0 && s + w <= 1.0 && along > 0.0 {
            times += 1;
            far = far.max(along);
        }
    }
    // A ray in and out again meets it three times.
    (far, times.div_ceil(2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stone::tests::ball;

    /// An ellipsoid comes back from its harmonics, also mirrored.
    #[test]
    fn an_ellipsoid_has_its_radius_in_every_direction() {
        let mut mesh = ball(1.0, 4);
        mesh.vertices.iter_mut().for_each(|v| *v = Vec3::new(0.04 * v.x, 0.03 * v.y, 0.02 * v.z));
        let stone = Stone::new(&mesh, false).unwrap();
        let (found, more) = Harmonics::of(&stone).unwrap();
        assert_eq!(more, 0.0);
        let size = stone.moments.volume.cbrt();
        for d in [Vec3::x(), Vec3::y(), Vec3::z(), Vec3::new(1.0, 2.0, -0.5).normalize()] {
            // Principal axes: the shortest first.
            let wanted = 1.0 / ((d.x / 0.02).powi(2) + (d.y / 0.03).powi(2) + (d.z / 0.04).powi(2)).sqrt();
            for turned in [found.clone(), found.mirrored([true, false, true])] {
                let r = turned.radius(&d) * size;
                assert!((r / wanted - 1.0).abs() < 0.01, "{d}: {r}, not {wanted}");
            }
        }
    }

    /// Mirroring is that of the surface.
    #[test]
    fn mirroring_is_that_of_directions() {
        let coefficients = (0..COUNT).map(|k| ((k * 37 % 11) as f64 - 5.0) / 10.0).collect();
        let some = Harmonics { coefficients };
        let d = Vec3::new(0.3, -0.5, 0.7);
        for (k, flipped) in
            [(0, Vec3::new(-0.3, -0.5, 0.7)), (1, Vec3::new(0.3, 0.5, 0.7)), (2, Vec3::new(0.3, -0.5, -0.7))]
        {
            let mirrored = some.mirrored([0, 1, 2].map(|a| a == k));
            assert!((mirrored.radius(&d) - some.radius(&flipped)).abs() < 1e-12, "{k}");
            assert!((mirrored.power(7) - some.power(7)).abs() < 1e-12);
        }
    }
}
