//! Progress of large fills and of a run: a bar on a terminal, or a JSON line with each frame of the run.

use run::Progress;
use scene::plan::Placing;
use serde::Serialize;
use std::cell::RefCell;
use std::time::Instant;

/// Steps of the bar.
const BAR: f64 = 1000.0;

/// A fill of fewer grains is done before anyone looks.
const LARGE: usize = 100_000;

/// Reports the progress of large fills.
#[derive(Default)]
pub struct Filling(RefCell<Option<cli::Progress>>);

impl Filling {
    /// News of a fill.
    pub fn hear(&self, Placing { fill, placed, of }: Placing) {
        if of < LARGE {
            return;
        }
        let mut bar = self.0.borrow_mut();
        let bar = bar.get_or_insert_with(|| cli::Progress::new("fill", BAR as u64));
        bar.set((BAR * placed as f64 / of as f64) as u64);
        bar.say(format!("fill.{fill}: {placed} of {of} grains"));
    }
}

/// Reports the progress of a run.
pub struct Watch {
    bar: Option<cli::Progress>,
    start: Instant,
    /// Share that was done when the first news came, and when.
    first: Option<(u64, f64)>,
    /// Step and time [s] of the line before.
    before: (u64, f64),
}

/// One line: where the run is, how fast, and how long it will take from here at the pace so far.
#[derive(Serialize)]
struct Line<'a> {
    #[serde(flatten)]
    progress: &'a Progress,
    /// Wall time since the start [s].
    elapsed: f64,
    /// Particle-steps a second since the line before.
    particle_steps_per_second: f64,
    /// Wall time left [s].
    left: f64,
}

impl Watch {
    /// A bar, or `lines`.
    pub fn new(lines: bool) -> Watch {
        let bar = (!lines).then(|| cli::Progress::new("run", BAR as u64));
        Watch { bar, start: Instant::now(), first: None, before: (0, 0.0) }
    }

    /// News of the run.
    pub fn hear(&mut self, progress: &Progress) {
        let elapsed = self.start.elapsed().as_secs_f64();
        let (step, since) = *self.first.get_or_insert((progress.step, elapsed));
        if let Some(bar) = &self.bar {
            bar.set((BAR * progress.share) as u64);
            bar.say(format!(
                "t = {:.4} of {:.4} s, {} particles",
                progress.time, progress.until, progress.particles
            ));
            return;
        }
        if progress.kinetic.is_none() {
            return;
        }
        let pace = (elapsed - since) / (progress.step - step).max(1) as f64;
        let done = (progress.step - self.before.0.max(step)) as f64;
        let line = Line {
            progress,
            elapsed,
            particle_steps_per_second: done * progress.particles as f64 / (elapsed - self.before.1).max(1e-9),
            left: pace * (progress.steps - progress.step) as f64,
        };
        self.before = (progress.step, elapsed);
        if let Ok(line) = serde_json::to_string(&line) {
            cli::say(&line);
        }
    }
}
