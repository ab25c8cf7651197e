//! The next trials.
//!
//! One trial where the misfit may improve most (expected improvement: Jones, Schonlau & Welch 1998, doi:10.1023/A:1008306431147, of the sum of
//! squares, by drawing the components), the others where the emulator is least certain among samples of the posterior, one after the other,
//! each with what the earlier ones of the batch will tell (as in Sürer, Plumlee & Wild 2024, doi:10.1080/00401706.2023.2246157). Each eighth
//! trial is the next of the even points, whatever the posterior says.
//!
//! Where a step refines another one, most even points lie in what that one has left, and each fourth anywhere: the two may differ.

use super::Fitted;
use super::halton::Halton;
use super::region::Region;
use super::sample::{Length, Samples};
use crate::emulator::{Emulator, Gp, Prediction};
use geom::random::{generator, normal};
use nalgebra::DVector;

/// Stream of the draws.
const DRAWS: u64 = 0x65_69;
/// Candidates of a batch.
const CANDIDATES: usize = 400;
/// Draws of the components for the expected improvement.
const DRAWN: usize = 64;
/// The emulator is certain when its variance is below this share of that of data and specimens, in each component, on average over the posterior:
/// intervals are then at most a twentieth wider than with a perfect one.
const CERTAIN: f64 = 0.1;

/// A batch that is proposed.
pub(crate) struct Choice {
    /// Coordinates of the fitted parameters.
    pub points: Vec<Vec<f64>>,
    /// Whether the emulator is certain enough.
    pub certain: bool,
}

/// Even points of a step that refines another one: each of so many lies anywhere.
const ANYWHERE: usize = 4;

/// A candidate with what each process says of it.
struct Candidate {
    z: Vec<f64>,
    predictions: Vec<Prediction>,
    projections: Vec<DVector<f64>>,
}

/// The even points of a step, from the `from`-th on.
pub(crate) fn even(region: &Region, seed: u64, from: usize, count: usize) -> Vec<Vec<f64>> {
    let sequence = Halton::new(region.dimensions(), seed);
    if region.is_whole() {
        return (from..from + count).map(|k| sequence.point(k as u64)).collect();
    }
    // Both are even by themselves: digits of k are those of the coordinates.
    let anywhere = Halton::new(region.dimensions(), !seed);
    let place = |k: usize| {
        if k % ANYWHERE == ANYWHERE - 1 {
            anywhere.point((k / ANYWHERE) as u64)
        } else {
            region.at(&sequence.point((k - k / ANYWHERE) as u64))
        }
    };
    (from..from + count).map(place).collect()
}

/// Length of the chains that candidates are taken from.
pub(crate) const SHORT: Length = Length { burn: 60, keep: 120, thin: 10 };

/// Chooses a batch; `number` of trials were made so far; `seeds` of the even points and of the draws.
pub(crate) fn choose(
    fitted: &Fitted,
    samples: &Samples,
    seeds: (u64, u64),
    number: usize,
    count: usize,
) -> Choice {
    let processes: Vec<(&Gp, f64, f64)> = fitted
        .emulators
        .iter()
        .flat_map(|e| e.active.iter().map(|&k| (&e.components[k], e.noise[k], e.target[k])))
        .collect();
    let every = samples.list.len().div_ceil(CANDIDATES).max(1);
    let candidate = |z: &Vec<f64>| {
        let of = |e: &Emulator| {
            let inputs = e.inputs(z);
            e.active.iter().map(|&k| e.components[k].project(&inputs[k])).collect::<Vec<_>>()
        };
        let (predictions, projections) = fitted.emulators.iter().flat_map(of).unzip();
        Candidate { z: z.clone(), predictions, projections }
    };
    let mut candidates: Vec<Candidate> =
        samples.list.iter().step_by(every).map(|s| candidate(&s.z)).collect();
    let share = |k: usize| {
        let own = candidates.iter().map(|c| c.predictions[k].variance / (fitted.inflation + processes[k].1));
        own.sum::<f64>() / candidates.len().max(1) as f64
    };
    let certain = (0..processes.len()).map(share).fold(0.0, f64::max) < CERTAIN;
    let mut points = Vec::new();
    for k in 0..count {
        if (number + k) % 8 == 7 {
            let from = fitted.step.first + (number + k) / 8;
            points.extend(even(&fitted.region, seeds.0, from, 1));
            continue;
        }
        let free: Vec<usize> = (0..candidates.len()).filter(|&c| apart(&candidates[c].z, &points)).collect();
        let score = |c: usize| {
            if k == 0 {
                improvement(fitted, &processes, &candidates[c], seeds.1)
            } else {
                uncertainty(fitted, &processes, &candidates[c])
            }
        };
        let best =
            free.into_iter().map(|c| (score(c), c)).max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)));
        let Some((_, chosen)) = best else { break };
        points.push(candidates[chosen].z.clone());
        believe(&processes, &mut candidates, chosen);
    }
    Choice { points, certain }
}

/// Whether a point is not one of those that were chosen.
fn apart(z: &[f64], points: &[Vec<f64>]) -> bool {
    points.iter().all(|p| p.iter().zip(z).any(|(a, b)| (a - b).abs() > 1e-4))
}

/// What a trial there would tell: Σ ln(1 + v/(s² + noise)).
fn uncertainty(fitted: &Fitted, processes: &[(&Gp, f64, f64)], c: &Candidate) -> f64 {
    let pairs = c.predictions.iter().zip(processes);
    pairs.map(|(p, (_, noise, _))| libm::log1p(p.variance / (fitted.inflation + noise))).sum()
}

/// Expected improvement of the sum of squares on the best trial.
fn improvement(fitted: &Fitted, processes: &[(&Gp, f64, f64)], c: &Candidate, seed: u64) -> f64 {
    let square = |z: &[f64]| -> f64 {
        let of = |e: &Emulator| {
            let scores = e.scores(z);
            e.active.iter().map(|&k| (e.target[k] - scores[k]).powi(2)).sum::<f64>()
        };
        fitted.emulators.iter().map(of).sum()
    };
    let best = fitted.known.first().map_or(f64::INFINITY, |t| square(&t.z));
    let mut random = generator(seed, DRAWS, 0);
    let mut gain = 0.0;
    for _ in 0..DRAWN {
        let drawn = |(p, (_, _, t)): (&Prediction, &(&Gp, f64, f64))| {
            let y = p.mean + p.variance.sqrt() * normal(&mut random);
            (t - y) * (t - y)
        };
        let sum: f64 = c.predictions.iter().zip(processes).map(drawn).sum();
        gain += (best - sum).max(0.0);
    }
    gain / DRAWN as f64
}

/// Lowers the variances by what a trial at the chosen candidate will tell.
fn believe(processes: &[(&Gp, f64, f64)], candidates: &mut [Candidate], chosen: usize) {
    let (z, projections) = (candidates[chosen].z.clone(), candidates[chosen].projections.clone());
    for (k, (gp, ..)) in processes.iter().enumerate() {
        let own = candidates[chosen].predictions[k].variance + gp.noise;
        if !(own > 0.0) {
            continue;
        }
        for c in candidates.iter_mut() {
            let with = gp.covariance((&c.z, &c.projections[k]), (&z, &projections[k]));
            let p = &mut c.predictions[k];
            p.variance = (p.variance - with * with / own).max(0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a step that refines another one: both the points in the region and those anywhere are in every quarter of each coordinate.
    #[test]
    fn even_points_of_a_refining_step_are_even_by_themselves() {
        let region = Region::of(vec![[0.4, 0.8], [0.0, 0.2]]);
        for seed in 0..5 {
            let points = even(&region, seed, 0, 64);
            let (anywhere, inside): (Vec<_>, Vec<_>) =
                points.iter().enumerate().partition(|(k, _)| k % 4 == 3);
            let quarters = |points: &[(usize, &Vec<f64>)], at: usize, [low, high]: [f64; 2]| {
                let mut found = [0; 4];
                for (_, z) in points {
                    let share = (z[at] - low) / (high - low);
                    assert!((0.0..=1.0).contains(&share));
                    found[((4.0 * share) as usize).min(3)] += 1;
                }
                found.iter().all(|n| *n >= 2)
            };
            assert!((0..2).all(|at| quarters(&anywhere, at, [0.0, 1.0])), "{seed}");
            assert!(quarters(&inside, 0, [0.4, 0.8]) && quarters(&inside, 1, [0.0, 0.2]), "{seed}");
        }
    }
}
