//! `dem-lammps`: single contacts of every law on both engines, decks, insertions, and everything that can fail.
//!
//! What needs LAMMPS is skipped visibly where `lmp` is missing; scripts play its faults.

mod bonds;
mod breaking;
mod clumps;
mod contacts;
mod decks;
mod faults;
mod loads;
mod many;
mod resume;
mod stages;

use grainpipe_tests::tools::tool;
use std::path::Path;
use std::process::Command;

/// Whether LAMMPS is here; where it is not, the test is counted as skipped.
pub fn lmp() -> bool {
    let found = Command::new("lmp").arg("-h").output().is_ok_and(|done| done.status.success());
    if !found {
        grainpipe_tests::skip("lmp");
    }
    found
}

/// What a scene is refused with.
pub fn refusal(folder: &Path, more: &[&str]) -> String {
    let done = tool(folder, "dem-lammps", &[&["s.toml", "--check"], more].concat());
    assert_eq!(done.code, 1, "{}", done.stderr);
    done.stderr
}
