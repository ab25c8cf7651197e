//! Runs in memory.

use run::{Checkpoint, Outcome, RunError, Settings, run};
use scene::Scene;
use std::path::Path;
use stream::mcap::{Compression, Event, Provenance, Reader};
use stream::{Table, Values};

/// Runs a scene with these `--set`, from a checkpoint or from the start: what was done, and the file.
///
/// # Errors
/// What refuses the scene or the checkpoint.
pub fn made(text: &str, sets: &[String], resume: Option<Checkpoint>) -> Result<(Outcome, Vec<u8>), RunError> {
    let scene = Scene::new("s.toml", text.to_owned(), sets, Path::new(""))?;
    let plan = scene.plan(Vec::new())?;
    let provenance = Provenance {
        tool: "test".to_owned(),
        version: String::new(),
        arguments: Vec::new(),
        inputs: Vec::new(),
    };
    let settings = Settings {
        provenance,
        how: Compression::None.into(),
        resume,
        earlier: None,
        watched: false,
        stop: || false,
        device: None,
    };
    run(&scene, plan, Vec::new(), settings, &mut |_| {})
}

/// Messages of a topic: time [ns] and table.
pub fn tables(file: &[u8], of: &str) -> Vec<(u64, Table)> {
    let events = Reader::new(file).map(|event| event.expect("a whole file"));
    let found = events.filter_map(|event| match event {
        Event::Points { topic, time_ns, table } if topic == of => Some((time_ns, table)),
        _ => None,
    });
    found.collect()
}

/// A column of numbers.
pub fn column(table: &Table, name: &str) -> Vec<f64> {
    match table.get(name) {
        Some(Values::F64(values)) => values.clone(),
        other => panic!("{name}: {other:?}"),
    }
}

/// The last checkpoint of a file.
pub fn last(file: &[u8]) -> Checkpoint {
    Checkpoint::last("a run", file).expect("a checkpoint")
}
