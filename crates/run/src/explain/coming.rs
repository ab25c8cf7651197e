//! How many particles come in while a run goes on, as far as that is known before.

use crate::plan::Feeds;
use serde::Serialize;

/// What comes in.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Coming {
    /// Faucets.
    pub faucets: Vec<String>,
    /// Particles that they bring until the end, and how many of these are there on average over the run.
    pub particles: (f64, f64),
    /// Streams whose particles nobody knows before.
    pub streams: Vec<String>,
}

impl Coming {
    /// Of these feeds, until a time [s].
    pub(crate) fn new(feeds: &Feeds, end: f64) -> Coming {
        let add = |(all, there), faucet: &crate::faucet::Faucet| {
            let (more, on_average) = faucet.expected(end);
            (all + more, there + on_average)
        };
        Coming {
            faucets: feeds.faucets.iter().map(|f| f.key().to_owned()).collect(),
            particles: feeds.faucets.iter().fold((0.0, 0.0), add),
            streams: (0..feeds.streams.len()).map(|k| format!("inlet.{k}")).collect(),
        }
    }

    /// Mean number of particles over the run, where none of the `start` leaves, over those that were there when a step was measured.
    /// `None`: unknown.
    pub(crate) fn growth(&self, start: usize, measured: usize) -> Option<f64> {
        let mean = start as f64 + self.particles.1;
        match (self.streams.is_empty(), self.faucets.is_empty()) {
            (true, true) => Some(1.0),
            (true, false) => Some(mean / measured as f64),
            (false, _) => None,
        }
    }
}
