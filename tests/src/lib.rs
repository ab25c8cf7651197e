//! Laws, hard cases and whole pipelines, tested from outside.

// Modules of set-ups name this crate as tests do.
extern crate self as grainpipe_tests;

pub mod engines;
pub mod findings;
pub mod lab;
pub mod layout;
pub mod metamorphic;
pub mod normals;
pub mod page;
pub mod plots;
pub mod recorded;
pub mod same_bits;
pub mod scenes;
pub mod setups;
pub mod sphere_walls;
pub mod tools;
pub mod tree;
pub mod written;

use std::io::Write;

/// Says in one line that a test was left out because a program is missing; a missing program fails in CI.
///
/// # Panics
/// When `CI` is set: there every program is installed, and a test that does not run is a failure.
pub fn skip(program: &str) {
    assert!(std::env::var_os("CI").is_none(), "{program} is missing: install it, this test must run in CI");
    let line = format!("skipped: {program} not found\n");
    eprint!("{line}");
    // The runner hides what a passing test prints; pipelines/test.sh shows and counts these lines.
    if let Some(list) = std::env::var_os("GRAINPIPE_SKIPS") {
        let file = std::fs::OpenOptions::new().append(true).create(true).open(list);
        file.and_then(|mut f| f.write_all(line.as_bytes()))
            .expect("the list of skipped tests can be written");
    }
}
