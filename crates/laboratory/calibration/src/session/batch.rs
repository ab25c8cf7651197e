//! A batch: its runs, their results, and what they cost.

use super::proposal::Proposal;
use super::work::Work;
use super::{Session, Status, Tried, table};
use crate::error::{CalibrateError, Result};
use crate::fit::{misfit, part_misfit};
use crate::recipe::Step;
use crate::trial::output::{TrialOutput, on_grid, outcome};
use crate::trial::pool::Pool;
use crate::trial::run::{Ended, is_done, is_outdated, tools};
use crate::trial::{self, Trial, TrialOf, TrialRun};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

/// Failures without any success that end a calibration at once.
const HOPELESS: usize = 3;

impl Session<'_> {
    /// The tests that a step runs: those that it fits to; in the last step all, if `--design` is to compare them. Tests with the same command stand
    /// together: what one of them runs tells of all.
    pub(super) fn commands(&self, step: usize) -> Vec<Vec<usize>> {
        let last = step + 1 == self.recipe.steps.len();
        let to = &self.recipe.steps[step].to;
        let asked = |test: usize| last && self.candidates || to.iter().any(|part| part.test == test);
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for test in 0..self.recipe.tests.len() {
            let first = self.recipe.first_with_command_of(test);
            match groups.iter_mut().find(|g| self.recipe.first_with_command_of(g[0]) == first) {
                Some(group) => group.push(test),
                None => groups.push(vec![test]),
            }
        }
        groups.retain(|group| group.iter().any(|test| asked(*test)));
        groups
    }

    /// Runs of a trial of a step, at most.
    pub(super) fn runs_of_trial(&self, step: usize) -> usize {
        let runs = |test: usize| {
            if self.recipe.tests[test].is_random() { self.recipe.settings.seeds as usize } else { 1 }
        };
        self.commands(step).iter().map(|tests| runs(tests[0])).sum()
    }

    /// A trial before its runs.
    pub(super) fn untried(&self, trial: Trial) -> Tried {
        Tried {
            trial,
            outputs: vec![None; self.recipe.tests.len()],
            curves: vec![Vec::new(); self.recipe.tests.len()],
            status: Status::Done,
            why: None,
            cut: None,
            seconds: 0.0,
            misfit: None,
        }
    }

    /// Makes the trials of a proposal; false: jobs are open.
    pub(super) fn try_all(
        &self,
        proposal: &Proposal,
        of: (usize, usize),
        known: (&mut Vec<Tried>, &[f64]),
        work: &mut Work,
    ) -> Result<bool> {
        let (tried, held) = known;
        let step = &self.recipe.steps[of.0];
        let number = tried.len();
        let trial = |(k, point): (usize, &Vec<f64>)| {
            let mut z = held.to_vec();
            step.fit.iter().zip(point).for_each(|(&p, v)| z[p] = *v);
            Trial { number: number + k + 1, step: of.0, batch: of.1, z, of: TrialOf::Search }
        };
        let mut new: Vec<Tried> =
            proposal.points.iter().enumerate().map(trial).map(|t| self.untried(t)).collect();
        let alike = |t: &&Tried| self.recipe.steps[t.trial.step].with == step.with;
        let best = tried
            .iter()
            .filter(alike)
            .filter_map(|t| misfit(self.recipe, &step.to, t))
            .fold(f64::INFINITY, f64::min);
        // After the first batch, commands run one after the other, so that hopeless trials are seen early.
        let commands = self.commands(of.0);
        let phases =
            if of.1 == 0 || self.recipe.settings.abandon == 0.0 { vec![commands.concat()] } else { commands };
        for (k, tests) in phases.iter().enumerate() {
            let runs = self.prepare(&new, tests, work)?;
            if self.list {
                let open: Vec<PathBuf> = once(runs.iter().flatten())
                    .into_iter()
                    .filter(|r| !is_done(&r.file, &r.job, u64::MAX))
                    .map(|r| r.file)
                    .collect();
                if !open.is_empty() {
                    work.open = open;
                    return Ok(false);
                }
            } else {
                self.work_off(&once(runs.iter().flatten()), work, &step.name)?;
            }
            for (tried, runs) in new.iter_mut().zip(&runs) {
                self.collect(tried, runs);
                if k + 1 < phases.len() {
                    self.abandon(step, tried, best);
                }
            }
        }
        for t in &mut new {
            t.misfit = misfit(self.recipe, &step.to, t);
        }
        tried.append(&mut new);
        trial::replace(&self.dir.join("trials.csv"), table(self.recipe, tried).as_bytes())?;
        self.refuse_failures(tried)?;
        Ok(true)
    }

    /// Writes the jobs of the trials that are still hopeful: for each trial its runs.
    pub(super) fn prepare(
        &self,
        new: &[Tried],
        tests: &[usize],
        work: &mut Work,
    ) -> Result<Vec<Vec<TrialRun>>> {
        let mut all = Vec::new();
        for t in new {
            let mut runs = Vec::new();
            if t.status == Status::Done {
                for &test in tests {
                    runs.extend(trial::runs(self.recipe, &self.dir, &t.trial, test));
                }
                // Another best point is another command, which is no news.
                if t.trial.of == TrialOf::Search {
                    self.say_what_is_used_again(&runs, work);
                }
                if runs.iter().any(|r| !is_done(&r.file, &r.job, work.since)) {
                    trial::write(self.recipe, &self.dir, &t.trial, &runs)?;
                }
            }
            all.push(runs);
        }
        Ok(all)
    }

    /// Says once that runs are made again, and once what of runs that are used again cannot be known.
    fn say_what_is_used_again(&self, runs: &[TrialRun], work: &mut Work) {
        let dir = self.dir.display();
        if !work.outdated && runs.iter().any(|r| is_outdated(&r.file, &r.job)) {
            work.outdated = true;
            self.watch.warn(&format!(
                "{dir}: runs there were made from other files, commands or programs: they are made again"
            ));
        }
        let tools = tools();
        let known = |program: &str| tools.join(program).is_file();
        let used = runs.iter().filter(|r| is_done(&r.file, &r.job, work.since));
        let more =
            |run: &TrialRun| Some((run.job.test.clone(), stream::reads_more(&run.job.command, known)?));
        if let Some((test, word)) = used.filter(|_| !work.unknown).find_map(more) {
            work.unknown = true;
            self.watch.warn(&format!(
                "{dir}: runs there are used again; test '{test}' has '{word}', which may read files that its line does not name: remove the folder where such a \
                 file has changed"
            ));
        }
    }

    pub(super) fn work_off(&self, runs: &[TrialRun], work: &Work, step: &str) -> Result<()> {
        let open: Vec<TrialRun> =
            runs.iter().filter(|r| !is_done(&r.file, &r.job, work.since)).cloned().collect();
        let (done, total) = work.found(runs.len() - open.len());
        self.watch.progress(done, total, step);
        let give_up = AtomicBool::new(false);
        let ended = |_: &TrialRun, ended: &Ended| {
            let now = work.ended(ended, self.jobs);
            self.watch.progress(now.done, total, step);
            if now.all_failed && now.done >= HOPELESS {
                give_up.store(true, Ordering::SeqCst);
            }
            if let Some(rate) = now.rate {
                self.watch.tell(&rate);
            }
        };
        Pool { jobs: self.jobs, stop: self.stop, since: work.since, ended: &ended, give_up: &give_up }
            .run(&open)?;
        if give_up.load(Ordering::SeqCst) {
            let failed = runs.iter().find_map(|r| match outcome(r, &self.recipe.tests[r.test]) {
                TrialOutput::Failed(why) => Some((r, why)),
                _ => None,
            });
            if let Some((run, why)) = failed {
                let folder = trial::run::folder(&run.file);
                let message = format!(
                    "the first {HOPELESS} runs have all failed, this one: {why}: try its command.sh in this folder"
                );
                return Err(CalibrateError::Folder { folder, message });
            }
        }
        Ok(())
    }

    /// Reads what the runs of a trial printed.
    pub(super) fn collect(&self, tried: &mut Tried, runs: &[TrialRun]) {
        for ended in once(runs).iter().filter_map(|run| trial::run::ended(&run.file, &run.job)) {
            tried.seconds += ended.seconds;
            if ended.exit == 0
                && let Some(stop) = ended.stops.into_iter().next()
            {
                tried.cut.get_or_insert(stop.stopped);
            }
        }
        for run in runs {
            match outcome(run, &self.recipe.tests[run.test]) {
                TrialOutput::Done(curve) => tried.curves[run.test].push(curve),
                TrialOutput::Stopped(why) => note(tried, Status::Stopped, why),
                TrialOutput::Failed(why) => note(tried, Status::Failed, why),
                TrialOutput::Missing => {
                    let why = "it has no result, or files that it has read have changed since";
                    note(tried, Status::Failed, why.to_owned());
                }
            }
        }
        for test in 0..self.recipe.tests.len() {
            let of = &self.recipe.tests[test];
            let Some(target) = &of.target else { continue };
            if tried.curves[test].is_empty() || tried.outputs[test].is_some() {
                continue;
            }
            let values: Result<Vec<Vec<f64>>, String> =
                tried.curves[test].iter().map(|c| on_grid(c, &target.places, of.x.is_none())).collect();
            match values {
                Ok(values) => tried.outputs[test] = Some(mean(&values)),
                Err(why) => note(tried, Status::Failed, format!("test '{}': {why}", of.name)),
            }
        }
    }

    /// A trial whose first tests are hopeless is spared the others.
    fn abandon(&self, step: &Step, tried: &mut Tried, best: f64) {
        if tried.status != Status::Done {
            return;
        }
        let known: f64 = step.to.iter().filter_map(|part| part_misfit(self.recipe, part, tried)).sum();
        if 0.5 * (known - best) > self.recipe.settings.abandon {
            note(tried, Status::Abandoned, "its first tests are far from the data".to_owned());
        }
    }

    pub(super) fn refuse_failures(&self, tried: &[Tried]) -> Result<()> {
        let failed: Vec<&Tried> = tried.iter().filter(|t| t.status == Status::Failed).collect();
        let (n, all) = (failed.len(), tried.len());
        if n as f64 <= self.recipe.settings.failures * all as f64 {
            return Ok(());
        }
        let first = failed[0];
        let message = format!(
            "{n} of {all} trials have failed (settings.failures allows {} %), this one: {}: the same command tries them again",
            geom::Shown(100.0 * self.recipe.settings.failures),
            first.why.as_deref().unwrap_or("")
        );
        Err(CalibrateError::Folder { folder: first.trial.folder(&self.dir), message })
    }
}

/// Runs that tests share, each once.
pub(super) fn once<'a>(runs: impl IntoIterator<Item = &'a TrialRun>) -> Vec<TrialRun> {
    let mut files = std::collections::BTreeSet::new();
    runs.into_iter().filter(|r| files.insert(&r.file)).cloned().collect()
}

fn note(tried: &mut Tried, status: Status, why: String) {
    tried.status = status;
    tried.why.get_or_insert(why);
}

fn mean(values: &[Vec<f64>]) -> Vec<f64> {
    let n = values.len() as f64;
    (0..values[0].len()).map(|k| values.iter().map(|v| v[k]).sum::<f64>() / n).collect()
}
