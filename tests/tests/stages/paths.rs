//! Recorded paths from the cut to the stage downstream.

use super::text;
use grainpipe_tests::recorded::{frames, tables};
use grainpipe_tests::scenes::{AT, folder};
use grainpipe_tests::tools::{line, succeed, tool};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn plant() -> TempDir {
    let folder = folder(&[("plant.toml", text())]);
    for (keep, file) in [("upstream", "up.toml"), ("downstream", "down.toml")] {
        let cut = ["plant.toml", "--at", AT, "--keep", keep, "--motion", "recorded", "-o", file];
        succeed(folder.path(), "stage-split", &cut);
    }
    folder
}

/// Places of the last frame, by id.
fn places(path: &Path) -> BTreeMap<u32, [f64; 3]> {
    let table = frames(path).pop().unwrap();
    let column = |name: &str| table.get(name).unwrap().to_f64();
    let (ids, [x, y, z]) = (column("id"), ["x", "y", "z"].map(column));
    ids.iter().enumerate().map(|(k, id)| (*id as u32, [x[k], y[k], z[k]])).collect()
}

/// One after the other and live, the same bytes; and grains behind the plane are where those of the undivided plant are.
#[test]
fn paths_lead_on_to_where_the_undivided_plant_has_its_grains() {
    let folder = plant();
    let done = line(
        folder.path(),
        "dt='--set time.dt=4e-6'; dem-run up.toml $dt -o up.mcap && stage-replay up.mcap --keep-times -o in.mcap \
         && dem-run down.toml in.mcap $dt --until 0.14 -o after.mcap \
         && dem-run up.toml $dt | stage-replay --keep-times | dem-run down.toml - $dt --until 0.14 -o piped.mcap \
         && dem-run plant.toml $dt --until 0.14 -o whole.mcap",
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("after.mcap") == bytes("piped.mcap"), "live and one after the other");
    let (whole, down) =
        (places(&folder.path().join("whole.mcap")), places(&folder.path().join("after.mcap")));
    let mut apart: Vec<f64> = Vec::new();
    for (id, p) in &down {
        let q = &whole[id];
        apart.push((0..3).map(|a| (p[a] - q[a]).powi(2)).sum::<f64>().sqrt());
    }
    apart.sort_by(f64::total_cmp);
    let passed = whole.values().filter(|p| p[2] < 0.0).count();
    assert!(passed > 10 && apart.len() >= passed, "{} of {passed}", apart.len());
    let (median, most) = (apart[apart.len() / 2], apart[apart.len() - 1]);
    // Grains that touched in the zone are a little smoothed; what they do next is their own.
    assert!(median < 1e-6 && most < 1e-3, "{median} m, {most} m apart");
}

/// Samples that are farther apart than a run reads ahead (256 of its steps): grains are between them all the same, not on a straight line
/// on from the last one.
#[test]
fn a_small_step_downstream_follows_the_same_paths() {
    let folder = plant();
    let done = line(
        folder.path(),
        // The last frame is a quarter of the way from one sample to the next.
        "frame='--set output.every=0.030052 --until 0.060104'; \
         dem-run up.toml --set time.dt=4e-6 --set outlet.0.samples=4e-4 -o up.mcap \
         && stage-replay up.mcap --keep-times -o in.mcap \
         && dem-run down.toml in.mcap --set time.dt=4e-6 $frame -o large.mcap \
         && dem-run down.toml in.mcap --set time.dt=1e-6 $frame -o small.mcap",
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let (large, small) =
        (places(&folder.path().join("large.mcap")), places(&folder.path().join("small.mcap")));
    assert!(large.len() > 3 && large.keys().eq(small.keys()), "{} grains, {}", large.len(), small.len());
    assert!(large.values().all(|p| p[2] > 0.0), "in the zone");
    for (id, p) in &large {
        let apart = (0..3).map(|a| (p[a] - small[id][a]).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-11, "grain {id} is {apart} m apart");
    }
}

/// Rows of the paths of a run.
fn samples(path: &Path) -> usize {
    tables(path, "/crossings/paths").iter().map(|table| table.rows()).sum()
}

/// A run that a guard stops between two frames and the one that goes on from it have all samples between them.
#[test]
fn no_sample_is_lost_where_a_guard_stopped_the_run() {
    let folder = plant();
    let all = "--set time.dt=4e-6 --set outlet.0.samples=4e-6 --until 0.08";
    let done = line(folder.path(), &format!("dem-run up.toml {all} --set guards.motion=6e-4 -o part.mcap"));
    assert!(done.code == 3 && done.stderr.contains("in one step"), "{}", done.stderr);
    let done = line(
        folder.path(),
        &format!(
            "dem-run up.toml {all} -o whole.mcap && dem-run up.toml {all} --resume part.mcap -o rest.mcap"
        ),
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let [whole, part, rest] =
        ["whole", "part", "rest"].map(|n| samples(&folder.path().join(format!("{n}.mcap"))));
    assert!(part > 1000 && rest > 1000, "{part} and {rest}");
    assert_eq!(part + rest, whole);
}

#[test]
fn what_does_not_go_with_paths_is_refused() {
    let folder = plant();
    succeed(folder.path(), "dem-run", &["up.toml", "--until", "0.1", "-o", "up.mcap"]);
    let replay = |options: &[&str]| {
        tool(folder.path(), "stage-replay", &[&["up.mcap", "-o", "x.mcap"], options].concat())
    };
    let done = replay(&["--length", "0.03"]);
    assert!(
        done.code == 1 && done.stderr.contains("--length does not work with recorded paths"),
        "{}",
        done.stderr
    );
    assert_eq!(
        replay(&["--length", "0.03", "--move", "ballistic"]).code,
        0,
        "the record serves other motions, too"
    );
    let rare = tool(folder.path(), "dem-run", &["up.toml", "--set", "outlet.0.samples=0.05", "-o", "x.mcap"]);
    assert!(
        rare.code == 1 && rare.stderr.contains("outlet.0.samples = 0.05 s: is more than 100 steps"),
        "{}",
        rare.stderr
    );
    let constant = ["up.toml", "--set", "outlet.0.motion=constant", "--until", "0.1", "-o", "up2.mcap"];
    succeed(folder.path(), "dem-run", &constant);
    let none = tool(folder.path(), "stage-replay", &["up2.mcap", "--move", "recorded", "-o", "x.mcap"]);
    assert!(none.code == 1 && none.stderr.contains("has no paths"), "{}", none.stderr);
}
