//! A Gaussian process with one length a parameter, a linear trend and noise.
//!
//! ```text
//! y(z) = h(z)ᵀ β + f(z) + ε,   h = (1, z)        k(z, z') = σ² (1 + √5 r + 5r²/3) exp(−√5 r),  r² = Σ ((z_i − z'_i)/ℓ_i)²
//! K = σ² (R + g I)                              Var ε = σ² g
//! β = (Hᵀ K⁻¹ H)⁻¹ Hᵀ K⁻¹ y                      m(z) = hᵀβ + kᵀ K⁻¹ (y − Hβ)
//! v(z) = σ² − kᵀ K⁻¹ k + uᵀ (Hᵀ K⁻¹ H)⁻¹ u,      u = h − Hᵀ K⁻¹ k
//! ```
//!
//! Rasmussen & Williams (2006), Gaussian Processes for Machine Learning, eqs. 2.39–2.45 (trend), 4.17 (Matérn 5/2), 5.9 (gradient). σ² is the
//! maximum for given ℓ and g. ℓ and g maximise the restricted likelihood times wide log-normal priors, by Rprop (Riedmiller & Braun 1993,
//! doi:10.1109/ICNN.1993.298623).
//!
//! Own code, since the maintained crate (egobox-gp) brings ndarray, linfa and their trees, and draws its starts in parallel; friedrich has one
//! length for all parameters.

use super::rprop;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Points that the lengths are fitted to, at most.
const MOST_FITTED: usize = 120;
const SQRT5: f64 = 2.236_067_977_499_79;
/// Ranges of ln ℓ and ln g.
const LENGTHS: [f64; 2] = [-2.5, 4.0];
const NOISES: [f64; 2] = [-18.0, 2.0];
/// Mean and deviation of the priors of ln ℓ and ln g.
const LENGTH_PRIOR: [f64; 2] = [0.3, 1.5];
const NOISE_PRIOR: [f64; 2] = [-9.0, 5.0];

/// ln ℓ of each parameter, then ln g.
pub(crate) type Logs = Vec<f64>;

/// A fitted process.
#[derive(Clone)]
pub(crate) struct Gp {
    inputs: DMatrix<f64>,
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
    trend: Cholesky<f64, Dyn>,
}

/// Mean, and variance of the mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Prediction {
    pub mean: f64,
    pub variance: f64,
}

fn matern(r: f64) -> f64 {
    (1.0 + SQRT5 * r + 5.0 / 3.0 * r * r) * libm::exp(-SQRT5 * r)
}

fn distance(a: impl Iterator<Item = f64>, b: impl Iterator<Item = f64>, lengths: &[f64]) -> f64 {
    a.zip(b).zip(lengths).map(|((a, b), l)| ((a - b) / l).powi(2)).sum::<f64>().sqrt()
}

fn row(inputs: &DMatrix<f64>, k: usize) -> impl Iterator<Item = f64> + '_ {
    inputs.row(k).into_iter().copied()
}

/// Rows (1, z), or 1 where there are few points.
fn basis(inputs: &DMatrix<f64>, linear: bool) -> DMatrix<f64> {
    let p = if linear { inputs.ncols() + 1 } else { 1 };
    DMatrix::from_fn(inputs.nrows(), p, |i, j| if j == 0 { 1.0 } else { inputs[(i, j - 1)] })
}

fn correlation(inputs: &DMatrix<f64>, lengths: &[f64], g: f64) -> DMatrix<f64> {
    let n = inputs.nrows();
    let mut r = DMatrix::identity(n, n) * (1.0 + g + 1e-10);
    for i in 0..n {
        for j in 0..i {
            let value = matern(distance(row(inputs, i), row(inputs, j), lengths));
            (r[(i, j)], r[(j, i)]) = (value, value);
        }
    }
    r
}

/// What a likelihood needs of one set of ℓ and g.
struct Solved {
    chol: Cholesky<f64, Dyn>,
    white: DMatrix<f64>,
    trend: Cholesky<f64, Dyn>,
    beta: DVector<f64>,
    alpha: DVector<f64>,
    scale: f64,
}

fn solve(inputs: &DMatrix<f64>, y: &DVector<f64>, h: &DMatrix<f64>, logs: &[f64]) -> Option<Solved> {
    let d = inputs.ncols();
    let lengths: Vec<f64> = logs[..d].iter().map(|l| libm::exp(*l)).collect();
    let chol = Cholesky::new(correlation(inputs, &lengths, libm::exp(logs[d])))?;
    let white = chol.l_dirty().solve_lower_triangular(h)?;
    let trend = Cholesky::new(white.transpose() * &white)?;
    let y_white = chol.l_dirty().solve_lower_triangular(y)?;
    let beta = trend.solve(&(white.transpose() * &y_white));
    let rest = y_white - &white * &beta;
    let free = (y.len() - h.ncols()).max(1) as f64;
    let scale = (rest.norm_squared() / free).max(1e-300);
    let alpha = chol.l_dirty().tr_solve_lower_triangular(&rest)?;
    Some(Solved { chol, white, trend, beta, alpha, scale })
}

/// Minus the logarithm of likelihood times prior, and its gradient.
fn loss(inputs: &DMatrix<f64>, y: &DVector<f64>, h: &DMatrix<f64>, logs: &[f64]) -> Option<(f64, Vec<f64>)> {
    let (n, d) = (inputs.nrows(), inputs.ncols());
    let s = solve(inputs, y, h, logs)?;
    let log_det =
        |c: &Cholesky<f64, Dyn>| 2.0 * c.l_dirty().diagonal().iter().map(|v| libm::log(*v)).sum::<f64>();
    let free = (n - h.ncols()).max(1) as f64;
    let mut value = 0.5 * (log_det(&s.chol) + log_det(&s.trend) + free * libm::log(s.scale));
    // R⁻¹ without its part along the trend: d(loss)/dR = ½ (Q − α αᵀ/σ²).
    let inverse = s.chol.inverse();
    let along = s.chol.l_dirty().tr_solve_lower_triangular(&s.white)?;
    let q = inverse - &along * s.trend.solve(&along.transpose());
    let mut gradient = vec![0.0; d + 1];
    let lengths: Vec<f64> = logs[..d].iter().map(|l| libm::exp(*l)).collect();
    for i in 0..n {
        gradient[d] += 0.5 * (q[(i, i)] - s.alpha[i] * s.alpha[i] / s.scale) * libm::exp(logs[d]);
        for j in 0..i {
            let r = distance(row(inputs, i), row(inputs, j), &lengths);
            // dk/d ln ℓ = 5/3 (1 + √5 r) exp(−√5 r) (Δ/ℓ)²; twice for both triangles.
            let slope = 5.0 / 3.0 * (1.0 + SQRT5 * r) * libm::exp(-SQRT5 * r);
            let factor = (q[(i, j)] - s.alpha[i] * s.alpha[j] / s.scale) * slope;
            for (k, l) in lengths.iter().enumerate() {
                gradient[k] += factor * ((inputs[(i, k)] - inputs[(j, k)]) / l).powi(2);
            }
        }
    }
    for (k, log) in logs.iter().enumerate() {
        let [mean, deviation] = if k < d { LENGTH_PRIOR } else { NOISE_PRIOR };
        let off = (log - mean) / deviation;
        value += 0.5 * off * off;
        gradient[k] += off / deviation;
    }
    value.is_finite().then_some((value, gradient))
}

impl Gp {
    /// Fits a process to the rows of `inputs`; `start` are the lengths of an earlier fit.
    pub fn fit(inputs: &DMatrix<f64>, y: &DVector<f64>, start: Option<&Logs>) -> Option<Gp> {
        let linear = inputs.nrows() >= 2 * inputs.ncols() + 4;
        Gp::fit_with(inputs, y, start, linear)
    }

    /// The same with a trend that is linear, or one constant.
    pub fn fit_with(
        inputs: &DMatrix<f64>,
        y: &DVector<f64>,
        start: Option<&Logs>,
        linear: bool,
    ) -> Option<Gp> {
        let (n, d) = (inputs.nrows(), inputs.ncols());
        let few: Vec<usize> = if n <= MOST_FITTED {
            (0..n).collect()
        } else {
            (0..MOST_FITTED).map(|k| k * n / MOST_FITTED).collect()
        };
        let (some, some_y) = (inputs.select_rows(&few), y.select_rows(&few));
        let h = basis(&some, linear);
        let range: Vec<[f64; 2]> = (0..=d).map(|k| if k < d { LENGTHS } else { NOISES }).collect();
        let fresh: Logs = [vec![0.0; d], vec![-7.0]].concat();
        let noisy: Logs = [vec![0.7; d], vec![-1.5]].concat();
        let starts = match start {
            Some(start) if start.len() == d + 1 => vec![(start.clone(), 20)],
            _ => vec![(fresh, 45), (noisy, 45)],
        };
        let of = |logs: &[f64]| loss(&some, &some_y, &h, logs);
        let found = starts.iter().filter_map(|(start, steps)| rprop::least(&of, start, &range, *steps));
        let (_, logs) = found.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Gp::with(inputs, y, logs, linear)
    }

    fn with(inputs: &DMatrix<f64>, y: &DVector<f64>, logs: Logs, linear: bool) -> Option<Gp> {
        let d = inputs.ncols();
        let s = solve(inputs, y, &basis(inputs, linear), &logs)?;
        let lengths = logs[..d].iter().map(|l| libm::exp(*l)).collect();
        let noise = s.scale * libm::exp(logs[d]);
        let Solved { chol, white, trend, beta, alpha, scale } = s;
        Some(Gp { inputs: inputs.clone(), lengths, logs, scale, noise, chol, alpha, beta, white, trend })
    }

    fn basis_at(&self, z: &[f64]) -> DVector<f64> {
        DVector::from_fn(self.beta.len(), |j, _| if j == 0 { 1.0 } else { z[j - 1] })
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
        self.trend.l_dirty().solve_lower_triangular_mut(&mut u);
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

    /// For each point: its distance from what the others say, over the deviation of that (eqs. 5.10–5.12, with the trend).
    pub fn left_out(&self) -> Option<Vec<f64>> {
        let along = self.chol.l_dirty().tr_solve_lower_triangular(&self.white)?;
        let q = self.chol.inverse() - &along * self.trend.solve(&along.transpose());
        let off = |i: usize| self.alpha[i] / (q[(i, i)].max(1e-300) * self.scale).sqrt();
        Some((0..self.alpha.len()).map(off).collect())
    }

    /// Whether its trend is linear.
    pub fn is_linear(&self) -> bool {
        self.beta.len() > 1
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
    use super::*;
    use geom::random::{generator, unit};

    fn points(n: usize, d: usize, seed: u64) -> DMatrix<f64> {
        let mut random = generator(seed, 1, 0);
        DMatrix::from_fn(n, d, |_, _| unit(&mut random))
    }

    #[test]
    fn gradient_of_the_likelihood_is_its_slope() {
        let x = points(18, 2, 1);
        let y = DVector::from_fn(18, |i, _| libm::sin(5.0 * x[(i, 0)]) + x[(i, 1)] * x[(i, 1)]);
        let h = basis(&x, true);
        let at = [-0.5, 0.4, -3.0];
        let (_, gradient) = loss(&x, &y, &h, &at).unwrap();
        for k in 0..3 {
            let step = |s: f64| {
                let mut logs = at;
                logs[k] += s;
                loss(&x, &y, &h, &logs).unwrap().0
            };
            let slope = (step(1e-5) - step(-1e-5)) / 2e-5;
            assert!(
                (gradient[k] - slope).abs() < 1e-5 * slope.abs().max(1.0),
                "{k}: {} {slope}",
                gradient[k]
            );
        }
    }

    #[test]
    fn a_smooth_function_is_learnt_with_its_uncertainty() {
        let f = |z: &[f64]| libm::exp(z[0]) * libm::cos(3.0 * z[1]) + 0.0 * z[2];
        let x = points(60, 3, 2);
        let y = DVector::from_fn(60, |i, _| f(&[x[(i, 0)], x[(i, 1)], x[(i, 2)]]));
        let gp = Gp::fit(&x, &y, None).unwrap();
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

    #[test]
    fn noise_is_found_and_the_mean_is_smooth() {
        let x = points(120, 1, 4);
        let mut random = generator(5, 1, 0);
        // Twelve uniform numbers: deviation 1.
        let mut normal = || (0..12).map(|_| unit(&mut random)).sum::<f64>() - 6.0;
        let y = DVector::from_fn(120, |i, _| 3.0 * x[(i, 0)] * x[(i, 0)] + 0.2 * normal());
        let gp = Gp::fit(&x, &y, None).unwrap();
        assert!((gp.noise.sqrt() - 0.2).abs() < 0.04, "{}", gp.noise.sqrt());
        assert!((gp.mean(&[0.5]) - 0.75).abs() < 0.1, "{}", gp.mean(&[0.5]));
        // The covariance of a point with itself is its variance.
        let (p, v) = gp.project(&[0.3]);
        assert!((gp.covariance((&[0.3], &v), (&[0.3], &v)) - p.variance).abs() < 1e-12);
    }
}
