//! The best point: where the least misfit is expected of a run.
//!
//! ```text
//! Q = (y − d)ᵀ C⁻¹ (y − d)                       square of the misfit of a run y from the data d
//! E Q(z)   = b + Σ_k [(m_k − t_k)² + w_k]         w_k = v_k(z) + ε_k
//! Var Q(z) =     Σ_k [4 w_k (m_k − t_k)² + 2 w_k²]
//! ```
//!
//! m, v: mean and variance of a component of the emulator; ε: scatter of runs; t: the data; b: the square of the data beside all components. The least is
//! searched of E Q/s² − 2 ln p(z), with the prior and the chance of coming to an end, from samples of the posterior, trials and even points. Where the emulator
//! is unsure, v counts against a point; the likelihood, which asks what can be excluded, does not hold that against it.

use super::halton::Halton;
use super::sample::Samples;
use super::{Fitted, KnownTrial};
use crate::emulator::Expected;
use rayon::prelude::*;

/// Even points that are looked at, and the seed of their sequence.
const EVEN: u64 = 400;
const SEED: u64 = 0x62_65_73_74;
/// Points that are improved, and the first and last step of that.
const IMPROVED: usize = 4;
const STEPS: [f64; 2] = [0.05, 1e-4];
/// A run differs from what is expected of it by more than so many deviations, and by more than this share.
const DEVIATIONS: f64 = 3.0;
const SHARE: f64 = 0.1;

/// Square of the misfit that chance makes of the true parameters: what is expected, and three standard deviations above it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Allowed {
    pub mean: f64,
    pub most: f64,
}

impl Fitted<'_> {
    /// What is expected of the square of the misfit of a run at a point.
    pub fn expected(&self, z: &[f64]) -> Expected {
        let of = self.emulators.iter().map(|e| e.expected(z));
        of.fold(Expected { mean: 0.0, variance: 0.0 }, |a, b| Expected {
            mean: a.mean + b.mean,
            variance: a.variance + b.variance,
        })
    }

    /// Whether a run at a point differs from what is expected of it by more than the emulator allows.
    pub fn disagrees(&self, z: &[f64], simulated: f64) -> bool {
        let expected = self.expected(z);
        let off = (simulated - expected.mean).abs();
        off > DEVIATIONS * expected.variance.sqrt() && off > SHARE * (expected.mean + self.allowed().mean)
    }

    /// What the data and the scatter of runs make of the true parameters.
    pub fn allowed(&self) -> Allowed {
        let points: usize = self.emulators.iter().map(|e| e.points).sum();
        let free = (points as f64 - self.step.fit.len() as f64).max(1.0);
        let chance = || self.emulators.iter().flat_map(|e| e.chance.iter().copied());
        let mean = free + chance().sum::<f64>();
        let variance = 2.0 * free + chance().map(|c| 2.0 * ((1.0 + c) * (1.0 + c) - 1.0)).sum::<f64>();
        Allowed { mean, most: mean + 3.0 * variance.sqrt() }
    }

    /// The trial whose runs are nearest to the data, of those between the bounds.
    pub fn nearest(&self) -> Option<&KnownTrial> {
        self.known.iter().find(|t| t.z.iter().all(|z| (0.0..=1.0).contains(z)))
    }

    /// The point where the least misfit is expected.
    pub fn best(&self, samples: &Samples) -> Vec<f64> {
        let d = self.step.fit.len();
        let even = Halton::new(d, SEED);
        let inside = |z: &&Vec<f64>| z.iter().all(|z| (0.0..=1.0).contains(z));
        let known = self.known.iter().map(|t| &t.z).filter(inside).cloned();
        let sampled = samples.list.iter().map(|s| s.z.clone());
        let all: Vec<Vec<f64>> = known.chain(sampled).chain((0..EVEN).map(|k| even.point(k))).collect();
        let mut scored: Vec<(f64, usize)> =
            all.par_iter().enumerate().map(|(k, z)| (self.objective(z), k)).collect();
        scored.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        // Chains stay where they are when a step is refused: a point counts once.
        scored.dedup_by(|a, b| all[a.1] == all[b.1]);
        scored.truncate(IMPROVED);
        let improved: Vec<(f64, Vec<f64>)> =
            scored.par_iter().map(|(value, k)| self.improved(*value, all[*k].clone())).collect();
        let least = improved.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        least.map_or_else(|| vec![0.5; d], |best| best.1)
    }

    fn objective(&self, z: &[f64]) -> f64 {
        self.expected(z).mean / self.inflation - 2.0 * (self.log_prior(z) + self.feasible.log_chance(z))
    }

    /// The least in the neighbourhood of a point: steps along one coordinate at a time, halved where none improves.
    fn improved(&self, mut value: f64, mut z: Vec<f64>) -> (f64, Vec<f64>) {
        let mut step = STEPS[0];
        while step > STEPS[1] {
            let mut moved = false;
            for k in 0..z.len() {
                for way in [step, -step] {
                    let mut there = z.clone();
                    there[k] = (z[k] + way).clamp(0.0, 1.0);
                    let new = self.objective(&there);
                    if new < value {
                        (value, z, moved) = (new, there, true);
                        break;
                    }
                }
            }
            if !moved {
                step *= 0.5;
            }
        }
        (value, z)
    }
}
