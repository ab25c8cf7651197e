//! A Gaussian process with one length a parameter, a trend and noise.
//!
//! ```text
//! y(z) = h(z)ᵀ β + f(z) + ε,   h = (1, z) …       k(z, z') = σ² (1 + √5 r + 5r²/3) exp(−√5 r),  r² = Σ ((z_i − z'_i)/ℓ_i)²
//! K = σ² (R + g I)                              Var ε = σ² g
//! β = (Hᵀ K⁻¹ H)⁻¹ Hᵀ K⁻¹ y                      m(z) = hᵀβ + kᵀ K⁻¹ (y − Hβ)
//! v(z) = σ² − kᵀ K⁻¹ k + uᵀ (Hᵀ K⁻¹ H)⁻¹ u,      u = h − Hᵀ K⁻¹ k
//! ```
//!
//! Rasmussen & Williams (2006), Gaussian Processes for Machine Learning, eqs. 2.39–2.45 (trend), 4.17 (Matérn 5/2), 5.9 (gradient). σ² is the
//! maximum for given ℓ and g. ℓ and g maximise the restricted likelihood times wide log-normal priors, by Rprop (Riedmiller & Braun 1993,
//! doi:10.1109/ICNN.1993.298623).
//!
//! Where runs scatter, as specimens do, short lengths and noise explain few points alike. What is known of the noise decides ([`Scatter`]).
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
/// Mean and deviation of the prior of ln ℓ, and of that of ln g for runs without chance and with chance.
const LENGTH_PRIOR: [f64; 2] = [0.3, 1.0];
const NOISE_PRIOR: [f64; 2] = [-9.0, 5.0];
const CHANCE_PRIOR: [f64; 2] = [-4.0, 3.0];
/// Deviation of ln Var ε from what is expected.
const EXPECTED: f64 = 1.5;

/// ln ℓ of each parameter, then ln g.
pub(crate) type Logs = Vec<f64>;

/// What is known of ε before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Scatter {
    /// The same point gives the same value.
    None,
    /// There is chance in it.
    Unknown,
    /// Var ε is about this, by a factor of e^1.5 or so.
    About(f64),
}

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

fn matern(r: f64) -> f64 {
    (1.0 + SQRT5 * r + 5.0 / 3.0 * r * r) * libm::exp(-SQRT5 * r)
}

fn distance(a: impl Iterator<Item = f64>, b: impl Iterator<Item = f64>, lengths: &[f64]) -> f64 {
    a.zip(b).zip(lengths).map(|((a, b), l)| ((a - b) / l).powi(2)).sum::<f64>().sqrt()
}

/// What the mean follows far from all points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Trend {
    /// h = 1: where there are few points.
    Constant,
    /// h = (1, z).
    Linear,
    /// h = (1, m): inputs have a last entry m, what another emulator says, which has no length.
    Other,
}

fn row(inputs: &DMatrix<f64>, k: usize) -> impl Iterator<Item = f64> + '_ {
    inputs.row(k).into_iter().copied()
}

impl Trend {
    /// The one that so many points of so many parameters allow.
    fn of(points: usize, parameters: usize) -> Trend {
        if points >= 2 * parameters + 4 { Trend::Linear } else { Trend::Constant }
    }

    /// Parameters of inputs with so many entries.
    fn parameters(self, entries: usize) -> usize {
        if self == Trend::Other { entries - 1 } else { entries }
    }

    /// The row h of a point.
    fn row(self, z: &[f64]) -> Vec<f64> {
        let rest = match self {
            Trend::Constant => &z[z.len()..],
            Trend::Linear => z,
            Trend::Other => &z[z.len() - 1..],
        };
        [&[1.0], rest].concat()
    }
}

/// Rows h.
fn basis(inputs: &DMatrix<f64>, trend: Trend) -> DMatrix<f64> {
    let rows: Vec<Vec<f64>> =
        (0..inputs.nrows()).map(|i| trend.row(&row(inputs, i).collect::<Vec<_>>())).collect();
    DMatrix::from_fn(rows.len(), rows.first().map_or(1, Vec::len), |i, j| rows[i][j])
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
    along: Cholesky<f64, Dyn>,
    beta: DVector<f64>,
    alpha: DVector<f64>,
    scale: f64,
}

fn solve(inputs: &DMatrix<f64>, y: &DVector<f64>, h: &DMatrix<f64>, logs: &[f64]) -> Option<Solved> {
    let d = logs.len() - 1;
    let lengths: Vec<f64> = logs[..d].iter().map(|l| libm::exp(*l)).collect();
    let chol = Cholesky::new(correlation(inputs, &lengths, libm::exp(logs[d])))?;
    let white = chol.l_dirty().solve_lower_triangular(h)?;
    let along = Cholesky::new(white.transpose() * &white)?;
    let y_white = chol.l_dirty().solve_lower_triangular(y)?;
    let beta = along.solve(&(white.transpose() * &y_white));
    let rest = y_white - &white * &beta;
    let free = (y.len() - h.ncols()).max(1) as f64;
    let scale = (rest.norm_squared() / free).max(1e-300);
    let alpha = chol.l_dirty().tr_solve_lower_triangular(&rest)?;
    Some(Solved { chol, white, along, beta, alpha, scale })
}

/// Minus the logarithm of likelihood times prior, and its gradient.
fn loss(
    inputs: &DMatrix<f64>,
    y: &DVector<f64>,
    h: &DMatrix<f64>,
    logs: &[f64],
    scatter: Scatter,
) -> Option<(f64, Vec<f64>)> {
    let (n, d) = (inputs.nrows(), logs.len() - 1);
    let s = solve(inputs, y, h, logs)?;
    let log_det =
        |c: &Cholesky<f64, Dyn>| 2.0 * c.l_dirty().diagonal().iter().map(|v| libm::log(*v)).sum::<f64>();
    let free = (n - h.ncols()).max(1) as f64;
    let mut value = 0.5 * (log_det(&s.chol) + log_det(&s.along) + free * libm::log(s.scale));
    // R⁻¹ without its part along the trend: d(loss)/dR = ½ (Q − α αᵀ/σ²).
    let inverse = s.chol.inverse();
    let along = s.chol.l_dirty().tr_solve_lower_triangular(&s.white)?;
    let q = inverse - &along * s.along.solve(&along.transpose());
    // ½ αᵀ dR α of each, in `pulls`.
    let (mut gradient, mut pulls) = (vec![0.0; d + 1], vec![0.0; d + 1]);
    let lengths: Vec<f64> = logs[..d].iter().map(|l| libm::exp(*l)).collect();
    for i in 0..n {
        gradient[d] += 0.5 * q[(i, i)] * libm::exp(logs[d]);
        pulls[d] += 0.5 * s.alpha[i] * s.alpha[i] * libm::exp(logs[d]);
        for j in 0..i {
            let r = distance(row(inputs, i), row(inputs, j), &lengths);
            // dk/d ln ℓ = 5/3 (1 + √5 r) exp(−√5 r) (Δ/ℓ)²; twice for both triangles.
            let slope = 5.0 / 3.0 * (1.0 + SQRT5 * r) * libm::exp(-SQRT5 * r);
            for (k, l) in lengths.iter().enumerate() {
                let change = slope * ((inputs[(i, k)] - inputs[(j, k)]) / l).powi(2);
                gradient[k] += q[(i, j)] * change;
                pulls[k] += s.alpha[i] * s.alpha[j] * change;
            }
        }
    }
    gradient.iter_mut().zip(&pulls).for_each(|(g, pull)| *g -= pull / s.scale);
    if let Scatter::About(scatter) = scatter {
        // ln Var ε = ln σ² + ln g, d ln σ² = −αᵀ dR α/(σ² n).
        let off = (libm::log(s.scale) + logs[d] - libm::log(scatter)) / EXPECTED;
        value += 0.5 * off * off;
        gradient[d] += off / EXPECTED;
        gradient
            .iter_mut()
            .zip(&pulls)
            .for_each(|(g, pull)| *g -= off / EXPECTED * 2.0 * pull / (s.scale * free));
    }
    for (k, log) in logs.iter().enumerate() {
        let [mean, deviation] = match scatter {
            _ if k < d => LENGTH_PRIOR,
            Scatter::None => NOISE_PRIOR,
            Scatter::Unknown => CHANCE_PRIOR,
            Scatter::About(_) => break,
        };
        let off = (log - mean) / deviation;
        value += 0.5 * off * off;
        gradient[k] += off / deviation;
    }
    value.is_finite().then_some((value, gradient))
}

impl Gp {
    /// Fits a process to the rows of `inputs`, whose values have this scatter; `start` are the lengths of an earlier fit.
    pub fn fit(
        inputs: &DMatrix<f64>,
        y: &DVector<f64>,
        (scatter, start): (Scatter, Option<&Logs>),
    ) -> Option<Gp> {
        Gp::fit_with(inputs, y, (scatter, start), Trend::of(inputs.nrows(), inputs.ncols()))
    }

    /// The same with this trend.
    pub fn fit_with(
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

    /// For each point: its distance from what the others say, over the deviation of that (eqs. 5.10–5.12, with the trend).
    pub fn left_out(&self) -> Option<Vec<f64>> {
        let along = self.chol.l_dirty().tr_solve_lower_triangular(&self.white)?;
        let q = self.chol.inverse() - &along * self.along.solve(&along.transpose());
        let off = |i: usize| self.alpha[i] / (q[(i, i)].max(1e-300) * self.scale).sqrt();
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
        let h = basis(&x, Trend::Linear);
        let at = [-0.5, 0.4, -3.0];
        for (scatter, k) in [Scatter::None, Scatter::Unknown, Scatter::About(0.3)]
            .into_iter()
            .flat_map(|s| (0..3).map(move |k| (s, k)))
        {
            let (_, gradient) = loss(&x, &y, &h, &at, scatter).unwrap();
            let step = |s: f64| {
                let mut logs = at;
                logs[k] += s;
                loss(&x, &y, &h, &logs, scatter).unwrap().0
            };
            let slope = (step(1e-5) - step(-1e-5)) / 2e-5;
            assert!(
                (gradient[k] - slope).abs() < 1e-5 * slope.abs().max(1.0),
                "{scatter:?} {k}: {} {slope}",
                gradient[k]
            );
        }
    }

    #[test]
    fn a_smooth_function_is_learnt_with_its_uncertainty() {
        let f = |z: &[f64]| libm::exp(z[0]) * libm::cos(3.0 * z[1]) + 0.0 * z[2];
        let x = points(60, 3, 2);
        let y = DVector::from_fn(60, |i, _| f(&[x[(i, 0)], x[(i, 1)], x[(i, 2)]]));
        let gp = Gp::fit(&x, &y, (Scatter::None, None)).unwrap();
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
                Gp::fit(&x, &y, (scatter, None)).unwrap().noise.sqrt()
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
        let gp = Gp::fit(&x, &y, (Scatter::None, None)).unwrap();
        assert!((gp.noise.sqrt() - 0.2).abs() < 0.04, "{}", gp.noise.sqrt());
        assert!((gp.mean(&[0.5]) - 0.75).abs() < 0.1, "{}", gp.mean(&[0.5]));
        // The covariance of a point with itself is its variance.
        let (p, v) = gp.project(&[0.3]);
        assert!((gp.covariance((&[0.3], &v), (&[0.3], &v)) - p.variance).abs() < 1e-12);
    }
}
