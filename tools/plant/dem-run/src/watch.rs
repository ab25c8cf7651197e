//! Progress of large fills and of a run: a bar on a terminal, lines elsewhere for fills that last, or a JSON line with each frame of the run.

use run::Progress;
use scene::plan::Placing;
use serde::Serialize;
use std::cell::RefCell;
use std::io::{IsTerminal, stderr};
use std::time::{Duration, Instant};

/// Steps of the bar.
const BAR: f64 = 1000.0;

/// A fill of fewer grains is done before anyone looks.
const LARGE: usize = 100_000;

/// Time between lines where stderr is no terminal.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// Reports the progress of large fills.
pub struct Filling(RefCell<Shown>);

enum Shown {
    /// A bar, once there is news.
    Bar(Option<cli::Progress>),
    /// A line now and then; when the last was due.
    Lines(Instant),
}

impl Filling {
    /// On a terminal or elsewhere.
    pub fn new() -> Filling {
        Filling(RefCell::new(match stderr().is_terminal() {
            true => Shown::Bar(None),
            false => Shown::Lines(Instant::now()),
        }))
    }

    /// News of a fill.
    pub fn hear(&self, Placing { fill, placed, of }: Placing) {
        if of < LARGE {
            return;
        }
        let words = format!("fill.{fill}: {placed} of {of} grains");
        match &mut *self.0.borrow_mut() {
            Shown::Bar(bar) => {
                let bar = bar.get_or_insert_with(|| cli::Progress::new("fill", BAR as u64));
                bar.set((BAR * placed as f64 / of as f64) as u64);
                bar.say(words);
            }
            Shown::Lines(last) => {
                let line = due(last, Instant::now(), words).filter(|_| !cli::quiet());
                line.iter().for_each(|line| cli::say(&format!("dem-run: {line}")));
            }
        }
    }
}

/// The words as a line, if the last one was long ago.
fn due(last: &mut Instant, now: Instant, words: String) -> Option<String> {
    let passed = now.saturating_duration_since(*last) >= BETWEEN_LINES;
    passed.then(|| {
        *last = now;
        words
    })
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
                "t = {:.4} of {:.4} s, {}",
                progress.time,
                progress.until,
                geom::counted(progress.particles, "particle")
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_come_every_ten_seconds() {
        let start = Instant::now();
        let mut last = start;
        let seconds: Vec<u64> = (0..35)
            .filter(|&s| due(&mut last, start + Duration::from_secs(s), String::new()).is_some())
            .collect();
        assert_eq!(seconds, [10, 20, 30]);
    }
}
