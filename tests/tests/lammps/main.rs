//! `dem-lammps`: single contacts of every law on both engines, decks, insertions, and everything that can fail.
//!
//! What needs LAMMPS is skipped visibly where `lmp` is missing; faults are played by scripts in its place.

mod contacts;
mod decks;
mod faults;
mod many;

use grainpipe_tests::tools::{succeed, tool};
use std::fs::File;
use std::path::Path;
use std::process::Command;
use stream::Table;
use stream::mcap::{Event, Reader};

/// Whether LAMMPS is here; where it is not, the test is counted as skipped.
pub fn lmp() -> bool {
    let found = Command::new("lmp").arg("-h").output().is_ok_and(|done| done.status.success());
    if !found {
        grainpipe_tests::skip("lmp");
    }
    found
}

/// Tables of the frames of a run.
pub fn frames(path: &Path) -> Vec<Table> {
    let mut all = Vec::new();
    for event in Reader::new(File::open(path).expect("the run is there")) {
        if let Event::Points { topic, table, .. } = event.expect("the run is whole")
            && topic == "/particles"
        {
            all.push(table);
        }
    }
    all
}

/// A column of a frame, in the order of ids.
pub fn column(frame: &Table, name: &str) -> Vec<f64> {
    let get = |name: &str| frame.get(name).expect("the column is there").to_f64();
    let mut rows: Vec<(f64, f64)> = get("id").into_iter().zip(get(name)).collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    rows.into_iter().map(|row| row.1).collect()
}

/// Runs a scene on both engines, ours with forces sampled at instants.
pub fn both(folder: &Path, more: &[&str]) -> [Vec<Table>; 2] {
    let given = [&["s.toml", "-q", "--set", "time.contacts=sampled"], more].concat();
    succeed(folder, "dem-run", &[&given[..], &["-o", "ours.mcap"]].concat());
    succeed(folder, "dem-lammps", &[&given[..], &["-o", "theirs.mcap"]].concat());
    ["ours.mcap", "theirs.mcap"].map(|name| frames(&folder.join(name)))
}

/// What a scene is refused with.
pub fn refusal(folder: &Path, more: &[&str]) -> String {
    let done = tool(folder, "dem-lammps", &[&["s.toml", "--check"], more].concat());
    assert_eq!(done.code, 1, "{}", done.stderr);
    done.stderr
}
