//! What the trials in the folder tell, also those of another version: of a calibration that goes on, or with other data than when they were made.

use super::proposal::name;
use super::work::check_sizes;
use super::{Session, Standing, Status, StepEnd, Tried};
use crate::error::{CalibrateError, Result};
use crate::fit::region::Region;
use crate::fit::{Fitted, StepStart, choice, misfit};
use crate::recipe::{Step, shown};
use crate::report::judge::quantile;
use crate::trial::run::ended;
use crate::trial::{self, Trial, TrialOf, TrialRun};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// What is needed of `trial.json`.
#[derive(Deserialize)]
struct About {
    step: String,
    batch: usize,
    parameters: BTreeMap<String, f64>,
}

/// What a trial of the folder is.
enum Stored {
    /// It has a result for all tests that its step fits to, or a guard has stopped it, or it has failed.
    Result(Box<Tried>),
    /// Some runs have not ended yet.
    Open,
    /// Its runs are of another command, seed, or version of a program or file.
    Other,
}

impl<'a> Session<'a> {
    /// Judges the trials of the folder, and runs nothing. A step without enough of them, and those behind it, are left out with a warning.
    ///
    /// # Errors
    /// No folder, too few trials for the first step, other units than those of the data.
    pub fn so_far(&self) -> Result<Standing<'a>> {
        let recipe: &'a crate::Recipe = self.recipe;
        let (tried, left) = self.stored()?;
        let mut ends: Vec<StepEnd> = Vec::new();
        for (k, step) in recipe.steps.iter().enumerate() {
            let own: Vec<&Tried> = tried.iter().filter(|t| t.trial.step == k).collect();
            let held = own.first().map_or(Vec::new(), |t| t.trial.z.clone());
            let refined = step.refines.map(|r| &ends[r]);
            let (d, region) = (step.fit.len(), Region::whole(step.fit.len()));
            let place = StepStart { held: &held, region: &region, refined: refined.map(|end| &end.fitted) };
            let until = &tried[..tried.partition_point(|t| t.trial.step <= k)];
            let fitted = if own.is_empty() { None } else { Fitted::learn(recipe, step, until, &place, &[]) };
            let Some(mut fitted) = fitted else {
                let message = format!(
                    "step '{}' has {} trials so far, which are too few to learn from ({} or more that came to their end)",
                    step.name,
                    own.len(),
                    d + 2
                );
                if ends.is_empty() {
                    return Err(CalibrateError::Failed(format!("{}: {message}{left}", self.dir.display())));
                }
                self.watch.warn(&format!("{message}: it and later steps are left out"));
                break;
            };
            check_sizes(recipe, step, until)?;
            self.held_apart(step, &held, &ends);
            let first = fitted.best(&fitted.samples(self.seed(k, 0), choice::SHORT));
            let (samples, best) = self.posterior(&mut fitted, k, &first);
            let (trials, widths) = (own.len(), vec![(own.len(), self.widths(&samples))]);
            ends.push(StepEnd { fitted, samples, trials, early: false, widths, held, best });
        }
        if let Err(failures) = self.refuse_failures(&tried) {
            self.watch.warn(&failures.to_string());
        }
        let nothing = |test: &usize| tried.iter().all(|t| t.curves[*test].is_empty());
        for test in (0..recipe.tests.len()).filter(|_| self.candidates).filter(nothing) {
            self.watch
                .warn(&format!("test '{}' has no runs: --design leaves it out", recipe.tests[test].name));
        }
        Ok(Standing::Done { tried, steps: ends })
    }

    /// Warns where the trials of a step hold a parameter at another value than earlier steps find now.
    fn held_apart(&self, step: &Step, held: &[f64], ends: &[StepEnd]) {
        let tail = 0.5 * (1.0 - self.recipe.settings.interval);
        for (k, p) in self.recipe.parameters.iter().enumerate().filter(|(k, _)| !step.fit.contains(k)) {
            let fits = |end: &&StepEnd| end.fitted.step.fit.contains(&k);
            let Some(end) = ends.iter().rev().find(fits) else { continue };
            let earlier = end.fitted.step;
            let values = end.samples.sorted(earlier.fit.iter().position(|f| *f == k).unwrap_or_default());
            let [low, high] = [tail, 1.0 - tail].map(|share| quantile(&values, share));
            if held[k] < low || held[k] > high {
                self.watch.warn(&format!(
                    "step '{}': its trials hold {} = {}, and step '{}' finds {} to {} now: what it finds belongs to the value that they hold; without --so-far new trials are made",
                    step.name,
                    p.name,
                    shown(p.value(held[k])),
                    earlier.name,
                    shown(p.value(low)),
                    shown(p.value(high))
                ));
            }
        }
    }

    /// The trials of the folder that have a result, step by step, and words on those that are left out.
    fn stored(&self) -> Result<(Vec<Tried>, String)> {
        let folder = self.dir.join("trials");
        let list =
            std::fs::read_dir(&folder).map_err(crate::error::file(&folder, "no trials are there yet"))?;
        let mut numbers: Vec<usize> =
            list.filter_map(|e| e.ok()?.file_name().to_str()?.parse().ok()).collect();
        numbers.sort_unstable();
        let mut tried = Vec::new();
        let [mut of_others, mut open, mut changed] = [0; 3];
        for number in numbers {
            let folder = trial::folder(&self.dir, number);
            let of = TrialOf::Search;
            match self.about(&folder) {
                None => of_others += 1,
                Some((step, batch, z)) => match self.result(Trial { number, step, batch, z, of }, &folder) {
                    Stored::Result(one) => tried.push(*one),
                    Stored::Open => open += 1,
                    Stored::Other => changed += 1,
                },
            }
        }
        tried.sort_by_key(|t| t.trial.step);
        let kinds = [
            (of_others, "of other steps or parameters"),
            (changed, "of another command, seed, or version of a program or file"),
            (open, "whose runs have not ended"),
        ];
        let words: Vec<String> =
            kinds.iter().filter(|k| k.0 > 0).map(|k| format!("{} {}", k.0, k.1)).collect();
        if words.is_empty() {
            return Ok((tried, String::new()));
        }
        let left = format!("trials that are left out: {}", words.join(", "));
        self.watch.warn(&format!("{}: {left}", folder.display()));
        Ok((tried, format!("; {left}")))
    }

    /// Step, batch and coordinates of a trial; `None`: it is not one of this recipe.
    fn about(&self, folder: &Path) -> Option<(usize, usize, Vec<f64>)> {
        let text = std::fs::read_to_string(folder.join("trial.json")).ok()?;
        let about: About = serde_json::from_str(&text).ok()?;
        let step = self.recipe.steps.iter().position(|s| s.name == about.step)?;
        let at = |p: &crate::recipe::Parameter| {
            about.parameters.get(&p.name).map(|v| p.coordinate(*v)).filter(|z| z.is_finite())
        };
        let z: Vec<f64> = self.recipe.parameters.iter().map(at).collect::<Option<_>>()?;
        Some((step, about.batch, z))
    }

    /// What became of a trial. A test counts when all of its seeds have run.
    fn result(&self, trial: Trial, folder: &Path) -> Stored {
        let step = &self.recipe.steps[trial.step];
        let mut done: Vec<TrialRun> = Vec::new();
        let mut missing = false;
        for test in self.commands(trial.step).concat() {
            let runs = trial::runs(self.recipe, &self.dir, &trial, test);
            if runs.iter().all(|r| ended(&r.file, &r.job).is_some()) {
                done.extend(runs);
            } else {
                missing |= step.to.iter().any(|part| part.test == test);
            }
        }
        if done.is_empty() && has_results(folder) {
            return Stored::Other;
        }
        let mut tried = self.untried(trial);
        self.collect(&mut tried, &done);
        if missing && tried.status == Status::Done {
            // A trial that was spared its further tests stays so when a later batch is there.
            let (step, batch) = (tried.trial.step, tried.trial.batch);
            let is_there = |(step, batch)| self.dir.join("batches").join(name(step, batch)).exists();
            if ![(step, batch + 1), (step + 1, 0)].into_iter().any(is_there) {
                return Stored::Open;
            }
            tried.status = Status::Abandoned;
            tried.why = Some("its further tests have not run".to_owned());
        }
        tried.misfit = misfit(self.recipe, &step.to, &tried);
        Stored::Result(Box::new(tried))
    }
}

/// Whether a trial has the result of some run.
fn has_results(folder: &Path) -> bool {
    let list = std::fs::read_dir(folder).into_iter().flatten().flatten();
    list.into_iter().any(|entry| entry.path().join("result.json").exists())
}
