//! Every tool with less memory than it needs: a message, an exit code of the contract, and no output that only looks whole.

use super::case::Case;
use super::options::{CALLS, files_of};
use super::{files, folders};
use crate::samples;

/// Limits of address space [kB]: from little more than a program itself to more than the samples need.
const MEMORY: [u32; 14] = [
    45_000, 52_000, 60_000, 70_000, 80_000, 95_000, 110_000, 140_000, 180_000, 250_000, 350_000, 500_000,
    700_000, 900_000,
];

/// All cases: tools × limits.
pub fn cases() -> Vec<Case> {
    let mut shared = files::others();
    let run = samples::mcap().into_iter().find(|s| s.0 == "run.mcap").expect("a run").1;
    shared.push(("run.mcap".into(), run));
    let examples = folders::files();
    let mut cases = Vec::new();
    for &(tool, call) in CALLS.iter().chain(folders::CALLS) {
        for memory in MEMORY {
            cases.push(Case {
                group: "memory",
                tool,
                args: call.split(' ').map(str::to_owned).collect(),
                files: files_of(tool, &shared, &examples),
                change: format!("ulimit -v {memory}"),
                memory: Some(memory),
            });
        }
    }
    cases
}
