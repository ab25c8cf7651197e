//! What stage-replay makes of one record: elsewhere, again, several at once, part of it.

use super::{passages, plant};
use geom::Vec3;
use grainpipe_tests::tools::{succeed, tool};
use stages::outlet::crossing::CrossingRow;
use std::collections::BTreeSet;
use std::path::Path;
use tempfile::TempDir;

fn recorded() -> TempDir {
    let folder = plant();
    succeed(folder.path(), "dem-run", &["up.toml", "-o", "up.mcap"]);
    folder
}

fn replay(folder: &Path, options: &[&str]) -> Vec<CrossingRow> {
    succeed(folder, "stage-replay", &[&["up.mcap", "-o", "in.mcap"], options].concat());
    passages(&folder.join("in.mcap"))
}

/// A quarter turn about the vertical, then a shift: places, velocities and spins turn with the plane.
#[test]
fn a_turned_and_shifted_record() {
    let folder = recorded();
    let here = replay(folder.path(), &[]);
    let there = replay(folder.path(), &["--turn-deg", "90", "--axis", "0.1,0,0,0,0,1", "--shift", "0,0,0.5"]);
    let turned = |v: Vec3| Vec3::new(-v.y, v.x, v.z);
    let axis = Vec3::new(0.1, 0.0, 0.0);
    assert!(here.len() > 30 && here.len() == there.len());
    for (a, b) in here.iter().zip(&there) {
        let place = turned(a.particle.position - axis) + axis + Vec3::new(0.0, 0.0, 0.5);
        assert!((b.particle.position - place).norm() < 1e-13, "{}", b.particle.position);
        assert!((b.particle.velocity - turned(a.particle.velocity)).norm() < 1e-13);
        assert!((b.particle.spin - turned(a.particle.spin)).norm() < 1e-9);
        assert_eq!((a.time, a.particle.id), (b.time, b.particle.id));
    }
    let down = tool(folder.path(), "dem-run", &["down.toml", "in.mcap", "-o", "x.mcap"]);
    assert!(down.code == 1 && down.stderr.contains("was made for the plane"), "{}", down.stderr);
    let raised = ["--set", "inlet.0.plane=0,0,0.5,0,0,-1"];
    succeed(folder.path(), "dem-run", &[&["down.toml", "in.mcap", "-o", "x.mcap"], &raised[..]].concat());
}

/// One after the other, each as the first, with ids of their own.
#[test]
fn a_record_replayed_three_times() {
    let folder = recorded();
    let once = replay(folder.path(), &[]);
    let thrice = replay(folder.path(), &["--repeat", "3", "--period", "0.4"]);
    assert_eq!(thrice.len(), 3 * once.len());
    for (k, b) in thrice.iter().enumerate() {
        let a = &once[k % once.len()];
        assert!((b.time - a.time - 0.4 * (k / once.len()) as f64).abs() < 1e-12);
        assert_eq!((b.particle.position, b.particle.velocity), (a.particle.position, a.particle.velocity));
        assert_eq!(b.particle.id, k as u32, "new ids in the order of entry");
    }
    let short = tool(
        folder.path(),
        "stage-replay",
        &["up.mcap", "--repeat", "2", "--period", "0.01", "-o", "x.mcap"],
    );
    assert!(
        short.code == 1 && short.stderr.contains("--period 0.01 s is shorter than the record"),
        "{}",
        short.stderr
    );
    let ids = replay(folder.path(), &["--first-id", "1000000"]);
    assert_eq!(ids[3].particle.id, 1_000_003);
}

/// What follows is not promised away: the stage downstream takes the grains of every replay, also where the run went on long after its
/// last grain, and where part of it is replayed with the period that this part has.
#[test]
fn a_stage_downstream_takes_all_replays() {
    let folder = plant();
    succeed(folder.path(), "dem-run", &["up.toml", "--until", "0.9", "-o", "up.mcap"]);
    let all = passages(&folder.path().join("up.mcap"));
    let (first, last) = (all[0].time, all[all.len() - 1].time);
    assert!(last < 0.5, "the last one passes at {last} s");
    let period = format!("--period={}", last - first + 0.01);
    let until = format!("--until={}", last + 0.01);
    for options in [["--repeat=2", &period], ["--repeat=2", &until]] {
        let rows = replay(folder.path(), &options);
        let end = (rows[rows.len() - 1].time + 0.1).to_string();
        let run = ["down.toml", "in.mcap", "--until", &end, "--report", "r.json", "-o", "down.mcap"];
        succeed(folder.path(), "dem-run", &run);
        let report = std::fs::read_to_string(folder.path().join("r.json")).unwrap();
        let report: serde_json::Value = serde_json::from_str(&report).unwrap();
        assert_eq!((rows.len(), report["entered"].as_u64()), (2 * all.len(), Some(2 * all.len() as u64)));
    }
}

/// Superposed copies: beside each other they come in together, in each other they are refused; the file says what they are.
#[test]
fn superposed_copies_scale_the_rate() {
    let folder = recorded();
    let once = replay(folder.path(), &[]);
    let twice = replay(folder.path(), &["--copies", "2", "--copy-shift", "0.2,0,0"]);
    assert_eq!(twice.len(), 2 * once.len());
    let beside = twice.iter().filter(|p| p.particle.position.x > 0.1).count();
    assert_eq!(beside, once.len());
    let ids: BTreeSet<u32> = twice.iter().map(|p| p.particle.id).collect();
    assert_eq!(ids.len(), twice.len());
    let done = succeed(
        folder.path(),
        "stage-replay",
        &["up.mcap", "-o", "in.mcap", "--copies", "2", "--copy-shift", "0.2,0,0", "--report", "r.json"],
    );
    assert!(
        done.stderr.contains("they scale the rate, but a real flow of that rate looks different"),
        "{}",
        done.stderr
    );
    let report = std::fs::read_to_string(folder.path().join("r.json")).unwrap();
    assert!(report.contains("\"copies\": 2") || report.contains("\"copies\":2"), "{report}");
    let inside = tool(
        folder.path(),
        "stage-replay",
        &["up.mcap", "--copies", "2", "--copy-shift", "0.001,0,0", "-o", "x.mcap"],
    );
    assert!(inside.code == 1 && inside.stderr.contains("overlaps copy"), "{}", inside.stderr);
    assert!(inside.stderr.contains("--copy-shift"), "{}", inside.stderr);
    let none = tool(folder.path(), "stage-replay", &["up.mcap", "--copies", "2", "-o", "x.mcap"]);
    assert!(none.code == 2 && none.stderr.contains("the copies would overlap"), "{}", none.stderr);
}

/// A longer way ahead, for those that are slow: they are generated farther back, and arrive as before.
#[test]
fn all_are_generated_earlier_when_asked_for() {
    let folder = recorded();
    let near = replay(folder.path(), &["--ahead", "0.02"]);
    let far = replay(folder.path(), &["--ahead", "0.05"]);
    for (a, b) in near.iter().zip(&far) {
        assert_eq!(a.time, b.time);
        let back = a.particle.position - a.particle.velocity * 0.03;
        assert!((b.particle.position - back).norm() < 1e-13);
    }
    let done = tool(folder.path(), "stage-replay", &["up.mcap", "--ahead", "0.001", "-o", "in.mcap"]);
    assert!(done.stderr.contains("start less than the largest diameter"), "{}", done.stderr);
    assert!(done.stderr.contains("--ahead"), "{}", done.stderr);
}

/// Passages counted in whole steps: each at the end of its step, in the same order, from the same places in the zone.
#[test]
fn passages_counted_in_steps() {
    let folder = plant();
    succeed(folder.path(), "dem-run", &["up.toml", "--set", "time.dt=8e-6", "-o", "up.mcap"]);
    let zone = ["--keep-times", "--intervals", "generation"];
    let exact = replay(folder.path(), &zone);
    let counted = replay(folder.path(), &[&zone[..], &["--passage", "steps"]].concat());
    assert!(exact.len() > 30 && exact.len() == counted.len());
    for (a, b) in exact.iter().zip(&counted) {
        let steps = b.time / 8e-6;
        assert!((steps - steps.round()).abs() < 1e-6, "{steps} steps");
        assert!(b.time - a.time >= -1e-12 && b.time - a.time < 8e-6, "{} {}", a.time, b.time);
        assert_eq!(a.particle, b.particle);
    }
    assert!(exact.iter().any(|a| (a.time / 8e-6).fract() > 0.1 && (a.time / 8e-6).fract() < 0.9));
}
