//! How far a run is: for progress bars and monitors.

use serde::Serialize;

/// A run at one step.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Progress {
    /// Simulated time [s].
    pub time: f64,
    /// Its end [s].
    pub until: f64,
    /// Steps done, those before a `--resume` included.
    pub step: u64,
    /// Steps at the end.
    pub steps: u64,
    /// Share of this run that is done [–].
    pub share: f64,
    /// Particles in the calculation.
    pub particles: usize,
    /// Of these, those that sleep.
    pub asleep: usize,
    /// Kinetic energy [J], where a frame has just been written.
    pub kinetic: Option<f64>,
    /// Balance of the energy ledger [J], where it is kept and a frame has just been written.
    pub balance: Option<f64>,
    /// Frames that this run has written.
    #[serde(skip)]
    pub frames: u64,
    /// Checkpoints that this run has written.
    #[serde(skip)]
    pub checkpoints: u64,
    /// Time of the last frame or checkpoint [s].
    #[serde(skip)]
    pub saved: f64,
}
