//! A reader that goes away is no failure: every tool ends at once, with code 0 and without a word.

use crate::samples;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{line, succeed};
use tempfile::TempDir;

const CLOSED: Case = case("Faults", "the reader closes the pipe: every tool ends silently with code 0");

/// A command of each tool that writes a stream.
pub const COMMANDS: [&str; 9] = [
    "cloud-crop cloud.xyz",
    "cloud-fill cloud.xyz",
    "bluenoise-sample cloud.xyz --spacing 0.012",
    "wallgen cloud.xyz --roughness 0.001 --radius uniform",
    "dem-run s.toml",
    "stage-replay run.mcap",
    "stage-split plant.toml --at 0,0,0.0204,0,0,-1 --keep upstream",
    "dem-measure run.mcap --energy",
    "dem-view run.mcap",
];

/// A folder with a cloud of 40 000 points, walls, and a run whose output is longer than a pipe holds.
pub fn plant() -> TempDir {
    let cloud: String = (0..40_000)
        .map(|k| format!("{} {} 0\n", 0.01 * f64::from(k % 200), 0.01 * f64::from(k / 200)))
        .collect();
    let scene =
        samples::scene().replace("count = 3", "count = 60").replace("every = 0.004", "every = 0.0005");
    let scene = scene.replace("until = 0.012", "until = 0.04");
    let scene = scene.replace("0.03,0.03,0.035", "0.08,0.08,0.2");
    let folder = folder(&[("cloud.xyz", cloud), ("s.toml", scene), ("plant.toml", samples::scene())]);
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
    folder
}

#[test]
fn a_closed_pipe_ends_every_tool_quietly() {
    let folder = plant();
    let mut loud = 0u32;
    for command in COMMANDS.into_iter().chain(["dem-measure run.mcap --contacts", "chute-scan"]) {
        // Closed after a few bytes, and before the first.
        for reader in ["head -c 100 > /dev/null", "true"] {
            let done = line(folder.path(), &format!("{command} -q | {reader}"));
            println!("{command} | {reader}: {} {}", done.code, done.stderr);
            loud += u32::from(done.code != 0 || !done.stderr.is_empty());
        }
    }
    CLOSED.within("eleven command lines, those that speak or fail", f64::from(loud), "lines", 0.0);
}
