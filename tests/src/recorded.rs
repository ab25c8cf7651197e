//! What a run recorded, read back.

use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;
use stream::Table;
use stream::mcap::{Event, Reader};

/// What can be read of a run, and whether its end is there.
///
/// # Panics
/// When the run is missing.
pub fn events(path: &Path) -> (Vec<Event>, bool) {
    let mut events = Vec::new();
    for event in Reader::new(File::open(path).expect("the run is there")) {
        match event {
            Ok(event) => events.push(event),
            Err(_) => return (events, false),
        }
    }
    (events, true)
}

/// What a whole run has of a kind, in the order of time.
fn picked<T>(path: &Path, pick: impl Fn(Event) -> Option<T>) -> Vec<T> {
    let events = Reader::new(File::open(path).expect("the run is there"));
    events.filter_map(|event| pick(event.expect("the run is whole"))).collect()
}

/// Tables of the frames of a run.
///
/// # Panics
/// When it is not whole.
pub fn frames(path: &Path) -> Vec<Table> {
    tables(path, "/particles")
}

/// The tables of a topic of a run.
///
/// # Panics
/// When the run is missing or broken.
pub fn tables(path: &Path, of: &str) -> Vec<Table> {
    picked(path, |event| match event {
        Event::Points { topic, table, .. } if topic == of => Some(table),
        _ => None,
    })
}

/// The messages of a topic of a run, as they are.
///
/// # Panics
/// When the run is missing or broken.
pub fn messages(path: &Path, of: &str) -> Vec<Vec<u8>> {
    picked(path, |event| match event {
        Event::Bytes { topic, data, .. } if topic == of => Some(data),
        _ => None,
    })
}

/// The messages of a JSON topic of a run.
///
/// # Panics
/// When the run is missing or broken, or a message is no JSON.
pub fn json(path: &Path, of: &str) -> Vec<serde_json::Value> {
    let read = |data: &Vec<u8>| serde_json::from_slice(data).expect("JSON");
    messages(path, of).iter().map(read).collect()
}

/// A metadata record of a run, the last one of this name; empty where it has none.
///
/// # Panics
/// When the run is missing or broken.
pub fn metadata(path: &Path, of: &str) -> BTreeMap<String, String> {
    let found = picked(path, |event| match event {
        Event::Metadata { name, map } if name == of => Some(map),
        _ => None,
    });
    found.into_iter().next_back().unwrap_or_default()
}

/// A column of a frame, in the order of ids.
///
/// # Panics
/// When the column is missing.
pub fn column(frame: &Table, name: &str) -> Vec<f64> {
    let get = |name: &str| frame.get(name).expect("the column is there").to_f64();
    let mut rows: Vec<(f64, f64)> = get("id").into_iter().zip(get(name)).collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    rows.into_iter().map(|row| row.1).collect()
}
