//! Every tool with less memory than it needs: a message, an exit code of the contract, and no output that only looks whole.

use super::case::Case;
use super::options::calls;

/// Limits of address space [kB]: from little more than a program itself to more than the samples need.
const MEMORY: [u32; 14] = [
    45_000, 52_000, 60_000, 70_000, 80_000, 95_000, 110_000, 140_000, 180_000, 250_000, 350_000, 500_000,
    700_000, 900_000,
];

/// All cases: tools × limits.
pub fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for call in calls() {
        for memory in MEMORY {
            cases.push(Case {
                group: "memory",
                tool: call.tool,
                args: call.args.clone(),
                files: call.files.clone(),
                change: format!("ulimit -v {memory}"),
                memory: Some(memory),
            });
        }
    }
    cases
}
