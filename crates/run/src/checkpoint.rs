//! Checkpoints of a run: the engine's state, what fed it, and the scene it belongs to.

use crate::error::SceneError;
use crate::run::RunError;
use serde::{Deserialize, Serialize};
use std::io::{Read, Write};
use stream::mcap::{Event, McapError, Reader, Writer};

/// Topic of checkpoints.
pub const CHECKPOINT: &str = "/checkpoint";

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

/// Everything that a run goes on from; `S` is the state, owned when it is read, borrowed when it is written.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Checkpoint<S = dem::State> {
    /// Text of the scene.
    pub(crate) scene: String,
    /// Role and SHA-256 of what the scene was run with.
    pub(crate) inputs: Vec<(String, String)>,
    /// Particles that each feed had given.
    pub(crate) given: Vec<u64>,
    /// State of the engine.
    pub(crate) state: S,
}

impl Checkpoint {
    /// The last whole checkpoint of a run, also of one that was killed while it was written.
    ///
    /// # Errors
    /// A stream that is damaged, or has no whole checkpoint.
    pub fn last(name: &str, source: impl Read) -> Result<Checkpoint, RunError> {
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
                Err(error) => {
                    return Err(SceneError::Content {
                        name: name.into(),
                        wanted: "a run",
                        source: error.into(),
                    }
                    .into());
                }
            }
        }
        let Some(data) = last else {
            let why = "has no whole checkpoint";
            let cure = "start anew, with [output] checkpoint = seconds for the next time";
            return Err(SceneError::file(name, why, cure).into());
        };
        Ok(stream::state::decode(&data)?)
    }

    /// Step of the run [s].
    pub fn dt(&self) -> f64 {
        self.state.dt()
    }

    /// Time of the checkpoint [s].
    pub fn time(&self) -> f64 {
        self.state.time()
    }

    /// Refuses another scene than the one that was saved; its end, its output and its guards may differ.
    ///
    /// # Errors
    /// What differs.
    pub(crate) fn fits(&self, scene: &str, inputs: &[(String, String)]) -> Result<(), SceneError> {
        let refuse = |what: String| {
            let cure = "resume with the scene and inputs of the saved run (only time.until, [guards], and every, checkpoint and precision of [output] may change)";
            Err(SceneError::file("--resume", format!("the saved run differs: {what}"), cure))
        };
        let table = |text: &str| {
            let mut table: toml::Table = toml::from_str(text).unwrap_or_default();
            if let Some(time) = table.get_mut("time").and_then(|t| t.as_table_mut()) {
                time.remove("until");
            }
            table.retain(|key, value| key != "time" || value.as_table().is_none_or(|t| !t.is_empty()));
            if let Some(output) = table.get_mut("output").and_then(|t| t.as_table_mut()) {
                ["every", "checkpoint", "precision"].iter().for_each(|k| drop(output.remove(*k)));
                if output.is_empty() {
                    table.remove("output");
                }
            }
            table.remove("guards");
            toml::Value::Table(table)
        };
        if let Some(difference) = difference("", &table(&self.scene), &table(scene)) {
            return refuse(difference);
        }
        let others =
            |list: &[(String, String)]| list.iter().filter(|i| i.0 != "scene").cloned().collect::<Vec<_>>();
        let (saved, now) = (others(&self.inputs), others(inputs));
        match saved.iter().zip(&now).find(|(a, b)| a != b) {
            Some((a, _)) => refuse(format!("the {} are others", a.0)),
            None if saved.len() != now.len() => {
                refuse(format!("{} inputs then, {} now", saved.len(), now.len()))
            }
            None => Ok(()),
        }
    }
}

/// The first key of a value, with what it is set to.
fn leaf(key: String, value: &toml::Value) -> String {
    match value.as_table().and_then(|table| table.iter().next()) {
        Some((k, inner)) => leaf(format!("{key}.{k}"), inner),
        None => format!("{key} = {value}"),
    }
}

/// The first key whose values differ.
fn difference(key: &str, saved: &toml::Value, now: &toml::Value) -> Option<String> {
    use toml::Value::{Array, Table};
    let join = |k: &str| if key.is_empty() { k.to_owned() } else { format!("{key}.{k}") };
    match (saved, now) {
        (Table(a), Table(b)) => {
            let keys = a.keys().chain(b.keys().filter(|k| !a.contains_key(*k)));
            keys.into_iter().find_map(|k| match (a.get(k), b.get(k)) {
                (Some(x), Some(y)) => difference(&join(k), x, y),
                (Some(x), None) => Some(format!("{} is gone", leaf(join(k), x))),
                (None, y) => y.map(|y| format!("{} is new", leaf(join(k), y))),
            })
        }
        (Array(a), Array(b)) if a.len() == b.len() => {
            a.iter().zip(b).enumerate().find_map(|(i, (x, y))| difference(&join(&i.to_string()), x, y))
        }
        (Array(a), Array(b)) => Some(format!("{key} had {} entries, now {}", a.len(), b.len())),
        _ => (saved != now).then(|| format!("{key} was {saved}, now {now}")),
    }
}
