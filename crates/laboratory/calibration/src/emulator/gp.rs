//! A Gaussian process with one length a parameter, a trend and noise.
//!
//! ```text
//! y(z) = h(z)ᵀ β + f(z) + ε,   h = (1, z) …       k(z, z') = σ² (1 + √5 r + 5r²/3) exp(−√5 r),  r² = Σ ((z_i − z'_i)/ℓ_i)²
//! K = σ² (R + g I)                              Var ε = σ² g
//! β = (Hᵀ K⁻¹ H)⁻¹ Hᵀ K⁻¹ y                      m(z) = hᵀβ + kᵀ K⁻¹ (y − Hβ)
//! v(z) = σ² − kᵀ K⁻¹ k + uᵀ (Hᵀ K⁻¹ H)⁻¹ u,      u = h − Hᵀ K⁻¹ k
//! ```
//!
//! Rasmussen & Williams (2006), Gaussian Processes for Machine Learning, eqs. 2.39–2.45 (trend), 4.17 (Matérn 5/2). σ² is the maximum for given ℓ
//! and g. ℓ and g maximise the restricted likelihood times wide log-normal priors, by Rprop (Riedmiller & Braun 1993,
//! doi:10.1109/ICNN.1993.298623).
//!
//! Own code: the maintained crate (egobox-gp 0.37) takes the nugget g as a given number, but here g is the scatter of specimens, which is not known
//! before the fit; a process without it would follow the scatter. That crate also adds 34 packages to the 305 of the lock file. friedrich
//! has one length for all parameters.

use super::likelihood::{Scatter, Solved, distance, loss, matern, row, solve};
use super::rprop;
use super::trend::{Trend, basis};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Points that the lengths are fitted to, at most.
const MOST_FITTED: usize = 120;
/// Ranges of ln ℓ and ln g.
const LENGTHS: [f64; 2] = [-2.5, 4.0];
const NOISES: [f64; 2] = [-18.0, 2.0];

/// ln ℓ of each parameter, then ln g.
pub(crate) type Logs = Vec<f64>;

/// A fitted process.
#[derive(Clone)]
pub(crate) struct Gp {
    inputs: DMatrix<f64>,
    pub trend: Trend,
    lengths: Vec<f64>,
    pub logs: Logs,
    /// σ².
    scale: f64,
    /// σ² g.
    pub noise: f64,
    chol: Cholesky<f64, Dyn>,
    /// K⁻¹ (y − Hβ) and β, in units of σ².
    alpha: DVector<f64>,
    beta: DVector<f64>,
    /// L⁻¹ H, and the factor of Hᵀ R⁻¹ H.
    white: DMatrix<f64>,
    along: Cholesky<f64, Dyn>,
}

/// Mean, and variance of the mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Prediction {
    pub mean: f64,
    pub variance: f64,
}

/// How far a point is from what the others say of it, and the deviation that they expect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LeftOut {
    pub error: f64,
    pub deviation: f64,
}

impl LeftOut {
    /// The error over its deviation.
    pub fn scaled(&self) -> f64 {
        self.error / self.deviation
    }
}

impl Gp {
    /// Fits a process to the rows of `inputs`, whose values have this scatter; `start` are the lengths of an earlier fit.
    pub fn fit(
        inputs: &DMatrix<f64>,
        y: &DVector<f64>,
        (scatter, start): (Scatter, Option<&Logs>),
        trend: Trend,
    ) -> Option<Gp> {
        let (n, d) = (inputs.nrows(), trend.parameters(inputs.ncols()));
        let few: Vec<usize> = if n <= MOST_FITTED {
            (0..n).collect()
        } else {
            (0..MOST_FITTED).map(|k| k * n / MOST_FITTED).collect()
        };
        let (some, some_y) = (inputs.select_rows(&few), y.select_rows(&few));
        let h = basis(&some, trend);
        let range: Vec<[f64; 2]> = (0..=d).map(|k| if k < d { LENGTHS } else { NOISES }).collect();
        let fresh: Logs = [vec![0.0; d], vec![-7.0]].concat();
        let noisy: Logs = [vec![0.7; d], vec![-1.5]].concat();
        let starts = match start {
            Some(start) if start.len() == d + 1 => vec![(start.clone(), 20)],
            _ => vec![(fresh, 45), (noisy, 45)],
        };
        let of = |logs: &[f64]| loss(&some, &some_y, &h, logs, scatter);
        let found = starts.iter().filter_map(|(start, steps)| rprop::least(&of, start, &range, *steps));
        let (_, logs) = found.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Gp::with(inputs, y, logs, trend)
    }

    fn with(inputs: &DMatrix<f64>, y: &DVector<f64>, logs: Logs, trend: Trend) -> Option<Gp> {
        let d = logs.len() - 1;
        let s = solve(inputs, y, &basis(inputs, trend), &logs)?;
        let lengths = logs[..d].iter().map(|l| libm::exp(*l)).collect();
        let noise = s.scale * libm::exp(logs[d]);
        let Solved { chol, white, along, beta, alpha, scale } = s;
        Some(Gp {
            inputs: inputs.clone(),
            trend,
            lengths,
            logs,
            scale,
            noise,
            chol,
            alpha,
            beta,
            white,
            along,
        })
    }

    fn basis_at(&self, z: &[f64]) -> DVector<f64> {
        DVector::from_vec(self.trend.row(z))
    }

    /// Mean and variance, R⁻½ k, and the part of the trend.
    fn parts(&self, z: &[f64]) -> (Prediction, DVector<f64>, DVector<f64>) {
        let n = self.inputs.nrows();
        let mut k = DVector::from_fn(n, |i, _| {
            matern(distance(row(&self.inputs, i), z.iter().copied(), &self.lengths))
        });
        let h = self.basis_at(z);
        let mean = h.dot(&self.beta) + k.dot(&self.alpha);
        self.chol.l_dirty().solve_lower_triangular_mut(&mut k);
        let mut u = h - self.white.tr_mul(&k);
        self.along.l_dirty().solve_lower_triangular_mut(&mut u);
        let variance = self.scale * (1.0 - k.norm_squared() + u.norm_squared()).max(0.0);
        (Prediction { mean, variance }, k, u)
    }

    /// Mean and variance, and a vector from which covariances follow.
    pub fn project(&self, z: &[f64]) -> (Prediction, DVector<f64>) {
        let (prediction, k, u) = self.parts(z);
        let (n, p) = (k.len(), u.len());
        let mut both = k.resize_vertically(n + p, 0.0);
        both.rows_mut(n, p).copy_from(&u);
        (prediction, both)
    }

    /// Mean and variance at a point.
    pub fn predict(&self, z: &[f64]) -> Prediction {
        self.parts(z).0
    }

    /// For each point: its distance from what the others say (eqs. 5.10–5.12, with the trend).
    pub fn left_out(&self) -> Option<Vec<LeftOut>> {
        let along = self.chol.l_dirty().tr_solve_lower_triangular(&self.white)?;
        let q = self.chol.inverse() - &along * self.along.solve(&along.transpose());
        let off = |i: usize| {
            let own = q[(i, i)].max(1e-300);
            LeftOut { error: self.alpha[i] / own, deviation: (self.scale / own).sqrt() }
        };
        Some((0..self.alpha.len()).map(off).collect())
    }

    /// Standard deviation of the mean over the points.
    pub fn deviation(&self) -> f64 {
        let n = self.inputs.nrows() as f64;
        let means: Vec<f64> =
            (0..self.inputs.nrows()).map(|i| self.mean(&row(&self.inputs, i).collect::<Vec<_>>())).collect();
        let mean = means.iter().sum::<f64>() / n;
        (means.iter().map(|m| (m - mean) * (m - mean)).sum::<f64>() / n).sqrt()
    }

    /// Multiplies variance and noise.
    pub fn rescale(&mut self, factor: f64) {
        self.scale *= factor;
        self.noise *= factor;
    }

    /// The mean at a point.
    pub fn mean(&self, z: &[f64]) -> f64 {
        let k = (0..self.inputs.nrows()).map(|i| {
            matern(distance(row(&self.inputs, i), z.iter().copied(), &self.lengths)) * self.alpha[i]
        });
        self.basis_at(z).dot(&self.beta) + k.sum::<f64>()
    }

    /// Covariance of the values at two points, from their projections.
    pub fn covariance(&self, a: (&[f64], &DVector<f64>), b: (&[f64], &DVector<f64>)) -> f64 {
        let n = self.inputs.nrows();
        let prior = matern(distance(a.0.iter().copied(), b.0.iter().copied(), &self.lengths));
        let known = a.1.rows(0, n).dot(&b.1.rows(0, n));
        let p = a.1.len() - n;
        self.scale * (prior - known + a.1.rows(n, p).dot(&b.1.rows(n, p)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::likelihood::tests::points;
    use super::*;
    use geom::random::{generator, unit};

    #[test]
    fn a_smooth_function_is_learnt_with_its_uncertainty() {
        let f = |z: &[f64]| libm::exp(z[0]) * libm::cos(3.0 * z[1]) + 0.0 * z[2];
        let x = points(60, 3, 2);
        let y = DVector::from_fn(60, |i, _| f(&[x[(i, 0)], x[(i, 1)], x[(i, 2)]]));
        let gp = Gp::fit(&x, &y, (Scatter::None, None), Trend::Linear).unwrap();
        let test = points(200, 3, 3);
        let mut inside = 0;
        for i in 0..200 {
            let z: Vec<f64> = row(&test, i).collect();
            let p = gp.predict(&z);
            assert!((p.mean - f(&z)).abs() < 0.05 && (p.mean - gp.mean(&z)).abs() < 1e-9, "{z:?}");
            inside += usize::from((p.mean - f(&z)).abs() <= 2.0 * (p.variance + gp.noise).sqrt() + 1e-9);
        }
        assert!(inside >= 180, "{inside} of 200");
        assert!(gp.logs[2] > 1.5, "a parameter without influence has a long length: {:?}", gp.logs);
    }

    /// Thirty points of six parameters that scatter by 1: how much of the scatter is taken for noise?
    #[test]
    fn few_points_that_scatter_are_not_interpolated() {
        let taken = |scatter: Scatter| -> Vec<f64> {
            let of = |seed: u64| {
                let (x, mut random) = (points(30, 6, 100 + seed), generator(seed, 2, 0));
                let mut normal = || (0..12).map(|_| unit(&mut random)).sum::<f64>() - 6.0;
                let y = DVector::from_fn(30, |i, _| 4.0 * x[(i, 0)] + normal());
                Gp::fit(&x, &y, (scatter, None), Trend::Linear).unwrap().noise.sqrt()
            };
            (0..12).map(of).collect()
        };
        let (known, unknown) = (taken(Scatter::About(1.0)), taken(Scatter::None));
        assert!(known.iter().all(|n| *n > 0.4 && *n < 1.6), "{known:?}");
        assert!(unknown.iter().any(|n| *n < 0.1), "nothing need be known: {unknown:?}");
    }

    #[test]
    fn noise_is_found_and_the_mean_is_smooth() {
        let x = points(120, 1, 4);
        let mut random = generator(5, 1, 0);
        // Twelve uniform numbers: deviation 1.
        let mut normal = || (0..12).map(|_| unit(&mut random)).sum::<f64>() - 6.0;
        let y = DVector::from_fn(120, |i, _| 3.0 * x[(i, 0)] * x[(i, 0)] + 0.2 * normal());
        let gp = Gp::fit(&x, &y, (Scatter::None, None), Trend::Linear).unwrap();
        assert!((gp.noise.sqrt() - 0.2).abs() < 0.04, "{}", gp.noise.sqrt());
        assert!((gp.mean(&[0.5]) - 0.75).abs() < 0.1, "{}", gp.mean(&[0.5]));
        // The covariance of a point with itself is its variance.
        let (p, v) = gp.project(&[0.3]);
        assert!((gp.covariance((&[0.3], &v), (&[0.3], &v)) - p.variance).abs() < 1e-12);
    }
}
