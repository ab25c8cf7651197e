//! Which test would tell most next.
//!
//! For each test, measured once more or for the first time: data are drawn from what the posterior expects of it, the samples of the posterior
//! are weighted by them, and the deviation of each parameter is compared with what it is now, on average over 64 draws: the preposterior
//! variance (Chaloner & Verdinelli 1995, doi:10.1214/ss/1177009939; by weights as in Huan & Marzouk 2013, doi:10.1016/j.jcp.2012.08.013).

use super::belongs;
use crate::emulator::{Emulator, Lessons};
use crate::recipe::Recipe;
use crate::session::{StepEnd, Tried};
use crate::trial::output::on_grid;
use geom::random::{generator, normal, unit};
use nalgebra::{Cholesky, DMatrix, DVector};
use serde::Serialize;

/// Draws of data, and samples of the posterior.
const DRAWS: usize = 64;
const SAMPLES: usize = 400;
/// Points of a curve that was not measured yet, and the distance over which its deviations are alike.
const POINTS: usize = 25;
const ALIKE: f64 = 0.1;
/// Stream of the draws.
const STREAM: u64 = 0x6e_78_74;

/// What a test would tell.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Next {
    pub test: String,
    /// Whether it has data already: this would be one more specimen.
    pub again: bool,
    /// Names of the parameters.
    pub parameters: Vec<String>,
    /// Deviation of each parameter with the test, over that now.
    pub ratios: Vec<f64>,
    /// Mean of the logarithms of the ratios, with the sign that more is better.
    pub gain: f64,
}

/// All tests, the most telling first.
pub fn next_tests(recipe: &Recipe, end: &StepEnd, tried: &[Tried]) -> Vec<Next> {
    let step = end.fitted.step;
    let mut all = Vec::new();
    for (k, test) in recipe.tests.iter().enumerate() {
        let measured = step.to.iter().position(|p| p.test == k);
        let found = match measured {
            Some(at) => gain(&end.fitted.emulators[at], end, recipe.settings.seed),
            None => unmeasured(recipe, end, tried, k)
                .map(|e| gain(&e, end, recipe.settings.seed))
                .unwrap_or_default(),
        };
        if found.is_empty() {
            continue;
        }
        let gain = -found.iter().map(|r| libm::log(r.max(1e-6))).sum::<f64>() / found.len() as f64;
        let parameters = step.fit.iter().map(|&k| recipe.parameters[k].name.clone()).collect();
        all.push(Next {
            test: test.name.clone(),
            again: test.target.is_some(),
            parameters,
            ratios: found,
            gain,
        });
    }
    all.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    all
}

/// An emulator of a test without data, on even points of the range that all its curves have.
fn unmeasured(recipe: &Recipe, end: &StepEnd, tried: &[Tried], test: usize) -> Option<Emulator> {
    let (of, step) = (&recipe.tests[test], end.fitted.step);
    let belongs = |t: &&Tried| belongs(recipe, step, &end.held, &t.trial);
    let with: Vec<&Tried> = tried.iter().filter(belongs).filter(|t| !t.curves[test].is_empty()).collect();
    let curves = || with.iter().flat_map(|t| t.curves[test].iter());
    let first = curves().filter_map(|c| c.first()).map(|p| p.0).fold(f64::NEG_INFINITY, f64::max);
    let last = curves().filter_map(|c| c.last()).map(|p| p.0).fold(f64::INFINITY, f64::min);
    let count = if of.x.is_some() { POINTS } else { 1 };
    if with.len() < step.fit.len() + 3 || of.x.is_some() && !(last > first) {
        return None;
    }
    let grid: Vec<f64> =
        (0..count).map(|k| first + (last - first) * k as f64 / (count - 1).max(1) as f64).collect();
    let places: Vec<Vec<f64>> = grid.iter().map(|x| vec![*x]).collect();
    let row = |t: &Tried| {
        let all: Vec<Vec<f64>> =
            t.curves[test].iter().filter_map(|c| on_grid(c, &places, of.x.is_none()).ok()).collect();
        (0..count).map(|k| all.iter().map(|c| c[k]).sum::<f64>() / all.len() as f64).collect::<Vec<f64>>()
    };
    let rows: Vec<Vec<f64>> = with.iter().map(|t| row(t)).collect();
    let size = rows.iter().flatten().fold(0.0, |a: f64, v| a.max(v.abs()));
    let deviation = of.deviation? * if of.share { size } else { 1.0 };
    let length = (last - first).max(1e-300);
    let covariance = DMatrix::from_fn(count, count, |i, j| {
        deviation * deviation * libm::exp(-(grid[i] - grid[j]).abs() / (ALIKE * length))
    });
    // The least misfit comes first: its curve stands for the data that are not there.
    let best = with
        .iter()
        .enumerate()
        .min_by(|a, b| a.1.misfit.unwrap_or(f64::INFINITY).total_cmp(&b.1.misfit.unwrap_or(f64::INFINITY)))?
        .0;
    Emulator::learn(&Lessons {
        inputs: DMatrix::from_fn(with.len(), step.fit.len(), |i, j| with[i].trial.z[step.fit[j]]),
        outputs: DMatrix::from_fn(with.len(), count, |i, j| rows[i][j]),
        data: DVector::from_column_slice(&rows[best]),
        covariance,
        seeds: if of.is_random() { recipe.settings.seeds as f64 } else { 1.0 },
        specimens: 1.0,
        random: of.is_random(),
        before: &[],
        refined: None,
    })
}

/// Expected deviation of each parameter with a test, over that now.
fn gain(emulator: &Emulator, end: &StepEnd, seed: u64) -> Vec<f64> {
    let every = end.samples.list.len().div_ceil(SAMPLES).max(1);
    let z: Vec<&Vec<f64>> = end.samples.list.iter().step_by(every).map(|s| &s.z).collect();
    let scores: Vec<DVector<f64>> = z.iter().map(|z| emulator.telling(z)).collect();
    let Some(chol) = Cholesky::new(emulator.scatter(end.fitted.inflation)) else { return Vec::new() };
    let factor = chol.l();
    let (d, mut random) = (z[0].len(), generator(seed, STREAM, 0));
    let even = vec![1.0; z.len()];
    let mut sum = vec![0.0; d];
    for _ in 0..DRAWS {
        let truth = (unit(&mut random) * z.len() as f64) as usize;
        let noise = DVector::from_fn(factor.nrows(), |_, _| normal(&mut random));
        let data = &scores[truth] + &factor * noise;
        let square = |s: &DVector<f64>| {
            factor.solve_lower_triangular(&(&data - s)).map_or(f64::INFINITY, |w| w.norm_squared())
        };
        let squares: Vec<f64> = scores.iter().map(square).collect();
        let least = squares.iter().copied().fold(f64::INFINITY, f64::min);
        let weights: Vec<f64> = squares.iter().map(|s| libm::exp(-0.5 * (s - least))).collect();
        (0..d).for_each(|k| sum[k] += variance(&z, &weights, k) / DRAWS as f64);
    }
    (0..d).map(|k| (sum[k] / variance(&z, &even, k).max(1e-300)).sqrt().min(1.0)).collect()
}

fn variance(z: &[&Vec<f64>], weights: &[f64], k: usize) -> f64 {
    let all: f64 = weights.iter().sum();
    let mean = z.iter().zip(weights).map(|(z, w)| w * z[k]).sum::<f64>() / all;
    z.iter().zip(weights).map(|(z, w)| w * (z[k] - mean).powi(2)).sum::<f64>() / all
}
