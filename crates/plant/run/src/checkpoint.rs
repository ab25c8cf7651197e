//! Checkpoints of a run: the engine's state, what fed it, and the scene it belongs to.

use crate::error::Result;
use record::topic::CHECKPOINT;
use scene::SceneError;
use serde::{Deserialize, Serialize};
use std::io::{Read, Write};
use stream::mcap::{Event, McapError, Reader, Writer};

/// Largest piece of a checkpoint in one message [B], so that no buffer on the way holds a whole one.
const PIECE: usize = 1 << 20;

/// Writes a checkpoint as messages: pieces, each behind a byte that is 1 in the last.
pub(crate) struct Pieces<'a, W: Write> {
    writer: &'a mut Writer<W>,
    now: u64,
    piece: Vec<u8>,
}

impl<'a, W: Write> Pieces<'a, W> {
    pub(crate) fn new(writer: &'a mut Writer<W>, now: u64) -> Pieces<'a, W> {
        Pieces { writer, now, piece: vec![0] }
    }

    /// Writes the last piece.
    pub(crate) fn finish(mut self) -> Result<(), McapError> {
        self.piece[0] = 1;
        self.send()
    }

    fn send(&mut self) -> Result<(), McapError> {
        self.writer.bytes(CHECKPOINT, "bincode", self.now, &self.piece)?;
        self.piece.truncate(1);
        Ok(())
    }
}

impl<W: Write> Write for Pieces<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        if self.piece.len() >= PIECE {
            self.send().map_err(std::io::Error::other)?;
        }
        self.piece.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// Everything that a run resumes from; `S` is the state: owned when it is read, borrowed when it is written.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Checkpoint<S = dem::Checkpoint<'static>> {
    /// Text of the scene.
    pub(crate) scene: String,
    /// Role and SHA-256 of the inputs of the scene.
    pub(crate) inputs: Vec<(String, String)>,
    /// How many arrivals each source had given.
    pub(crate) given: Vec<u64>,
    /// State of the engine.
    pub(crate) state: S,
}

impl Checkpoint {
    /// The last whole checkpoint of a run, also of one that was killed while it was written.
    ///
    /// # Errors
    /// A stream that is damaged, or has no whole checkpoint.
    pub fn last(name: &str, source: impl Read) -> Result<Checkpoint> {
        let (mut last, mut pieces) = (None, Vec::new());
        for event in Reader::new(source) {
            match event {
                Ok(Event::Bytes { topic, data, .. }) if topic == CHECKPOINT => {
                    pieces.extend_from_slice(data.get(1..).unwrap_or_default());
                    if data.first() == Some(&1) {
                        last = Some(std::mem::take(&mut pieces));
                    }
                }
                Ok(_) => {}
                Err(McapError::Truncated { .. }) => break,
                Err(error) => return Err(SceneError::content(name, "a run", error).into()),
            }
        }
        let Some(data) = last else {
            let why = "has no whole checkpoint";
            let cure = "start again, with [output] checkpoint = seconds for the next time";
            return Err(SceneError::file(name, why, cure).into());
        };
        Ok(stream::state::decode(&data)?)
    }

    /// When a run resumes from it [s].
    pub fn time(&self) -> f64 {
        self.state.time()
    }
}
