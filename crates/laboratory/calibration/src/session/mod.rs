//! A calibration through its steps: batches of trials, what they tell, and the next batch.
//!
//! What a batch proposes depends on the recipe and on the results before it only, not on time: a killed calibration that goes on comes to the
//! same end. Each proposal is kept in `DIR/batches`, so that several machines that share the folder work on the same one.

mod batch;
mod proposal;
mod record;
mod so_far;
mod verify;
mod work;

pub(crate) use record::{Best, cell};
pub use record::{Status, Tried, table};

use crate::error::{CalibrateError, Result};
use crate::fit::sample::Length;
use crate::fit::{Fitted, StepStart, choice, region::Region, sample::Samples};
use crate::recipe::{Recipe, Step};
use crate::trial::run;
use proposal::Proposal;
use std::path::PathBuf;

/// An observer.
pub trait Watch: Sync {
    /// A sentence.
    fn tell(&self, words: &str);
    fn warn(&self, words: &str);
    /// So many of so many runs are done, and what is done now.
    fn progress(&self, done: usize, total: usize, now: &str);
}

/// How a calibration is carried out.
pub struct Session<'a> {
    pub recipe: &'a Recipe,
    /// Folder of the trials.
    pub dir: PathBuf,
    /// Runs at the same time.
    pub jobs: usize,
    /// Whether a signal asked to stop.
    pub stop: fn() -> bool,
    /// The observer.
    pub watch: &'a dyn Watch,
    /// Whether jobs are listed instead of run.
    pub list: bool,
    /// Whether tests without data are simulated, too.
    pub candidates: bool,
    /// Whether the best point of each step is simulated at the end.
    pub verify: bool,
}

/// What a step came to.
pub struct StepEnd<'a> {
    pub(crate) fitted: Fitted<'a>,
    pub(crate) samples: Samples,
    /// Trials of the step.
    pub trials: usize,
    /// Whether it ended before its trials were used up.
    pub early: bool,
    /// Width of the intervals in z after each batch: number of trials, and a width for each fitted parameter.
    pub widths: Vec<(usize, Vec<f64>)>,
    /// Coordinates of the parameters that it held.
    pub held: Vec<f64>,
    pub(crate) best: Best,
}

/// Where a calibration stands.
pub enum Standing<'a> {
    Done {
        /// All trials.
        tried: Vec<Tried>,
        steps: Vec<StepEnd<'a>>,
    },
    /// These jobs are to be run before it goes on.
    Open(Vec<PathBuf>),
}

/// Length of the chains of the final posterior.
const LONG: Length = Length { burn: 300, keep: 2400, thin: 8 };
/// Stream of the seeds of chains.
const SEEDS: u64 = 0x9e37_79b9;

impl<'a> Session<'a> {
    /// Carries it out.
    ///
    /// # Errors
    /// A signal, a folder that cannot be written to, too many failed trials, curves that cannot be compared.
    pub fn run(&self) -> Result<Standing<'a>> {
        std::fs::create_dir_all(self.dir.join("batches"))
            .map_err(crate::error::file(&self.dir, "cannot create the folder"))?;
        [self.dir.clone(), self.dir.join("batches")].iter().for_each(|f| jobs::clear_parts(f));
        let recipe: &'a Recipe = self.recipe;
        if let Some((name, test)) = recipe.open_blank().filter(|_| self.candidates) {
            let message = format!(
                "--design runs every test in the last step, and nothing fills the blank {{{name}}} of test '{test}' there: add with = {{ {name} = … }}"
            );
            return Err(CalibrateError::Usage(message));
        }
        let mut work = work::Work::new(self, run::now());
        let (mut tried, mut ends): (Vec<Tried>, Vec<StepEnd>) = (Vec::new(), Vec::new());
        let mut held: Vec<f64> =
            recipe.parameters.iter().map(|p| p.coordinate(p.start).clamp(0.0, 1.0)).collect();
        for (k, step) in recipe.steps.iter().enumerate() {
            let d = step.fit.len();
            let refined = step.refines.map(|r| &ends[r]);
            let region = refined.map_or_else(|| Region::whole(d), |end| Region::left_by(&end.samples, d));
            let place = StepStart { held: &held, region: &region, refined: refined.map(|end| &end.fitted) };
            work.begin(k);
            let Some(mut end) = self.step((k, step), &mut tried, &place, &mut work)? else {
                return Ok(Standing::Open(work.open));
            };
            (end.samples, end.best) = self.posterior(&mut end.fitted, k, &end.best.predicted);
            for (j, &p) in step.fit.iter().enumerate() {
                let values = end.samples.sorted(j);
                // With the digits that a file keeps.
                held[p] = proposal::digits(values[values.len() / 2]);
            }
            if recipe.steps.len() > 1 {
                self.watch.tell(&self.found(step, &held));
            }
            ends.push(end);
        }
        if !self.verify(&mut ends, &tried, &mut work)? {
            return Ok(Standing::Open(work.open));
        }
        Ok(Standing::Done { tried, steps: ends })
    }

    /// The final samples of a step, once its deviations allow for the misfit of the best point, and that point.
    fn posterior(&self, fitted: &mut Fitted, step: usize, best: &[f64]) -> (Samples, Best) {
        fitted.inflate(best);
        let samples = fitted.samples(self.recipe.settings.seed ^ SEEDS ^ step as u64, LONG);
        let best = Best::unverified(fitted.best(&samples));
        (samples, best)
    }

    fn found(&self, step: &Step, held: &[f64]) -> String {
        let of = |&k: &usize| {
            let p = &self.recipe.parameters[k];
            format!("{} = {}{}", p.name, geom::Shown(p.value(held[k])), p.unit_suffix())
        };
        format!("step '{}': {}", step.name, step.fit.iter().map(of).collect::<Vec<_>>().join(", "))
    }

    /// One step; `None`: jobs are open.
    fn step(
        &self,
        of: (usize, &'a Step),
        tried: &mut Vec<Tried>,
        place: &StepStart,
        work: &mut work::Work,
    ) -> Result<Option<StepEnd<'a>>> {
        let (k, step) = of;
        let (mut batch, mut trials, mut certain) = (0, 0, 0);
        let mut logs = Vec::new();
        let mut widths = Vec::new();
        loop {
            let count = if batch == 0 { step.first } else { step.batch.min(step.trials - trials) };
            let fitted = if batch == 0 { None } else { Some(self.learn(step, tried, place, &logs)?) };
            let samples = fitted.as_ref().map(|f| f.samples(self.seed(k, batch), choice::SHORT));
            if let (Some(fitted), Some(samples)) = (fitted, samples) {
                logs = fitted.logs();
                widths.push((trials, self.widths(&samples)));
                if count == 0 || certain == 2 {
                    let (early, best) = (count > 0, Best::unverified(fitted.best(&samples)));
                    return Ok(Some(StepEnd {
                        fitted,
                        samples,
                        trials,
                        early,
                        widths,
                        held: place.held.to_vec(),
                        best,
                    }));
                }
                let make = || self.propose(&fitted, &samples, (k, batch, trials, count));
                let proposal = Proposal::kept((&self.dir, self.recipe), (k, batch), tried, place, make)?;
                certain = if proposal.certain { certain + 1 } else { 0 };
                if !self.try_all(&proposal, (k, batch), (tried, place.held), work)? {
                    return Ok(None);
                }
                trials += proposal.points.len();
            } else {
                let make = || Proposal {
                    points: choice::even(place.region, self.seed(k, 0), 0, count),
                    certain: false,
                };
                let proposal = Proposal::kept((&self.dir, self.recipe), (k, 0), tried, place, make)?;
                if !self.try_all(&proposal, (k, 0), (tried, place.held), work)? {
                    return Ok(None);
                }
                trials += count;
                if let Some(rate) = work.rate_again(self.jobs) {
                    self.watch.tell(&rate);
                }
                work::check_sizes(self.recipe, step, tried)?;
            }
            batch += 1;
        }
    }

    fn seed(&self, step: usize, batch: usize) -> u64 {
        self.recipe.settings.seed ^ (step as u64) << 40 ^ (batch as u64) << 48
    }

    fn learn(
        &self,
        step: &'a Step,
        tried: &[Tried],
        place: &StepStart,
        logs: &[Vec<crate::emulator::Logs>],
    ) -> Result<Fitted<'a>> {
        Fitted::learn(self.recipe, step, tried, place, logs).ok_or_else(|| {
            let of = |s: Status| tried.iter().filter(|t| t.status == s).count();
            let first = tried.iter().find_map(|t| t.why.as_deref());
            let first = first.map_or(String::new(), |why| format!("; the first: {why}"));
            CalibrateError::Failed(format!(
                "step '{}': too few trials came to their end to learn from ({} done, {} stopped by a guard, {} failed{first}): narrow the bounds, or give more in first",
                step.name,
                of(Status::Done),
                of(Status::Stopped),
                of(Status::Failed)
            ))
        })
    }

    fn widths(&self, samples: &Samples) -> Vec<f64> {
        let share = 0.5 * (1.0 - self.recipe.settings.interval);
        let width = |k: usize| {
            let values = samples.sorted(k);
            let at = |s: f64| values[((s * values.len() as f64) as usize).min(values.len() - 1)];
            at(1.0 - share) - at(share)
        };
        (0..samples.dimensions()).map(width).collect()
    }

    fn propose(&self, fitted: &Fitted, samples: &Samples, of: (usize, usize, usize, usize)) -> Proposal {
        let (step, batch, trials, count) = of;
        // The even points go on where the first batch ended: the seed of the sequence is that of batch 0.
        let choice =
            choice::choose(fitted, samples, (self.seed(step, 0), self.seed(step, batch)), trials, count);
        Proposal { points: choice.points, certain: choice.certain }
    }
}

/// How long something takes, for people.
pub fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => format!("{} ms", (s * 1e3).round()),
        s if s < 120.0 => format!("{} s", geom::Shown((s * 10.0).round() / 10.0)),
        s if s < 7200.0 => format!("{} min", (s / 60.0).round()),
        s if s < 172_800.0 => format!("{} h", (s / 360.0).round() / 10.0),
        s => format!("{} days", (s / 8640.0).round() / 10.0),
    }
}
