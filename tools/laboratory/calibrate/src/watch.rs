//! What a terminal shows of a calibration.

use calibration::session::Watch;
use std::sync::Mutex;

/// Progress and sentences on stderr.
pub struct Terminal(Mutex<Option<cli::Progress>>);

impl Terminal {
    /// Nothing is shown yet.
    pub fn new() -> Terminal {
        Terminal(Mutex::new(None))
    }

    /// Takes the progress away.
    pub fn end(&self) {
        if let Ok(mut bar) = self.0.lock() {
            *bar = None;
        }
    }
}

impl Watch for Terminal {
    fn tell(&self, words: &str) {
        if !cli::quiet() {
            cli::say(&format!("calibrate: {words}"));
        }
    }

    fn warn(&self, words: &str) {
        cli::warn(words);
    }

    fn progress(&self, done: usize, total: usize, now: &str) {
        if let Ok(mut bar) = self.0.lock() {
            let bar = bar.get_or_insert_with(|| cli::Progress::new("runs", total as u64));
            bar.set(done as u64);
            bar.say(format!("step {now}: {done} of {total} runs"));
        }
    }
}
