//! Where trials can be simulated: what guards have stopped counts, too.
//!
//! ```text
//! p(z) = (Σ w_i o_i + ε ō)/(Σ w_i + ε),   w_i = exp(−|z − z_i|²/(2 h²)),   o_i: 1 of a trial that came to its end, else 0
//! ```
//!
//! h: distance to the third nearest trial (at least 0.05); ō: share of all trials that came to their end, which counts as a tenth of a trial.
//! Nadaraya (1964), doi:10.1137/1109020.

/// Least width h [–].
const LEAST: f64 = 0.05;
/// Nearest trial that the width reaches to, from 0.
const NEAREST: usize = 2;
/// Weight ε of the share of all.
const PRIOR: f64 = 0.1;

/// Trials, and whether they came to their end.
pub(crate) struct Feasible {
    trials: Vec<(Vec<f64>, bool)>,
    share: f64,
}

impl Feasible {
    pub fn new(trials: Vec<(Vec<f64>, bool)>) -> Feasible {
        let done = trials.iter().filter(|t| t.1).count() as f64;
        let share = done / trials.len().max(1) as f64;
        Feasible { trials, share }
    }

    /// Logarithm of the chance that a trial comes to its end.
    pub fn log_chance(&self, z: &[f64]) -> f64 {
        if self.share >= 1.0 || self.trials.is_empty() {
            return 0.0;
        }
        let square = |at: &[f64]| at.iter().zip(z).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
        let squares: Vec<f64> = self.trials.iter().map(|t| square(&t.0)).collect();
        let mut sorted = squares.clone();
        let near = NEAREST.min(sorted.len() - 1);
        let (_, third, _) = sorted.select_nth_unstable_by(near, f64::total_cmp);
        let width = third.max(LEAST * LEAST);
        let (mut done, mut all) = (PRIOR * self.share, PRIOR);
        for (square, (_, ok)) in squares.iter().zip(&self.trials) {
            let w = libm::exp(-0.5 * square / width);
            all += w;
            done += if *ok { w } else { 0.0 };
        }
        libm::log(done / all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stopped_corner_is_unlikely_and_the_rest_is_not() {
        let trials = (0..100).map(|k| f64::from(k) / 99.0).map(|z| (vec![z], z < 0.7)).collect();
        let feasible = Feasible::new(trials);
        let chance = |z: f64| libm::exp(feasible.log_chance(&[z]));
        assert!(chance(0.2) > 0.98 && chance(0.95) < 0.1, "{} {}", chance(0.2), chance(0.95));
        assert_eq!(Feasible::new(vec![(vec![0.5], true)]).log_chance(&[0.5]), 0.0);
    }
}
