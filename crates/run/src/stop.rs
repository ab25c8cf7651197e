//! How a run ends early: its file holds the reason, and can be resumed.

use crate::RunError;
use crate::checkpoint::{Checkpoint, Pieces};
use crate::simulate::{Before, Run};
use record::{LogMessage, nanoseconds};
use serde::Serialize;
use std::io::Write;
use stream::mcap::Writer;

impl<W: Write> Run<W> {
    pub(crate) fn write_checkpoint(&mut self) -> Result<(), RunError> {
        let checkpoint = Checkpoint {
            scene: self.written.scene.clone(),
            inputs: self.written.inputs.clone(),
            given: self.supply.given.clone(),
            state: self.sim.state(),
        };
        let now = nanoseconds(self.sim.time());
        save(&mut self.writer, now, &checkpoint)?;
        self.checkpoints += 1;
        Ok(())
    }

    /// Stops the run: the file ends with the reason and a checkpoint.
    pub(crate) fn stop(&mut self, reason: String) -> Result<(), RunError> {
        let reason = match self.before.take() {
            Some(before) if !self.sim.is_finite() => self.go_back(reason, before)?,
            None if !self.sim.is_finite() => {
                let reason = format!(
                    "{reason}; the run cannot be resumed from here: --resume continues from the checkpoint before it (output.checkpoint)"
                );
                self.log(&LogMessage::stopped(self.sim.time(), &reason))?;
                reason
            }
            _ => {
                // The sample of a saved step is in the file: the run that resumes does not take it again.
                self.sample()?;
                self.write_crossings()?;
                self.log(&LogMessage::stopped(self.sim.time(), &reason))?;
                self.write_checkpoint()?;
                reason
            }
        };
        self.outcome.stopped = Some(reason);
        Ok(())
    }

    /// A state without numbers is useless: the checkpoint is that of the last state that was held. What has crossed since then crosses
    /// again.
    fn go_back(&mut self, reason: String, before: Before) -> Result<String, RunError> {
        let Before { given, state } = before;
        let time = state.time();
        let reason = format!("{reason}; the checkpoint is of t = {time:.6e} s, before it");
        self.log(&LogMessage::stopped(self.sim.time(), &reason))?;
        let (scene, inputs) = (self.written.scene.clone(), self.written.inputs.clone());
        save(&mut self.writer, nanoseconds(time), &Checkpoint { scene, inputs, given, state })?;
        Ok(reason)
    }
}

/// Writes a checkpoint.
fn save<W: Write>(writer: &mut Writer<W>, now: u64, checkpoint: &impl Serialize) -> Result<(), RunError> {
    let mut pieces = Pieces::new(writer, now);
    stream::state::encode_to(checkpoint, &mut pieces)?;
    Ok(pieces.finish()?)
}
