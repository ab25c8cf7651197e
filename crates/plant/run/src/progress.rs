//! How far a run is: for progress bars and monitors.

use crate::underway::Run;
use serde::Serialize;
use std::io::Write;

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

impl Progress {
    /// The same at step `step` of a run that began with step `first` and has steps of `dt` [s].
    pub(crate) fn reach(&mut self, step: u64, first: u64, dt: f64) {
        (self.step, self.time) = (step, step as f64 * dt);
        self.share = (step - first) as f64 / (self.steps - first).max(1) as f64;
    }
}

impl<W: Write> Run<W> {
    /// How far it is; the energy of a frame is given once.
    pub(crate) fn progress(&mut self) -> Progress {
        let (step, steps) = (self.sim.steps(), self.schedule.last);
        let energy = self.frame_energy.take();
        let mut progress = Progress {
            time: 0.0,
            until: steps as f64 * self.schedule.dt,
            step,
            steps,
            share: 0.0,
            particles: self.sim.particle_count(),
            asleep: self.sim.asleep(),
            kinetic: energy.map(|e| e.kinetic),
            balance: energy.and_then(|e| e.balance),
            frames: self.outcome.frames,
            checkpoints: self.checkpoints,
            saved: self.saved_at,
        };
        progress.reach(step, self.first, self.schedule.dt);
        progress
    }
}
