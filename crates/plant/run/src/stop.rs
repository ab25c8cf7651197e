//! How a run ends early: its file holds the reason, and can be resumed.

use crate::checkpoint::{Checkpoint, Pieces};
use crate::error::Result;
use crate::underway::{Before, Run, Written};
use dem::Halt;
use record::{LogMessage, SIGNAL, StopCause, nanoseconds};
use scene::advice::{at, explain_fact, stop_cause};
use scene::{Scene, SceneError};
use serde::Serialize;
use std::io::Write;
use stream::mcap::Writer;

/// What ends a run early.
pub(crate) struct Stopping {
    cause: StopCause,
    /// When a guard found it [s].
    time: Option<f64>,
    /// What happened and what to do, without the time.
    why: String,
}

impl Stopping {
    pub(crate) fn signal() -> Stopping {
        Stopping { cause: StopCause::Signal, time: None, why: SIGNAL.to_owned() }
    }
}

/// The message of a guard. What overlaps before the first step is an error of the scene, not of the calculation.
pub(crate) fn guard(scene: &Scene, halt: &Halt) -> Result<Stopping, SceneError> {
    match halt {
        Halt::Overlap { time, id, partner, overlap, .. } if *time <= 0.0 => {
            let (name, partner) = (scene.text.name.clone(), partner.to_string());
            Err(SceneError::Inside { name, id: *id, partner, overlap: *overlap })
        }
        other => {
            let (cause, time, why) = (stop_cause(other), Some(other.time()), explain_fact(other));
            Ok(Stopping { cause, time, why })
        }
    }
}

impl<W: Write> Run<W> {
    /// The message of a guard; the outcome keeps the guard itself.
    pub(crate) fn halted(&mut self, scene: &Scene, halt: Halt) -> Result<Stopping, SceneError> {
        let stopping = guard(scene, &halt)?;
        self.outcome.halt = Some(halt);
        Ok(stopping)
    }

    pub(crate) fn write_checkpoint(&mut self) -> Result<()> {
        let (time, given) = (self.sim.time(), self.supply.given.clone());
        save(&mut self.writer, time, &self.written, given, self.sim.checkpoint())?;
        self.checkpoints += 1;
        Ok(())
    }

    /// Stops the run: the file ends with the reason and a checkpoint. A state without numbers is useless: the checkpoint is then that of
    /// the last state that was held, and what has crossed since then crosses again.
    pub(crate) fn stop(&mut self, stopping: Stopping) -> Result<()> {
        let finite = self.sim.is_finite();
        let before = self.before.take().filter(|_| !finite);
        let Stopping { cause, time, why } = stopping;
        let why = match &before {
            Some(Before { state, .. }) => {
                format!("{why}; the checkpoint is of t = {:.6e} s, before it", state.time())
            }
            None if finite => why,
            None => format!(
                "{why}; the run cannot be resumed from here: --resume continues from the checkpoint before it (output.checkpoint)"
            ),
        };
        if finite {
            // The sample of a saved step is in the file: the run that resumes does not take it again.
            self.sample()?;
            self.write_crossings()?;
        }
        let text = time.map_or(why.clone(), |time| at(time, &why));
        self.log(&LogMessage::stopped(self.sim.time(), &text, cause))?;
        match before {
            Some(Before { given, state }) => {
                save(&mut self.writer, state.time(), &self.written, given, state)?;
            }
            None if finite => self.write_checkpoint()?,
            None => {}
        }
        (self.outcome.stopped, self.outcome.stop) = (Some(text), Some((cause, why)));
        Ok(())
    }
}

/// Writes the checkpoint of a state at a time [s], when its sources had given so many arrivals.
fn save<W: Write, S: Serialize>(
    writer: &mut Writer<W>,
    time: f64,
    written: &Written,
    given: Vec<u64>,
    state: S,
) -> Result<()> {
    let (scene, inputs) = (written.scene.clone(), written.inputs.clone());
    let mut pieces = Pieces::new(writer, nanoseconds(time));
    stream::state::encode_to(&Checkpoint { scene, inputs, given, state }, &mut pieces)?;
    Ok(pieces.finish()?)
}
