//! Laws, hard cases and whole pipelines, tested from outside.

pub mod setups;

/// Says in one line that a test was left out because a program is missing; a missing program fails in CI.
///
/// # Panics
/// When `CI` is set: there every program is installed, and a test that does not run is a failure.
pub fn skip(program: &str) {
    assert!(std::env::var_os("CI").is_none(), "{program} is missing: install it, this test must run in CI");
    eprintln!("skipped: {program} not found");
}
pub mod tools;
