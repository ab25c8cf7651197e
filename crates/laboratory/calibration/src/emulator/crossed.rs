//! How far each trial is from what the others say of it, where there are few.

use super::gp::{Gp, LeftOut};
use super::likelihood::Scatter;
use geom::random::{generator, unit};
use nalgebra::{DMatrix, DVector};

/// Stream of the order.
const STREAM: u64 = 0x666f_6c64;

/// Parts that are left out in turn.
const FOLDS: usize = 10;

/// Least variance of a prediction, over that of all points: where one point alone differs, the others promise to be exact.
const LEAST: f64 = 1e-4;

/// As [`Gp::left_out`] of the `whole`, with lengths fitted again without the points of each part: lengths of few points follow every one of them, and would seem to
/// predict it. Stone (1974), doi:10.1111/j.2517-6161.1974.tb00994.x.
pub(crate) fn crossed(
    whole: &Gp,
    inputs: &DMatrix<f64>,
    y: &DVector<f64>,
    scatter: Scatter,
) -> Option<Vec<LeftOut>> {
    let n = inputs.nrows();
    let mut off = vec![LeftOut { error: 0.0, deviation: 1.0 }; n];
    let least = LEAST * y.variance();
    let order = shuffled(n);
    for fold in 0..FOLDS.min(n) {
        let is_out = |at: &usize| at % FOLDS == fold;
        let rest: Vec<usize> = (0..n).filter(|at| !is_out(at)).map(|at| order[at]).collect();
        let (some, some_y) = (inputs.select_rows(&rest), y.select_rows(&rest));
        let gp = Gp::fit(&some, &some_y, (scatter, None), whole.trend)?;
        for i in (0..n).filter(is_out).map(|at| order[at]) {
            let p = gp.predict(&inputs.row(i).iter().copied().collect::<Vec<_>>());
            let deviation = (p.variance + gp.noise).max(least).sqrt();
            off[i] = LeftOut { error: y[i] - p.mean, deviation };
        }
    }
    Some(off)
}

/// Indices below `n` in a random order, always the same one: in the order of even points each tenth one lies in a part of the space.
fn shuffled(n: usize) -> Vec<usize> {
    let mut random = generator(STREAM, n as u64, 0);
    let mut order: Vec<usize> = (0..n).collect();
    for k in (1..n).rev() {
        order.swap(k, (unit(&mut random) * (k + 1) as f64) as usize);
    }
    order
}

#[cfg(test)]
mod tests {
    use super::super::trend::Trend;
    use super::*;

    /// One trial alone differs from all others: the emulator becomes uncertain, not useless.
    #[test]
    fn one_point_that_differs_has_a_bounded_weight() {
        let mut random = generator(3, 1, 0);
        let x = DMatrix::from_fn(12, 3, |_, _| unit(&mut random));
        let y = DVector::from_fn(12, |i, _| if i == 7 { 1.0 } else { 0.0 });
        let off =
            crossed(&Gp::fit(&x, &y, (Scatter::None, None), Trend::Linear).unwrap(), &x, &y, Scatter::None)
                .unwrap();
        assert!(off.iter().all(|o| o.scaled().abs() < 1e3) && off[7].scaled().abs() > 2.0, "{off:?}");
    }

    /// Twelve points of a function of three parameters that bends: how often is it within 1.64 deviations of its emulator, which 90 % should be?
    #[test]
    fn few_points_promise_no_more_than_they_hold() {
        let f = |z: &[f64]| libm::tanh(4.0 * z[0] - 2.0) * (0.5 + z[1]) + libm::exp(-3.0 * z[2] * z[0]);
        let (mut inside, mut alone, mut all) = (0, 0, 0);
        for seed in 0..20 {
            let mut random = generator(seed, 1, 0);
            let x = DMatrix::from_fn(12, 3, |_, _| unit(&mut random));
            let at = |x: &DMatrix<f64>, i: usize| [x[(i, 0)], x[(i, 1)], x[(i, 2)]];
            let y = DVector::from_fn(12, |i, _| f(&at(&x, i)));
            let gp = Gp::fit(&x, &y, (Scatter::None, None), Trend::Linear).unwrap();
            let square = |off: Vec<LeftOut>| off.iter().map(|o| o.scaled().powi(2)).sum::<f64>() / 12.0;
            let factors =
                [square(crossed(&gp, &x, &y, Scatter::None).unwrap()), square(gp.left_out().unwrap())];
            for z in (0..50).map(|_| [0; 3].map(|_| unit(&mut random))) {
                let p = gp.predict(&z);
                let [crossed, left_out] = factors
                    .map(|factor| (p.mean - f(&z)).abs() <= 1.64 * (factor * (p.variance + gp.noise)).sqrt());
                (inside, alone, all) =
                    (inside + usize::from(crossed), alone + usize::from(left_out), all + 1);
            }
        }
        assert!(100 * inside >= 78 * all, "{inside} of {all}; with the lengths as they are {alone}");
        assert!(100 * alone < 65 * all, "the lengths as they are would do: {alone} of {all}");
    }
}
