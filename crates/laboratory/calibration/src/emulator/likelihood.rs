//! The likelihood of the lengths of a Gaussian process, and its gradient (Rasmussen & Williams 2006, eq. 5.9).
//!
//! Where runs scatter, as specimens do, short lengths and noise explain few points alike. What is known of the noise decides ([`Scatter`]).

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

const SQRT5: f64 = 2.236_067_977_499_79;
/// Mean and deviation of the prior of ln ℓ, and of that of ln g for runs without chance and with chance.
const LENGTH_PRIOR: [f64; 2] = [0.3, 1.0];
const NOISE_PRIOR: [f64; 2] = [-9.0, 5.0];
const CHANCE_PRIOR: [f64; 2] = [-4.0, 3.0];
/// Deviation of ln Var ε from what is expected.
const EXPECTED: f64 = 1.5;

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

pub(super) fn matern(r: f64) -> f64 {
    (1.0 + SQRT5 * r + 5.0 / 3.0 * r * r) * libm::exp(-SQRT5 * r)
}

pub(super) fn distance(a: impl Iterator<Item = f64>, b: impl Iterator<Item = f64>, lengths: &[f64]) -> f64 {
    a.zip(b).zip(lengths).map(|((a, b), l)| ((a - b) / l).powi(2)).sum::<f64>().sqrt()
}

/// Entries of a row.
pub(super) fn row(inputs: &DMatrix<f64>, k: usize) -> impl Iterator<Item = f64> + '_ {
    inputs.row(k).into_iter().copied()
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
pub(super) struct Solved {
    pub chol: Cholesky<f64, Dyn>,
    pub white: DMatrix<f64>,
    pub along: Cholesky<f64, Dyn>,
    pub beta: DVector<f64>,
    pub alpha: DVector<f64>,
    pub scale: f64,
}

/// All of it for one set; `None` where a matrix is singular.
pub(super) fn solve(
    inputs: &DMatrix<f64>,
    y: &DVector<f64>,
    h: &DMatrix<f64>,
    logs: &[f64],
) -> Option<Solved> {
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
pub(super) fn loss(
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
        // ln Var ε = ln σ² + ln g, d ln σ² = −αᵀ dR α/(σ² (n − p)).
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

#[cfg(test)]
pub(super) mod tests {
    use super::super::trend::{Trend, basis};
    use super::*;
    use geom::random::{generator, unit};

    pub fn points(n: usize, d: usize, seed: u64) -> DMatrix<f64> {
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
}
