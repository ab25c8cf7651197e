//! Progress of long work, drawn on stderr when that is a terminal and `-q` is absent.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A progress bar, or nothing.
pub struct Progress(ProgressBar);

impl Progress {
    /// Starts a bar of `total` steps; 0 when the total is not known.
    pub fn new(what: &'static str, total: u64) -> Progress {
        let bar = if total == 0 { ProgressBar::no_length() } else { ProgressBar::new(total) };
        // Indicatif's own stderr target is silent off a terminal.
        bar.set_draw_target(if crate::quiet() {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        });
        let template =
            if total == 0 { "{msg} {human_pos} {elapsed}" } else { "{msg} {wide_bar} {percent} % {eta}" };
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        bar.set_message(what);
        Progress(bar)
    }

    /// Says that `done` steps of the total are done.
    pub fn set(&self, done: u64) {
        self.0.set_position(done);
    }

    /// Says where the work is.
    pub fn say(&self, words: String) {
        self.0.set_message(crate::escaped(&words).into_owned());
    }

    /// Says that `more` steps were done.
    pub fn add(&self, more: u64) {
        self.0.inc(more);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
