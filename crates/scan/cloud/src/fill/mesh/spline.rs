//! The height of a surface over a plane, as smooth as its surroundings say.
//!
//! ```text
//! h(u, v) = b₀ + b₁u + b₂v + √κ q(u, v)·c + √θ t(u, v)       q = (u², uv, v²)
//! zᵢ = h(uᵢ, vᵢ) + noise of variance σ²/nᵢ                    zᵢ: mean of nᵢ points
//! ```
//!
//! c and t are random: c normal of variance σ², t the random function whose most likely course bends least (thin plate; Duchon 1977,
//! doi:10.1007/BFb0086566), of covariance σ² φ(r), φ = r² ln r. κ, θ and σ² are the most likely ones, whatever the plane b is (restricted
//! likelihood: Patterson & Thompson 1971, doi:10.1093/biomet/58.3.545; for splines Wahba 1985, doi:10.1214/aos/1176349743). Without evidence for
//! more, the surface is a plane; with evidence for curvature alone, a quadratic. Both average the noise of all points around a hole, where a
//! plate of fixed stiffness follows that at its rim.

use geom::Vec3;
use nalgebra::{Cholesky, DMatrix, DVector, Matrix3, Vector3};

/// θ, and κ, that are tried [–].
const BENT: [f64; 9] = [0.0, 1e-2, 0.1, 1.0, 1e1, 1e2, 1e3, 1e4, 1e5];
const CURVED: [f64; 5] = [0.0, 0.1, 1e1, 1e3, 1e5];

/// Mean of some points of the surface.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Sample {
    /// u, v and height [m].
    pub position: Vec3,
    /// How many points.
    pub count: f64,
}

/// How much the surface bends, in terms of its noise.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bending {
    theta: f64,
    kappa: f64,
    units: Units,
}

/// A height over a plane.
#[derive(Debug, Clone)]
pub(crate) struct Spline {
    bending: Bending,
    centres: Vec<[f64; 2]>,
    /// One a centre, then b₀, b₁, b₂.
    weights: DVector<f64>,
}

/// Where u and v are counted from, and in what [m].
#[derive(Debug, Clone, Copy, PartialEq)]
struct Units {
    middle: [f64; 2],
    length: f64,
}

impl Units {
    /// Those in which samples lie between −1 and 1.
    fn of(samples: &[Sample]) -> Units {
        let positions: Vec<Vec3> = samples.iter().map(|s| s.position).collect();
        let (lo, hi) = geom::grid::bounds(&positions);
        let middle = 0.5 * (lo + hi);
        Units { middle: [middle.x, middle.y], length: (0.5 * (hi - lo).xy().amax()).max(f64::MIN_POSITIVE) }
    }

    fn at(&self, u: f64, v: f64) -> [f64; 2] {
        [(u - self.middle[0]) / self.length, (v - self.middle[1]) / self.length]
    }

    fn all(&self, samples: &[Sample]) -> Vec<[f64; 2]> {
        samples.iter().map(|s| self.at(s.position.x, s.position.y)).collect()
    }
}

impl Bending {
    /// The most likely one; none for fewer than eight samples.
    fn of(samples: &[Sample]) -> Option<Bending> {
        let n = samples.len();
        if n < 8 {
            return None;
        }
        let units = Units::of(samples);
        let centres = units.all(samples);
        // What no plane explains: the rest of an orthogonal basis that begins with the planes.
        let planes = DMatrix::from_fn(n, 3, |i, k| plane(centres[i])[k]).qr();
        let rest = |mut of: DMatrix<f64>| {
            planes.q_tr_mul(&mut of);
            of.rows(3, n - 3).into_owned()
        };
        let both = |of: DMatrix<f64>| rest(rest(of).transpose());
        let noise = both(DMatrix::from_diagonal(&noise(samples)));
        let bent = both(DMatrix::from_fn(n, n, |i, j| plate(centres[i], centres[j])));
        let curved = rest(DMatrix::from_fn(n, 3, |i, k| quadratic(centres[i])[k]));
        let heights = rest(DMatrix::from_fn(n, 1, |i, _| samples[i].position.z / units.length));
        let mut best: Option<(f64, Bending)> = None;
        for theta in BENT {
            // One factor of the covariance without curvature serves all κ, which add three directions (Woodbury 1950).
            let Some(factor) = Cholesky::new(&noise + &bent * theta).map(Cholesky::unpack) else { continue };
            let spread: f64 = factor.diagonal().iter().map(|d| libm::log(*d)).sum();
            let (Some(heights), Some(curved)) =
                (factor.solve_lower_triangular(&heights), factor.solve_lower_triangular(&curved))
            else {
                continue;
            };
            let overlap = Matrix3::from_fn(|i, j| curved.column(i).dot(&curved.column(j)));
            let along = Vector3::from_fn(|i, _| curved.column(i).dot(&heights.column(0)));
            for kappa in CURVED {
                let Some(more) = Cholesky::new(Matrix3::identity() + overlap * kappa) else { continue };
                let square = heights.norm_squared() - kappa * along.dot(&more.solve(&along));
                let more: f64 = more.l_dirty().diagonal().iter().map(|d| libm::log(*d)).sum();
                let likelihood = -0.5 * (n - 3) as f64 * libm::log(square) - spread - more;
                if likelihood.is_finite() && best.is_none_or(|(most, _)| likelihood > most) {
                    best = Some((likelihood, Bending { theta, kappa, units }));
                }
            }
        }
        best.map(|(_, bending)| bending)
    }

    fn covariance(&self, p: [f64; 2], q: [f64; 2]) -> f64 {
        let bent = if self.theta > 0.0 { self.theta * plate(p, q) } else { 0.0 };
        let [p, q] = [quadratic(p), quadratic(q)];
        bent + self.kappa * (p[0] * q[0] + p[1] * q[1] + p[2] * q[2])
    }
}

impl Spline {
    /// The most likely one through samples; none where they do not determine one. Costs the cube of their number.
    pub fn fit(samples: &[Sample]) -> Option<Spline> {
        let n = samples.len();
        let bending = Bending::of(samples)?;
        let centres = bending.units.all(samples);
        let mut a = DMatrix::zeros(n + 3, n + 3);
        let noise = noise(samples);
        for i in 0..n {
            for j in 0..n {
                a[(i, j)] = bending.covariance(centres[i], centres[j]);
            }
            a[(i, i)] += noise[i];
            for (k, value) in plane(centres[i]).into_iter().enumerate() {
                a[(i, n + k)] = value;
                a[(n + k, i)] = value;
            }
        }
        let heights = samples.iter().map(|s| s.position.z).chain([0.0; 3]);
        let weights = a.lu().solve(&DVector::from_iterator(n + 3, heights))?;
        weights.iter().all(|w| w.is_finite()).then_some(Spline { bending, centres, weights })
    }

    /// Height [m] at a position [m].
    pub fn height(&self, u: f64, v: f64) -> f64 {
        let at = self.bending.units.at(u, v);
        let of = |(c, w): (&[f64; 2], &f64)| w * self.bending.covariance(*c, at);
        let bent: f64 = self.centres.iter().zip(self.weights.iter()).map(of).sum();
        let n = self.centres.len();
        bent + plane(at).iter().enumerate().map(|(k, value)| value * self.weights[n + k]).sum::<f64>()
    }
}

/// Variances of the samples, in that of a point.
fn noise(samples: &[Sample]) -> DVector<f64> {
    DVector::from_iterator(samples.len(), samples.iter().map(|s| s.count.recip()))
}

fn plane([u, v]: [f64; 2]) -> [f64; 3] {
    [1.0, u, v]
}

fn quadratic([u, v]: [f64; 2]) -> [f64; 3] {
    [u * u, u * v, v * v]
}

/// φ of the thin plate.
fn plate(p: [f64; 2], q: [f64; 2]) -> f64 {
    let r2 = (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2);
    if r2 > 0.0 { 0.5 * r2 * libm::log(r2) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Means of points of a ring around a hole of radius 10, 4 wide, with noise of 0.2 a point.
    fn ring(height: impl Fn(f64, f64) -> f64) -> Vec<Sample> {
        let chance = |i: u32| f64::from(i.wrapping_mul(2_654_435_769) ^ (i >> 3)) / f64::from(u32::MAX);
        let noise = |i: u32| 0.1 * ((0..12).map(|k| chance(12 * i + k)).sum::<f64>() - 6.0);
        let sample = |i: u32| {
            let (turn, r) = (f64::from(i) * 0.17, 11.0 + f64::from(i % 4));
            let (u, v) = (r * turn.cos(), r * turn.sin());
            Sample { position: Vec3::new(u, v, height(u, v) + noise(i)), count: 4.0 }
        };
        (0..150).map(sample).collect()
    }

    /// Root mean square over the hole.
    fn error(spline: &Spline, height: impl Fn(f64, f64) -> f64) -> f64 {
        let places = (0..400).map(|i| (f64::from(i % 20) - 9.5, f64::from(i / 20) - 9.5));
        let inside: Vec<(f64, f64)> = places.filter(|(u, v)| u.hypot(*v) < 10.0).collect();
        let square = |&(u, v): &(f64, f64)| (spline.height(u, v) - height(u, v)).powi(2);
        (inside.iter().map(square).sum::<f64>() / inside.len() as f64).sqrt()
    }

    #[test]
    fn a_plane_is_spanned_by_a_plane() {
        let truth = |u: f64, v: f64| 1.0 + 0.2 * u - 0.1 * v;
        let spline = Spline::fit(&ring(truth)).unwrap();
        // 150 means of 0.1 leave 0.008 of a constant.
        assert!(error(&spline, truth) < 0.03, "{} {:?}", error(&spline, truth), spline.bending);
        assert_eq!(spline.bending.theta, 0.0);
    }

    #[test]
    fn a_cylinder_is_spanned_by_its_curvature() {
        let truth = |u: f64, _: f64| 50.0 - (2500.0 - u * u).sqrt();
        let spline = Spline::fit(&ring(truth)).unwrap();
        assert!(spline.bending.kappa > 0.0);
        assert!(error(&spline, truth) < 0.15, "{} {:?}", error(&spline, truth), spline.bending);
    }

    #[test]
    fn waves_are_followed_to_the_rim() {
        let truth = |u: f64, v: f64| 2.0 * (0.3 * u).sin() * (0.2 * v).cos();
        let samples = ring(truth);
        let spline = Spline::fit(&samples).unwrap();
        assert!(spline.bending.theta > 0.0);
        let off = samples
            .iter()
            .map(|s| (spline.height(s.position.x, s.position.y) - truth(s.position.x, s.position.y)).powi(2));
        let rms = (off.sum::<f64>() / samples.len() as f64).sqrt();
        assert!(rms < 0.15, "{rms}");
    }

    #[test]
    fn samples_that_count_more_weigh_more() {
        // Half of them lie on 0 and count a hundred times as much as the others, at 1.
        let samples: Vec<Sample> = ring(|_, _| 0.0)
            .into_iter()
            .enumerate()
            .map(|(i, s)| {
                let heavy = i % 8 < 4;
                let z = if heavy { 0.0 } else { 1.0 };
                Sample {
                    position: Vec3::new(s.position.x, s.position.y, z),
                    count: if heavy { 100.0 } else { 1.0 },
                }
            })
            .collect();
        let height = Spline::fit(&samples).unwrap().height(0.0, 0.0);
        assert!(height.abs() < 0.1, "{height}");
    }

    #[test]
    fn too_few_samples_tell_nothing() {
        assert!(Spline::fit(&ring(|_, _| 0.0)[..7]).is_none());
        // All at one place, on one line.
        let line: Vec<Sample> =
            (0..20).map(|i| Sample { position: Vec3::new(f64::from(i), 0.0, 0.0), count: 1.0 }).collect();
        assert!(Spline::fit(&line).is_none_or(|s| s.height(3.0, 1.0).is_finite()));
    }
}
