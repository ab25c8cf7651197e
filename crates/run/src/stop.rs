//! How a run ends before its end: its file says why, and can be gone on with.

use super::{Run, RunError};
use crate::checkpoint::{Checkpoint, Pieces};
use crate::schedule::nanoseconds;
use serde::Serialize;
use std::io::Write;
use stream::mcap::Writer;

impl<W: Write> Run<W> {
    pub(super) fn write_checkpoint(&mut self) -> Result<(), RunError> {
        let checkpoint = Checkpoint {
            scene: self.scene.clone(),
            inputs: self.inputs.clone(),
            given: self.supply.given.clone(),
            state: self.sim.state(),
        };
        let now = nanoseconds(self.sim.time());
        save(&mut self.writer, now, &checkpoint)?;
        self.checkpoints += 1;
        Ok(())
    }

    /// The run is stopped: the file says why, and ends in a checkpoint.
    pub(super) fn stop(&mut self, reason: String) -> Result<(), RunError> {
        match self.before.take() {
            Some(before) if !self.sim.is_finite() => self.go_back(reason, before),
            None if !self.sim.is_finite() => {
                let reason = format!(
                    "{reason}; nothing can go on from here: --resume goes on from the checkpoint before it (output.checkpoint)"
                );
                self.log("stopped", &reason)?;
                self.outcome.stopped = Some(reason);
                Ok(())
            }
            _ => {
                // What is saved was looked at: the run that goes on does not look again.
                self.sample()?;
                self.write_crossings()?;
                self.log("stopped", &reason)?;
                self.write_checkpoint()?;
                self.outcome.stopped = Some(reason);
                Ok(())
            }
        }
    }

    /// A state without numbers is no use to anyone: the checkpoint is that of the last instant that was looked at. What has
    /// crossed since then crosses again.
    fn go_back(&mut self, reason: String, before: (Vec<u64>, dem::State)) -> Result<(), RunError> {
        let (given, state) = before;
        let time = state.time();
        let reason = format!("{reason}; the checkpoint is of t = {time:.6e} s, before it");
        self.log("stopped", &reason)?;
        let (scene, inputs) = (self.scene.clone(), self.inputs.clone());
        save(&mut self.writer, nanoseconds(time), &Checkpoint { scene, inputs, given, state })?;
        self.outcome.stopped = Some(reason);
        Ok(())
    }
}

/// Writes a checkpoint.
fn save<W: Write>(writer: &mut Writer<W>, now: u64, checkpoint: &impl Serialize) -> Result<(), RunError> {
    let mut pieces = Pieces::new(writer, now);
    stream::state::encode_to(checkpoint, &mut pieces)?;
    Ok(pieces.finish()?)
}
