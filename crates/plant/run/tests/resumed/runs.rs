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

/// A tray of rock in which grains of `[[fill]]` or `[[insert]]` move, under that gravity [m/s²], until a time [s]: what follows is to be added.
pub fn tray(gravity: &str, until: f64) -> String {
    format!(
        r#"gravity = [{gravity}]
[time]
until = {until}
[output]
every = 0.01
checkpoint = 0.02
energy = true
contacts = true
[[material]]
name = "rock"
density = 2600
young = 2e6
poisson = 0.25
[[contact]]
between = ["*", "*"]
restitution = 0.4
sliding_friction = 0.5
rolling_resistance = 0.1
[[wall]]
name = "tray"
box = [0, 0, 0, 0.06, 0.06, 0.2]
faces = ["x-", "x+", "y-", "y+", "z-"]
material = "rock"
"#
    )
}
