//! How much each parameter changes the curves, between its bounds: Sobol indices from the emulator.
//!
//! ```text
//! S_i  = 1 − Σ_k mean (f_k(B) − f_k(A_B^i))²/2 / Σ_k Var f_k        alone
//! ST_i =     Σ_k mean (f_k(A) − f_k(A_B^i))²/2 / Σ_k Var f_k        with all others
//! ```
//!
//! Saltelli et al. (2010), doi:10.1016/j.cpc.2009.09.018, table 2 (Jansen); of several outputs k by their sums (Lamboni, Monod & Makowski 2011,
//! doi:10.1016/j.ress.2010.12.002).

use super::halton::Halton;
use crate::emulator::Emulator;

/// Points of each matrix.
const POINTS: u64 = 512;

/// The indices of one part.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensitivity {
    /// For each parameter: alone.
    pub alone: Vec<f64>,
    /// For each parameter: with all others.
    pub total: Vec<f64>,
}

/// Indices of an emulator of `d` parameters.
pub(crate) fn sensitivity(emulator: &Emulator, d: usize, seed: u64) -> Sensitivity {
    let sequence = Halton::new(2 * d, seed);
    let points: Vec<Vec<f64>> = (1..=POINTS).map(|k| sequence.point(k)).collect();
    let values = |z: &[f64]| emulator.scores(z);
    let a: Vec<Vec<f64>> = points.iter().map(|p| values(&p[..d])).collect();
    let b: Vec<Vec<f64>> = points.iter().map(|p| values(&p[d..])).collect();
    let n = 2.0 * POINTS as f64;
    let variance = |k: usize| {
        let all = || a.iter().chain(&b).map(|v| v[k]);
        let mean = all().sum::<f64>() / n;
        all().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n
    };
    let whole = (0..emulator.components.len()).map(variance).sum::<f64>().max(1e-300);
    let apart = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| (x - y) * (x - y)).sum::<f64>();
    let (mut alone, mut total) = (Vec::new(), Vec::new());
    for i in 0..d {
        let (mut of_a, mut of_b) = (0.0, 0.0);
        for (k, p) in points.iter().enumerate() {
            let mut mixed = p[..d].to_vec();
            mixed[i] = p[d + i];
            let mixed = values(&mixed);
            of_a += apart(&a[k], &mixed);
            of_b += apart(&b[k], &mixed);
        }
        alone.push((1.0 - of_b / n / whole).clamp(0.0, 1.0));
        total.push((of_a / n / whole).clamp(0.0, 1.0));
    }
    Sensitivity { alone, total }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emulator::Lessons;
    use nalgebra::{DMatrix, DVector};

    #[test]
    fn indices_of_a_known_function() {
        // y = 4 a + 2 b + 0 c: variances 16/12 and 4/12, so 0.8, 0.2 and 0.
        let sequence = Halton::new(3, 1);
        let x = DMatrix::from_fn(40, 3, |i, j| sequence.point(i as u64)[j]);
        let y = DMatrix::from_fn(40, 1, |i, _| 4.0 * x[(i, 0)] + 2.0 * x[(i, 1)]);
        let one = DMatrix::from_element(1, 1, 1e-4);
        let e = Emulator::learn(&Lessons {
            inputs: x,
            outputs: y,
            data: DVector::from_element(1, 3.0),
            covariance: one,
            seeds: 1.0,
            specimens: 1.0,
            random: false,
            before: &[],
            refined: None,
        })
        .unwrap();
        let s = sensitivity(&e, 3, 2);
        for (found, wanted) in s.total.iter().chain(&s.alone).zip([0.8, 0.2, 0.0, 0.8, 0.2, 0.0]) {
            assert!((found - wanted).abs() < 0.03, "{s:?}");
        }
    }
}
