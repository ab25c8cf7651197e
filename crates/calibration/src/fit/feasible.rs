//! Where trials can be simulated: what guards have stopped counts, too.
//!
//! ```text
//! p(z) = (Σ w_i o_i + 1)/(Σ w_i + 1),   w_i = exp(−|z − z_i|²/(2 h²)),   o_i: 1 of a trial that came to its end, else 0
//! ```
//!
//! Nadaraya (1964), doi:10.1137/1109020, with one more trial that came to its end.

/// Width h for each root of a dimension [–].
const WIDTH: f64 = 0.08;

/// Trials, and whether they came to their end.
pub(crate) struct Feasible {
    trials: Vec<(Vec<f64>, bool)>,
    width: f64,
    any_stopped: bool,
}

impl Feasible {
    pub fn new(trials: Vec<(Vec<f64>, bool)>) -> Feasible {
        let d = trials.first().map_or(1, |t| t.0.len());
        let any_stopped = trials.iter().any(|t| !t.1);
        Feasible { trials, width: WIDTH * (d as f64).sqrt(), any_stopped }
    }

    /// Logarithm of the chance that a trial comes to its end.
    pub fn log_chance(&self, z: &[f64]) -> f64 {
        if !self.any_stopped {
            return 0.0;
        }
        let (mut done, mut all) = (1.0, 1.0);
        for (at, ok) in &self.trials {
            let square: f64 = at.iter().zip(z).map(|(a, b)| (a - b) * (a - b)).sum();
            let w = libm::exp(-0.5 * square / (self.width * self.width));
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
        assert!(chance(0.2) > 0.99 && chance(0.95) < 0.1, "{} {}", chance(0.2), chance(0.95));
        assert_eq!(Feasible::new(vec![(vec![0.5], true)]).log_chance(&[0.5]), 0.0);
    }
}
