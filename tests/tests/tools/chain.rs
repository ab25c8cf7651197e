//! The chain from scan to wall spheres: the same bytes for any number of threads, and the counts that it is known for.

use grainpipe_tests::tools::succeed;
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::tempdir;

/// Tool, input, options, output, and the field of its report that counts what came out.
const STAGES: [(&str, &str, &str, &str, &str); 6] = [
    ("cloud-crop", "scan.ply", "--remove halfspace:0,0,0,-1,0,0", "cropped.ply", "points_out"),
    ("cloud-fill", "cropped.ply", "", "filled.ply", "added"),
    ("bluenoise-sample", "filled.ply", "--spacing 0.012", "sampled.ply", "points_after"),
    ("bluenoise-sample", "filled.ply", "--spacing 0.03", "coarse.ply", "points_after"),
    ("wallgen", "sampled.ply", "--roughness 0.0015", "walls.ply", "spheres"),
    (
        "wallgen",
        "sampled.ply",
        "--roughness 0.0015 --smallest-particle 0.03 --place surface --facing 0,0,1",
        "tight.mcap",
        "spheres",
    ),
];

fn report(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("report.json")).unwrap()).unwrap()
}

/// Runs a stage and gives what it wrote and how many came out.
fn run(folder: &Path, stage: usize, threads: &str) -> (Vec<u8>, u64) {
    let (tool, input, options, output, count) = STAGES[stage];
    let mut arguments = vec![input, "-q", "-o", output, "--report", "report.json", "--threads", threads];
    arguments.extend(options.split_whitespace());
    succeed(folder, tool, &arguments);
    (fs::read(folder.join(output)).unwrap(), report(folder)[count].as_u64().unwrap())
}

#[test]
fn every_stage_writes_the_same_bytes_for_any_number_of_threads() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    succeed(folder, "chute-scan", &["-q", "--points", "50000", "-o", "scan.ply"]);
    let counts: Vec<u64> = (0..STAGES.len())
        .map(|stage| {
            let (bytes, count) = run(folder, stage, "1");
            for threads in ["2", "3", "7"] {
                let again = run(folder, stage, threads).0;
                assert!(again == bytes, "{} with {threads} threads", STAGES[stage].0);
            }
            count
        })
        .collect();
    // Other numbers are not wrong as such, but a change of what the tools choose, which has to be meant.
    assert_eq!(counts, [43_982, 166, 12_949, 3_486, 12_949, 12_949]);
}
