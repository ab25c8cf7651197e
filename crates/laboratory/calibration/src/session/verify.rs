//! The best point of each step is simulated: what an emulator promises is a promise.

use super::batch::once;
use super::proposal::digits;
use super::work::Work;
use super::{Session, Status, StepEnd, Tried};
use crate::error::Result;
use crate::fit::misfit;
use crate::trial::run::is_done;
use crate::trial::{Trial, TrialOf};

impl StepEnd<'_> {
    /// Coordinates of the fitted parameters at the best point.
    pub(crate) fn best_point(&self) -> Vec<f64> {
        match &self.best.nearer {
            Some(trial) => self.fitted.step.fit.iter().map(|&k| trial.trial.z[k]).collect(),
            None => self.best.predicted.clone(),
        }
    }
}

impl Session<'_> {
    /// Runs at the end of all steps, at most.
    pub(super) fn runs_of_best(&self) -> usize {
        if self.verify { (0..self.recipe.steps.len()).map(|k| self.runs_of_trial(k)).sum() } else { 0 }
    }

    /// Simulates the best point of each step; false: jobs are open.
    pub(super) fn verify(&self, ends: &mut [StepEnd], tried: &[Tried], work: &mut Work) -> Result<bool> {
        if !self.verify {
            return Ok(true);
        }
        // Seeds that no trial has, however early the steps ended.
        let most: usize = self.recipe.steps.iter().map(|s| s.trials).sum();
        let best = |(k, end): (usize, &StepEnd)| {
            let mut z = end.held.clone();
            end.fitted.step.fit.iter().zip(&end.best.predicted).for_each(|(&p, v)| z[p] = digits(*v));
            let number = most + 1 + k;
            self.untried(Trial { number, step: k, batch: end.widths.len(), z, of: TrialOf::Best })
        };
        let mut new: Vec<Tried> = ends.iter().enumerate().map(best).collect();
        let mut all = Vec::new();
        for (k, one) in new.iter().enumerate() {
            all.extend(self.prepare(std::slice::from_ref(one), &self.commands_of_fit(k), work)?);
        }
        let runs = once(all.iter().flatten());
        if self.list {
            work.open =
                runs.into_iter().filter(|r| !is_done(&r.file, &r.job, u64::MAX)).map(|r| r.file).collect();
            if !work.open.is_empty() {
                return Ok(false);
            }
        } else {
            self.work_off(&runs, work, "the best point")?;
        }
        for ((one, runs), end) in new.iter_mut().zip(&all).zip(ends) {
            self.collect(one, runs);
            one.misfit = misfit(self.recipe, &end.fitted.step.to, one).filter(|_| one.status == Status::Done);
            end.best.nearer = nearer(end, one.misfit, tried);
            end.best.run = Some(one.clone());
        }
        Ok(true)
    }

    /// The tests that a step fits to, one of those that share a command.
    fn commands_of_fit(&self, step: usize) -> Vec<usize> {
        let to = &self.recipe.steps[step].to;
        let fitted = |tests: &Vec<usize>| tests.iter().any(|test| to.iter().any(|part| part.test == *test));
        self.commands(step).into_iter().filter(fitted).flatten().collect()
    }
}

/// The nearest trial, where the run of the best point is farther from the data than was predicted, and than this trial.
fn nearer(end: &StepEnd, simulated: Option<f64>, tried: &[Tried]) -> Option<Tried> {
    let nearest = end.fitted.nearest()?;
    let worse = match simulated {
        Some(square) => square > nearest.misfit && end.fitted.disagrees(&end.best.predicted, square),
        None => true,
    };
    tried.iter().find(|t| worse && t.trial.number == nearest.number).cloned()
}
