//! Numbers drawn by a seed, and what can be said of a sample.

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::f64::consts::PI;

/// Numbers of one seed.
pub struct Chance(Pcg64Mcg);

impl Chance {
    /// The stream of a seed.
    pub fn new(seed: u64) -> Chance {
        Chance(Pcg64Mcg::seed_from_u64(seed))
    }

    /// Uniform in 0 … 1 [–].
    pub fn share(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in low … high.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// Mean 0, deviation 1 (Box & Muller 1958).
    pub fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.share()).ln()).sqrt() * (2.0 * PI * self.share()).cos()
    }
}

/// Chance places of a square of `width` about the origin, none nearer than `apart` to another [m]; fewer than `count` where the square
/// is full.
pub fn places(width: f64, apart: f64, count: usize) -> Vec<(f64, f64)> {
    let mut chance = Chance::new(7);
    let mut kept: Vec<(f64, f64)> = Vec::new();
    for _ in 0..40 * count {
        let (x, y) = (chance.between(-0.5, 0.5) * width, chance.between(-0.5, 0.5) * width);
        if kept.len() < count && kept.iter().all(|p| (p.0 - x).hypot(p.1 - y) >= apart) {
            kept.push((x, y));
        }
    }
    kept
}

/// Mean of a sample and half the width of its 95 % interval, 1.96 s/√n.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    /// Mean.
    pub mean: f64,
    /// Half width.
    pub off: f64,
    /// Deviation of one value.
    pub deviation: f64,
}

/// Mean of values; NaN of none.
pub fn mean(values: &[f64]) -> Mean {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let deviation = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0)).sqrt();
    Mean { mean, off: 1.96 * deviation / n.sqrt(), deviation }
}
