//! What the trials in the folder tell, whoever proposed them: of a calibration that goes on, or with other data than when they were made.

use super::{LONG, SEEDS, Session, Standing, Status, StepEnd, Tried};
use crate::error::{CalibrateError, Result};
use crate::fit::region::Region;
use crate::fit::{Fitted, Place, misfit};
use crate::trial::run::{Hashes, ended};
use crate::trial::{self, Run, Trial};
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

impl<'a> Session<'a> {
    /// Judges the trials of the folder, and runs nothing. A step without enough of them, and those behind it, are left out with a warning.
    ///
    /// # Errors
    /// No folder, or too few trials for the first step.
    pub fn so_far(&self) -> Result<Standing<'a>> {
        let recipe: &'a crate::Recipe = self.recipe;
        let tried = self.stored()?;
        let mut ends: Vec<StepEnd> = Vec::new();
        for (k, step) in recipe.steps.iter().enumerate() {
            let own = tried.iter().filter(|t| t.trial.step == k);
            let trials = own.clone().count();
            let held = own.clone().next().map_or(Vec::new(), |t| t.trial.z.clone());
            let refined = step.refines.map(|r| &ends[r]);
            let (d, region) = (step.fit.len(), Region::whole(step.fit.len()));
            let place = Place { held: &held, region: &region, refined: refined.map(|end| &end.fitted) };
            let until: Vec<Tried> = tried.iter().filter(|t| t.trial.step <= k).cloned().collect();
            let fitted = if trials == 0 { None } else { Fitted::learn(recipe, step, &until, &place, &[]) };
            let Some(mut fitted) = fitted else {
                let message = format!(
                    "step '{}' has {trials} trials so far, which are too few to learn from ({} or more that came to their end)",
                    step.name,
                    d + 2
                );
                if ends.is_empty() {
                    return Err(CalibrateError::Failed(format!("{}: {message}", self.dir.display())));
                }
                self.watch.warn(&format!("{message}: it and later steps are left out"));
                break;
            };
            let seed = recipe.settings.seed ^ SEEDS ^ k as u64;
            let best = fitted.samples(seed, LONG).best;
            fitted.inflate(&best.z);
            let samples = fitted.samples(seed, LONG);
            let widths = vec![(trials, self.widths(&samples))];
            ends.push(StepEnd { fitted, samples, trials, early: false, widths, held });
        }
        Ok(Standing::Done { tried, steps: ends })
    }

    /// The trials of the folder that have a result.
    fn stored(&self) -> Result<Vec<Tried>> {
        let folder = self.dir.join("trials");
        let list =
            std::fs::read_dir(&folder).map_err(crate::error::file(&folder, "no trials are there yet"))?;
        let mut numbers: Vec<usize> =
            list.filter_map(|e| e.ok()?.file_name().to_str()?.parse().ok()).collect();
        numbers.sort_unstable();
        let (mut hashes, mut others) = (Hashes::default(), 0);
        let mut tried = Vec::new();
        for number in numbers {
            match self.about(&trial::folder(&self.dir, number)) {
                None => others += 1,
                Some((step, batch, z)) => {
                    tried.extend(self.result(Trial { number, step, batch, z }, &mut hashes));
                }
            }
        }
        if others > 0 {
            self.watch.warn(&format!(
                "{}: {others} trials of other steps or parameters are left out",
                folder.display()
            ));
        }
        Ok(tried)
    }

    /// Step, batch and coordinates of a trial; `None`: it is not one of this recipe.
    fn about(&self, folder: &Path) -> Option<(usize, usize, Vec<f64>)> {
        let text = std::fs::read_to_string(folder.join("trial.json")).ok()?;
        let about: About = serde_json::from_str(&text).ok()?;
        let step = self.recipe.steps.iter().position(|s| s.name == about.step)?;
        let at = |p: &crate::recipe::Parameter| about.parameters.get(&p.name).map(|v| p.coordinate(*v));
        let z: Vec<f64> = self.recipe.parameters.iter().map(at).collect::<Option<_>>()?;
        Some((step, about.batch, z))
    }

    /// What became of a trial; `None`: none of its runs has ended, or they were those of another command.
    fn result(&self, trial: Trial, hashes: &mut Hashes) -> Option<Tried> {
        let step = &self.recipe.steps[trial.step];
        let tests = self.commands(trial.step).concat();
        let all: Vec<Run> = tests
            .iter()
            .flat_map(|&test| trial::runs(self.recipe, &self.dir, &trial, test, hashes))
            .collect();
        let (done, open): (Vec<Run>, Vec<Run>) =
            all.into_iter().partition(|r| ended(&r.file, &r.job).is_some());
        if done.is_empty() {
            return None;
        }
        let mut tried = self.untried(trial);
        self.collect(&mut tried, &done);
        if !open.is_empty() && tried.status == Status::Done {
            tried.status = Status::Abandoned;
            tried.why = Some("not all of its tests have run".to_owned());
        }
        tried.misfit = misfit(self.recipe, &step.to, &tried);
        Some(tried)
    }
}
