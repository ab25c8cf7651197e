//! What goes on between batches: how much is done, how long it takes, and whether results have the units of the data.

use super::{Session, Tried, duration};
use crate::error::{CalibrateError, Result};
use crate::recipe::{Recipe, Step};
use crate::trial::run::Ended;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Runs of a step that are measured before its rate is printed; it is printed again after the first batch, whose runs are those of all parameters.
const MEASURED: usize = 4;
/// Trials that are all this many times as large as the data have other units.
const OTHER_UNITS: f64 = 100.0;

/// What goes on between batches.
pub(super) struct Work {
    /// Jobs to be run by others.
    pub open: Vec<PathBuf>,
    /// Whether it was said that runs are made again, and what of them cannot be known.
    pub outdated: bool,
    pub unknown: bool,
    /// Failures after this time [s since 1970] count.
    pub since: u64,
    /// Runs of each step, at most.
    steps: Vec<usize>,
    /// Runs of the best points.
    best: usize,
    count: Mutex<Count>,
}

/// Runs so far.
#[derive(Default)]
struct Count {
    done: usize,
    /// Those of this process, and how many of them failed.
    own: usize,
    failed: usize,
    /// The step, what is done of it, and those of this process: their number and time [s].
    step: usize,
    of_step: usize,
    measured: (usize, f64),
    told: bool,
}

/// Where the runs stand when one has ended.
pub(super) struct Now {
    pub done: usize,
    /// Whether none has come to an end yet, and all are of this process.
    pub all_failed: bool,
    /// How long it will take, once.
    pub rate: Option<String>,
}

impl Work {
    pub fn new(session: &Session, since: u64) -> Work {
        let runs = |(k, step): (usize, &Step)| step.trials * session.runs_of_trial(k);
        Work {
            outdated: false,
            unknown: false,
            open: Vec::new(),
            since,
            best: session.runs_of_best(),
            steps: session.recipe.steps.iter().enumerate().map(runs).collect(),
            count: Mutex::default(),
        }
    }

    fn lock(&self) -> MutexGuard<'_, Count> {
        self.count.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A step begins. One that ended early leaves its other runs out.
    pub fn begin(&mut self, step: usize) {
        let count = self.count.get_mut().unwrap_or_else(PoisonError::into_inner);
        if step > 0 {
            self.steps[step - 1] = count.of_step;
        }
        *count = Count { done: count.done, own: count.own, failed: count.failed, step, ..Count::default() };
    }

    /// Counts runs that were done before: how many are done, and how many there are at most.
    pub fn found(&self, done: usize) -> (usize, usize) {
        let mut count = self.lock();
        count.done += done;
        count.of_step += done;
        (count.done, self.steps.iter().sum::<usize>() + self.best)
    }

    /// Counts a run of this process.
    pub fn ended(&self, ended: &Ended, jobs: usize) -> Now {
        let mut count = self.lock();
        count.done += 1;
        count.of_step += 1;
        count.own += 1;
        count.failed += usize::from(!ended.is_final());
        count.measured = (count.measured.0 + 1, count.measured.1 + ended.seconds);
        let tell = !count.told && count.measured.0 >= MEASURED.max(2 * jobs);
        count.told |= tell;
        Now {
            done: count.done,
            all_failed: count.failed == count.own && count.done == count.own,
            rate: tell.then(|| self.rate(&count, jobs)),
        }
    }

    /// How long the step will take, by the runs so far; `None` where these were measured before.
    pub fn rate_again(&self, jobs: usize) -> Option<String> {
        let count = self.lock();
        (count.measured.0 > MEASURED.max(2 * jobs)).then(|| self.rate(&count, jobs))
    }

    fn rate(&self, count: &Count, jobs: usize) -> String {
        let (runs, seconds) = count.measured;
        let each = seconds / runs as f64;
        let left = self.steps[count.step].saturating_sub(count.of_step);
        let later: usize = self.steps[count.step + 1..].iter().sum();
        let time = duration(left as f64 * each / jobs as f64);
        let (of_step, later) = match self.steps.len() {
            1 => ("", String::new()),
            _ if later == 0 => (" of this step", String::new()),
            _ => (" of this step", format!("; later steps have {later} runs at most")),
        };
        format!(
            "measured: {} a run, {jobs} at the same time; at most {left} runs{of_step} are left: {time}{later}",
            duration(each)
        )
    }
}

/// Refuses units that cannot be those of the data.
pub(super) fn check_sizes(recipe: &Recipe, step: &Step, tried: &[Tried]) -> Result<()> {
    for part in &step.to {
        let test = &recipe.tests[part.test];
        let Some(target) = &test.target else { continue };
        let sizes: Vec<f64> = tried
            .iter()
            .filter_map(|t| t.outputs[part.test].as_ref())
            .map(|o| o.iter().fold(0.0, |a: f64, v| a.max(v.abs())))
            .collect();
        let ratio = |s: &f64| s / target.size();
        let small = sizes.iter().map(ratio).fold(f64::INFINITY, f64::min);
        let large = sizes.iter().map(ratio).fold(0.0, f64::max);
        if sizes.is_empty() || large > 1.0 / OTHER_UNITS && small < OTHER_UNITS {
            continue;
        }
        let message = format!(
            "its trials are {} to {} times as large as the data: are the units the same? Name them: y_unit is that of the command, 'column [kPa]' that of the data",
            geom::Shown(small),
            geom::Shown(large)
        );
        return Err(CalibrateError::Test { test: test.name.clone(), message });
    }
    Ok(())
}
