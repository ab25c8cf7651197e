//! What the trials tell: emulators of the curves, the posterior, and the next trials.

mod best;
pub(crate) mod choice;
mod feasible;
pub(crate) mod halton;
pub mod next;
pub(crate) mod region;
pub(crate) mod sample;
pub(crate) mod sensitivity;

use crate::emulator::{Emulator, Lessons, Logs, MOST_TRIALS, distance};
use crate::recipe::{Part, Recipe, Step};
use crate::session::{Status, Tried};
use crate::trial::Trial;
use feasible::Feasible;
use nalgebra::{DMatrix, DVector};
use region::Region;
use sample::{Length, Samples, draw};

/// Trials that chains may begin at.
const MOST_KNOWN: usize = 60;
/// Samples that the emulator's doubt is the mean of.
const DOUBTED: usize = 400;

/// Where a step begins.
pub(crate) struct StepStart<'a> {
    /// Coordinates of all parameters, for those that it holds.
    pub held: &'a [f64],
    /// Where most of its even points lie.
    pub region: &'a Region,
    /// What the step that it refines has learnt.
    pub refined: Option<&'a Fitted<'a>>,
}

/// A trial with a result.
#[derive(Debug, Clone)]
pub(crate) struct KnownTrial {
    pub number: usize,
    /// Square of its misfit.
    pub misfit: f64,
    /// Coordinates of the fitted parameters.
    pub z: Vec<f64>,
}

/// What a step has learnt.
pub(crate) struct Fitted<'a> {
    pub recipe: &'a Recipe,
    pub step: &'a Step,
    /// Where most of its even points lie.
    pub region: Region,
    /// An emulator for each part of the step.
    pub emulators: Vec<Emulator>,
    /// Where trials come to their end.
    pub feasible: Feasible,
    /// The trials that it learnt from, least misfit first.
    pub known: Vec<KnownTrial>,
    /// How much more the data deviate than they say, as a variance ≥ 1.
    pub inflation: f64,
}

/// The square of the misfit of a trial over the parts of a step: `None` where an output is missing.
pub(crate) fn misfit(recipe: &Recipe, parts: &[Part], tried: &Tried) -> Option<f64> {
    parts.iter().map(|part| part_misfit(recipe, part, tried)).sum()
}

/// The square of the misfit of a trial over one part.
pub(crate) fn part_misfit(recipe: &Recipe, part: &Part, tried: &Tried) -> Option<f64> {
    let target = recipe.tests[part.test].target.as_ref()?;
    let output = tried.outputs[part.test].as_ref()?;
    let of = target.part(part.from, part.until);
    let off = DVector::from_iterator(of.len(), of.iter().map(|&k| output[k] - target.points[k].y));
    Some(distance(&target.covariance(&of), &off))
}

/// Whether a step learns from a trial: its specimens are alike, and it differs from the held parameters only in those of the step.
fn belongs(recipe: &Recipe, step: &Step, held: &[f64], trial: &Trial) -> bool {
    let z = &trial.z;
    recipe.steps[trial.step].with == step.with
        && (0..z.len()).all(|k| step.fit.contains(&k) || (z[k] - held[k]).abs() < 1e-9)
}

/// Whether a square of a misfit is more than chance makes of so many degrees of freedom: three standard deviations of χ².
pub fn is_misfit(square: f64, free: f64) -> bool {
    square > free + 3.0 * (2.0 * free).sqrt()
}

impl<'a> Fitted<'a> {
    /// Learns from the trials of a step; `before` are the lengths of the fit before.
    pub fn learn(
        recipe: &'a Recipe,
        step: &'a Step,
        tried: &[Tried],
        place: &StepStart,
        before: &[Vec<Logs>],
    ) -> Option<Fitted<'a>> {
        let own = |z: &[f64]| -> Vec<f64> { step.fit.iter().map(|&k| z[k]).collect() };
        let mine: Vec<&Tried> =
            tried.iter().filter(|t| belongs(recipe, step, place.held, &t.trial)).collect();
        let emulator = |(k, part): (usize, &Part)| {
            let target = recipe.tests[part.test].target.as_ref()?;
            let of = target.part(part.from, part.until);
            let mut with: Vec<(f64, &Tried)> =
                mine.iter().filter_map(|t| Some((part_misfit(recipe, part, t)?, *t))).collect();
            with.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.trial.number.cmp(&b.1.trial.number)));
            with.truncate(MOST_TRIALS);
            with.sort_by_key(|w| w.1.trial.number);
            if with.len() < step.fit.len() + 2 {
                return None;
            }
            let inputs = DMatrix::from_fn(with.len(), step.fit.len(), |i, j| with[i].1.trial.z[step.fit[j]]);
            let output = |i: usize, j: usize| with[i].1.outputs[part.test].as_ref().map_or(0.0, |o| o[of[j]]);
            let seeds = if recipe.tests[part.test].is_random() { recipe.settings.seeds as f64 } else { 1.0 };
            Emulator::learn(&Lessons {
                inputs,
                outputs: DMatrix::from_fn(with.len(), of.len(), output),
                data: DVector::from_iterator(of.len(), of.iter().map(|&k| target.points[k].y)),
                covariance: target.covariance(&of),
                seeds,
                specimens: target.specimens as f64,
                random: recipe.tests[part.test].is_random(),
                before: before.get(k).map_or(&[], Vec::as_slice),
                refined: place.refined.and_then(|f| f.emulator_of(part)),
            })
        };
        let emulators: Vec<Emulator> = step.to.iter().enumerate().map(emulator).collect::<Option<_>>()?;
        let ends =
            mine.iter().filter(|t| matches!(t.status, Status::Done | Status::Abandoned | Status::Stopped));
        let feasible = Feasible::new(ends.map(|t| (own(&t.trial.z), t.status != Status::Stopped)).collect());
        let trial = |t: &&Tried| {
            let (number, z) = (t.trial.number, own(&t.trial.z));
            Some(KnownTrial { number, misfit: misfit(recipe, &step.to, t)?, z })
        };
        let mut known: Vec<KnownTrial> = mine.iter().filter_map(trial).collect();
        known.sort_by(|a, b| a.misfit.total_cmp(&b.misfit));
        let region = place.region.clone();
        Some(Fitted { recipe, step, region, emulators, feasible, known, inflation: 1.0 })
    }

    /// The emulator of a part.
    fn emulator_of(&self, part: &Part) -> Option<&Emulator> {
        self.step.to.iter().position(|p| p == part).map(|k| &self.emulators[k])
    }

    /// Logarithm of the posterior's density, up to a constant.
    pub fn log_density(&self, z: &[f64]) -> f64 {
        let likelihood: f64 = self.emulators.iter().map(|e| e.log_likelihood(z, self.inflation)).sum();
        self.log_prior(z) + likelihood + self.feasible.log_chance(z)
    }

    fn log_prior(&self, z: &[f64]) -> f64 {
        self.step.fit.iter().zip(z).map(|(&k, z)| self.recipe.parameters[k].log_prior(*z)).sum()
    }

    /// Samples of the posterior.
    pub fn samples(&self, seed: u64, length: Length) -> Samples {
        // Trials of a folder may lie outside of bounds that are narrower now.
        let inside = |z: &&Vec<f64>| z.iter().all(|z| (0.0..=1.0).contains(z));
        let known: Vec<Vec<f64>> =
            self.known.iter().map(|t| &t.z).filter(inside).take(MOST_KNOWN).cloned().collect();
        draw(&|z: &[f64]| self.log_density(z), self.step.fit.len(), &known, seed, length)
    }

    /// Square of the misfit at a point over the deviations of data, specimens and emulator, and the degrees of freedom that it should have.
    pub fn misfit(&self, z: &[f64]) -> (f64, f64) {
        let points: usize = self.emulators.iter().map(|e| e.points).sum();
        let free = (points as f64 - self.step.fit.len() as f64).max(1.0);
        (self.emulators.iter().map(|e| e.misfit(z)).sum(), free)
    }

    /// Widens the data's deviations if no point fits within them: by the ratio of Birge (1932), doi:10.1103/PhysRev.40.207. The best trial
    /// counts beside the best point, which a narrow prior may hold away from what fits.
    pub fn inflate(&mut self, best: &[f64]) {
        let (at_best, free) = self.misfit(best);
        let square = self.known.first().map_or(at_best, |t| at_best.min(self.misfit(&t.z).0));
        if is_misfit(square, free) {
            self.inflation = square / free;
        }
    }

    /// Deviation of the emulator where the parameters may lie, over that of data and specimens: root of the mean over the posterior, of the component that is known
    /// least.
    pub fn doubt(&self, samples: &Samples) -> f64 {
        let every = samples.list.len().div_ceil(DOUBTED).max(1);
        let some: Vec<&[f64]> = samples.list.iter().step_by(every).map(|s| s.z.as_slice()).collect();
        let of = |e: &Emulator| {
            let sums = some.iter().fold(vec![0.0; e.active.len()], |mut sums, z| {
                e.shares(z, self.inflation).iter().zip(&mut sums).for_each(|(share, sum)| *sum += share);
                sums
            });
            sums.into_iter().fold(0.0, f64::max) / some.len().max(1) as f64
        };
        self.emulators.iter().map(of).fold(0.0, f64::max).sqrt()
    }

    /// Lengths, to begin the next fit with, with the digits that a file keeps.
    pub fn logs(&self) -> Vec<Vec<Logs>> {
        let rounded = |v: &f64| (v * 1e4).round() / 1e4;
        self.emulators
            .iter()
            .map(|e| e.logs().iter().map(|l| l.iter().map(rounded).collect()).collect())
            .collect()
    }
}
