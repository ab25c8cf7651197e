//! Samples of a posterior in the unit cube: differential evolution Markov chains.
//!
//! ```text
//! z* = z_i + γ (z_a − z_b) + e,   γ = 2.38/√(2d), 1 in each tenth generation;   accepted with min(1, p(z*)/p(z_i))
//! ```
//!
//! ter Braak (2006), doi:10.1007/s11222-006-8769-1. Half of the chains move at a time, by differences of the other half, so that they can be
//! computed side by side; each chain has its own random numbers, so that the samples are the same for any number of threads.

use super::halton::Halton;
use geom::random::{generator, unit};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;

/// Stream of the chains.
const CHAINS: u64 = 0x6d_63;
/// Stream of the resampling.
const RESAMPLED: u64 = 0x73_6d_63;
/// Powers on the way, and moves at each.
const MOST_POWERS: usize = 60;
const MOVES: usize = 4;
/// Points of the cube that are looked at for starts.
const STARTS: u64 = 600;

/// A point and the logarithm of its density.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PosteriorPoint {
    pub z: Vec<f64>,
    pub log: f64,
}

/// How long chains are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Length {
    pub burn: usize,
    pub keep: usize,
    pub thin: usize,
}

/// Samples, and the largest ratio R̂ of the deviations of all chains and of each (Gelman & Rubin 1992, doi:10.1214/ss/1177011136).
pub(crate) struct Samples {
    pub list: Vec<PosteriorPoint>,
    pub ratio: f64,
}

impl Samples {
    /// Number of coordinates.
    pub fn dimensions(&self) -> usize {
        self.list.first().map_or(0, |s| s.z.len())
    }

    /// Coordinate `at` of all of them, in order of size.
    pub fn sorted(&self, at: usize) -> Vec<f64> {
        let mut values: Vec<f64> = self.list.iter().map(|s| s.z[at]).collect();
        values.sort_by(f64::total_cmp);
        values
    }
}

/// A density in the cube, as its logarithm.
pub(crate) type Density<'a> = dyn Fn(&[f64]) -> f64 + Sync + 'a;

struct Chain {
    at: PosteriorPoint,
    random: Pcg64Mcg,
    kept: Vec<PosteriorPoint>,
}

/// Draws samples; `known` are points that may be good.
pub(crate) fn draw(density: &Density, d: usize, known: &[Vec<f64>], seed: u64, length: Length) -> Samples {
    let count = 2 * (2 * d + 2).clamp(10, 30);
    let sequence = Halton::new(d, seed ^ CHAINS);
    let even = (0..STARTS).map(|k| sequence.point(k)).collect::<Vec<_>>();
    let all: Vec<&Vec<f64>> = even.iter().chain(known).collect();
    let starts: Vec<PosteriorPoint> =
        all.par_iter().map(|z| PosteriorPoint { log: density(z), z: (*z).clone() }).collect();
    let mut random = generator(seed, RESAMPLED, 0);
    let mut power = 0.0;
    let starts = resampled(&starts, &mut power, count, &mut random);
    let chain = |(k, at): (usize, PosteriorPoint)| Chain {
        at,
        random: generator(seed, CHAINS, k as u64),
        kept: Vec::new(),
    };
    let mut chains: Vec<Chain> = starts.into_iter().enumerate().map(chain).collect();
    anneal(&mut chains, density, power, &mut random);
    for generation in 0..length.burn + length.keep {
        step(&mut chains, density, generation, 1.0);
        if generation >= length.burn && generation % length.thin == 0 {
            chains.iter_mut().for_each(|c| c.kept.push(c.at.clone()));
        }
    }
    let ratio = ratio(&chains, d);
    let list: Vec<PosteriorPoint> = chains.into_iter().flat_map(|c| c.kept).collect();
    Samples { list, ratio }
}

/// From an even density to the one that is wanted, by powers of it, so that chains do not begin in unlikely places: sequential Monte Carlo
/// (Del Moral, Doucet & Jasra 2006, doi:10.1111/j.1467-9868.2006.00553.x).
fn anneal(chains: &mut [Chain], density: &Density, mut power: f64, random: &mut Pcg64Mcg) {
    for _ in 0..MOST_POWERS {
        for generation in 0..MOVES {
            step(chains, density, generation, power);
        }
        if power >= 1.0 {
            break;
        }
        let at: Vec<PosteriorPoint> = chains.iter().map(|c| c.at.clone()).collect();
        let new = resampled(&at, &mut power, chains.len(), random);
        chains.iter_mut().zip(new).for_each(|(c, at)| c.at = at);
    }
}

/// Raises the power until half as many samples as are wanted count, and draws samples by their weights.
fn resampled(
    from: &[PosteriorPoint],
    power: &mut f64,
    count: usize,
    random: &mut Pcg64Mcg,
) -> Vec<PosteriorPoint> {
    let top = from.iter().map(|s| s.log).fold(f64::NEG_INFINITY, f64::max);
    let weights = |more: f64| -> Vec<f64> { from.iter().map(|s| libm::exp(more * (s.log - top))).collect() };
    let effective = |w: &[f64]| w.iter().sum::<f64>().powi(2) / w.iter().map(|w| w * w).sum::<f64>();
    let enough = 0.5 * count as f64;
    let (mut low, mut high) = (0.0, 1.0 - *power);
    if effective(&weights(high)) < enough {
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if effective(&weights(middle)) < enough { high = middle } else { low = middle }
        }
        high = low;
    }
    *power = (*power + high).min(1.0);
    let weights = weights(high);
    let each = weights.iter().sum::<f64>() / count as f64;
    let (mut mark, mut sum, mut drawn) = (unit(random) * each, 0.0, Vec::new());
    for (sample, weight) in from.iter().zip(&weights) {
        sum += weight;
        while mark < sum && drawn.len() < count {
            drawn.push(sample.clone());
            mark += each;
        }
    }
    while drawn.len() < count {
        drawn.push(from[from.len() - 1].clone());
    }
    drawn
}

/// A generation: one half moves by differences of the other, then the other.
fn step(chains: &mut [Chain], density: &Density, generation: usize, power: f64) {
    let half = chains.len() / 2;
    let (left, right) = chains.split_at_mut(half);
    advance(left, right, density, (generation, power));
    advance(right, left, density, (generation, power));
}

fn advance(moving: &mut [Chain], others: &[Chain], density: &Density, (generation, power): (usize, f64)) {
    let d = others[0].at.z.len();
    let gamma = if generation % 10 == 9 { 1.0 } else { 2.38 / (2.0 * d as f64).sqrt() };
    moving.par_iter_mut().for_each(|chain| {
        let a = (unit(&mut chain.random) * others.len() as f64) as usize;
        let b = (a + 1 + (unit(&mut chain.random) * (others.len() - 1) as f64) as usize) % others.len();
        let (a, b) = (&others[a].at.z, &others[b].at.z);
        let z: Vec<f64> = (0..d)
            .map(|k| {
                let e = 2e-3 * (unit(&mut chain.random) - 0.5);
                reflected(chain.at.z[k] + gamma * (a[k] - b[k]) + e)
            })
            .collect();
        let log = density(&z);
        if libm::log(unit(&mut chain.random).max(1e-300)) < power * (log - chain.at.log) {
            chain.at = PosteriorPoint { z, log };
        }
    });
}

/// A coordinate brought back into 0 to 1 by mirrors at the ends.
fn reflected(z: f64) -> f64 {
    let folded = z.rem_euclid(2.0);
    if folded > 1.0 { 2.0 - folded } else { folded }
}

/// The largest R̂ of a coordinate.
fn ratio(chains: &[Chain], d: usize) -> f64 {
    let n = chains[0].kept.len() as f64;
    let m = chains.len() as f64;
    let of = |k: usize| {
        let means: Vec<f64> = chains.iter().map(|c| c.kept.iter().map(|s| s.z[k]).sum::<f64>() / n).collect();
        let mean = means.iter().sum::<f64>() / m;
        let between = means.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / (m - 1.0);
        let inside = |(c, mean): (&Chain, &f64)| {
            c.kept.iter().map(|s| (s.z[k] - mean).powi(2)).sum::<f64>() / (n - 1.0)
        };
        let within = chains.iter().zip(&means).map(inside).sum::<f64>() / m;
        ((within * (n - 1.0) / n + between) / within.max(1e-300)).sqrt()
    };
    (0..d).map(of).fold(1.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_ridge_and_a_flat_direction_are_sampled() {
        // Normal along the ridge x + y = 1 (deviation 0.01 across, 0.2 along), even in the third.
        let density = |z: &[f64]| {
            let (across, along) = ((z[0] + z[1] - 1.0) / 2f64.sqrt(), (z[0] - z[1]) / 2f64.sqrt());
            -0.5 * ((across / 0.01).powi(2) + (along / 0.2).powi(2))
        };
        let s = draw(&density, 3, &[], 1, Length { burn: 400, keep: 2000, thin: 4 });
        let n = s.list.len() as f64;
        let mean = |f: &dyn Fn(&[f64]) -> f64| s.list.iter().map(|p| f(&p.z)).sum::<f64>() / n;
        let along = mean(&|z| (z[0] - z[1]).powi(2) / 2.0).sqrt();
        let across = mean(&|z| (z[0] + z[1] - 1.0).powi(2) / 2.0).sqrt();
        assert!((along - 0.2).abs() < 0.02 && (across - 0.01).abs() < 0.001, "{along} {across}");
        let flat = mean(&|z| (z[2] - 0.5).powi(2));
        assert!((flat - 1.0 / 12.0).abs() < 0.01, "{flat}");
        assert!(s.ratio < 1.1, "{}", s.ratio);
    }
}
