//! How many particles come in while a run goes on, as far as that is known before.

use scene::plan::Insertion;
use serde::Serialize;

/// What comes in.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Coming {
    /// Keys of the insertions.
    #[serde(rename = "faucets")]
    pub insertions: Vec<String>,
    /// Particles that they bring until the end, and the mean number of these over the run.
    pub particles: (f64, f64),
    /// Keys of the inlets, whose particles are not known before.
    pub streams: Vec<String>,
}

impl Coming {
    /// Of these insertions and so many streams, until a time [s].
    pub(crate) fn new(insertions: &[Insertion], streams: usize, end: f64) -> Coming {
        let expected = insertions.iter().map(|insertion| insertion.expected(end));
        Coming {
            insertions: insertions.iter().map(|insertion| insertion.key().to_owned()).collect(),
            particles: expected.fold((0.0, 0.0), |sum, more| (sum.0 + more.all, sum.1 + more.mean)),
            streams: (0..streams).map(|k| format!("inlet.{k}")).collect(),
        }
    }

    /// Mean number of particles over the run, where none of the `start` leaves, over those that were there when a step was measured.
    /// `None`: unknown.
    pub(crate) fn growth(&self, start: usize, measured: usize) -> Option<f64> {
        let mean = start as f64 + self.particles.1;
        match (self.streams.is_empty(), self.insertions.is_empty()) {
            (true, true) => Some(1.0),
            (true, false) => Some(mean / measured as f64),
            (false, _) => None,
        }
    }
}
