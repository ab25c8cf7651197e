//! How well a step fits: what the emulator promises, what a run of the best point shows, and which trial is nearest.

use crate::fit::is_misfit;
use crate::recipe::Recipe;
use crate::session::{StepEnd, Tried};
use serde::Serialize;

/// Share of the spread of all trials by which those that are left out are missed, from which there are too few trials.
const UNSEEN: f64 = 0.3;
/// Trials a parameter, from which the spread of all trials no longer counts: trials far from the data scatter more than those near it.
const ENOUGH: usize = 10;
/// Deviation of the emulator over that of the data, where the parameters may lie, from which it limits the intervals.
const DOUBT: f64 = 1.0;

/// A run near the data.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Nearest {
    /// Number of the trial; absent: the run of the best point.
    pub trial: Option<usize>,
    /// Square of its misfit.
    pub misfit: f64,
    /// Name, value and unit of the fitted parameters.
    pub parameters: Vec<(String, f64, String)>,
}

/// How well a step fits.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StepFit {
    /// Its name.
    pub step: String,
    pub trials: usize,
    /// Number of its parameters.
    pub parameters: usize,
    /// Whether it ended early, because more trials would tell nothing.
    pub early: bool,
    /// Square of the misfit that the emulator expects of a run of its best point, over the deviations of the data.
    pub misfit: f64,
    /// That of a run of this point; absent: there was none, or it has no result.
    pub simulated: Option<f64>,
    /// Why such a run has no result.
    pub no_result: Option<String>,
    /// Whether the run is farther from what was expected than the emulator allows.
    pub surprise: bool,
    /// Number of the trial that stands as best, because the run is no nearer than it.
    pub best_is_trial: Option<usize>,
    /// Square of the misfit that is expected of the true parameters: points less parameters, and the scatter of runs.
    pub free: f64,
    /// The most of it: three standard deviations above.
    pub most: f64,
    /// Whether a run reproduces the data within that; where the best point has no run, whether it or a trial is expected to.
    pub fits: bool,
    /// The run with the least misfit.
    pub nearest: Option<Nearest>,
    /// Whether priors hold the best point away from values that fit.
    pub held_by_priors: bool,
    /// By how much the deviations of the data were widened.
    pub widened: f64,
    /// Ratio R̂ of the chains.
    pub chains: f64,
    /// By how much trials that are left out are missed, over the spread of all trials, of the test that is known least.
    pub unseen: f64,
    /// Deviation of the emulator where the parameters may lie, over that of data and specimens.
    pub doubt: f64,
}

impl StepFit {
    /// Whether the emulator is too unsure for what is said of fits and bounds.
    pub fn too_few(&self) -> bool {
        self.doubt > DOUBT || self.unseen > UNSEEN && self.is_short()
    }

    /// Whether it has fewer trials a parameter than a calibration usually needs.
    pub fn is_short(&self) -> bool {
        self.trials < ENOUGH * self.parameters
    }
}

/// How well a step fits.
pub(super) fn step_fit(recipe: &Recipe, end: &StepEnd) -> StepFit {
    let (fitted, best) = (&end.fitted, &end.best);
    let (misfit, allowed) = (fitted.expected(&best.predicted).mean, fitted.allowed());
    let simulated = best.run.as_ref().and_then(|run| run.misfit);
    let nearest = nearest(recipe, end);
    let least = nearest.as_ref().map_or(f64::INFINITY, |n| n.misfit);
    let promised = if best.run.is_none() { misfit } else { f64::INFINITY };
    let (over_all, free) = fitted.misfit(&best.predicted);
    StepFit {
        step: fitted.step.name.clone(),
        trials: end.trials,
        parameters: fitted.step.fit.len(),
        early: end.early,
        misfit,
        simulated,
        no_result: best.run.as_ref().filter(|run| run.misfit.is_none()).map(why),
        surprise: simulated.is_some_and(|square| fitted.disagrees(&best.predicted, square)),
        best_is_trial: best.nearer.as_ref().map(|t| t.trial.number),
        free: allowed.mean,
        most: allowed.most,
        fits: least.min(promised) <= allowed.most,
        nearest,
        held_by_priors: fitted.inflation == 1.0 && is_misfit(over_all, free),
        widened: fitted.inflation.sqrt(),
        chains: end.samples.ratio,
        unseen: fitted.emulators.iter().map(|e| e.unseen).fold(0.0, f64::max),
        doubt: fitted.doubt(&end.samples),
    }
}

fn why(run: &Tried) -> String {
    run.why.clone().unwrap_or_else(|| "it gave no reason".to_owned())
}

/// The run with the least misfit, of the trials and of the best point.
fn nearest(recipe: &Recipe, end: &StepEnd) -> Option<Nearest> {
    let fit = &end.fitted.step.fit;
    let of = |trial: Option<usize>, misfit: f64, z: &[f64]| {
        let values = fit.iter().zip(z).map(|(&k, z)| {
            let p = &recipe.parameters[k];
            (p.name.clone(), p.value(*z), p.unit.clone())
        });
        Nearest { trial, misfit, parameters: values.collect() }
    };
    let trial = end.fitted.nearest().map(|t| of(Some(t.number), t.misfit, &t.z));
    let run = end.best.run.as_ref().and_then(|run| Some(of(None, run.misfit?, &end.best.predicted)));
    [trial, run].into_iter().flatten().min_by(|a, b| a.misfit.total_cmp(&b.misfit))
}
