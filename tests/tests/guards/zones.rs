//! The guard of zones: grains that come back through their inlet, and those that come in too fast.

use super::{HEAD, exact, scene, stopped};
use grainpipe_tests::tools::{succeed, tool};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A downstream stage: grains fall in at 1 m/s, hit a plate behind the plane, and fly back up.
pub(super) fn bounce() -> TempDir {
    bounced("1,0,0,0.04,0.01,0,0,-1,0,0,0\n")
}

/// The same with these grains upstream.
pub(super) fn bounced(grains: &str) -> TempDir {
    let folder = scene(grains, "");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("written");
    let head = HEAD.replace("source = \"p.csv\"\n", "").replace("[[particles]]\nmaterial = \"glass\"\n", "");
    let head = head.replace("until = 0.02", "until = 0.3").replace("every = 0.002", "every = 0.02");
    let head = head.replace("restitution = 0.9", "restitution = 1");
    let grains = "[[particles]]\nmaterial = \"glass\"\nsource = \"p.csv\"\n";
    write("up.toml", &format!("{head}{grains}[[outlet]]\nplane = \"0,0,0,0,0,-1\"\n"));
    let plate = "[[wall]]\nplane = \"0,0,-0.05,0,0,1\"\nmaterial = \"glass\"\n";
    write("down.toml", &format!("{head}[[inlet]]\nplane = \"0,0,0,0,0,-1\"\n{plate}"));
    succeed(folder.path(), "dem-run", &["up.toml", "-o", "up.mcap"]);
    succeed(folder.path(), "stage-replay", &["up.mcap", "-o", "in.mcap"]);
    folder
}

#[test]
fn a_grain_that_comes_back_through_its_inlet() {
    let folder = bounce();
    fs::copy(folder.path().join("down.toml"), folder.path().join("s.toml")).expect("copied");
    let words = [
        "inlet 0",
        "behind the generation plane",
        "cut the plant farther upstream",
        "to take out grains that came back",
    ];
    stopped(folder.path(), "zones: a grain comes back", &["in.mcap"], &words);
    let off = ["in.mcap", "--set", "guards.zones=false"];
    exact(folder.path(), "zones", &off);
}

/// The downstream run of that folder in which grains that come back are taken out: it ends, and so many are taken out and left. What it
/// prints, and the share of energy that the step made.
fn removes(folder: &Path, until: &str, [out, left]: [i32; 2]) -> (String, f64) {
    let sets = ["--set", "guards.zones=\"remove\"", "--set", "output.energy=true", "--until", until];
    let files = ["down.toml", "in.mcap", "-o", "run.mcap", "--report", "r.json"];
    let done = succeed(folder, "dem-run", &[&files[..], &sets].concat());
    let report: Value = serde_json::from_slice(&fs::read(folder.join("r.json")).unwrap()).unwrap();
    assert_eq!(
        (&report["returned"]["removed"][0], &report["particles"]),
        (&Value::from(out), &Value::from(left)),
        "{report}"
    );
    let made = report["integration"]["share"].as_f64().unwrap_or_else(|| panic!("{report}"));
    (done.stderr, made)
}

#[test]
fn a_grain_that_comes_back_through_its_inlet_is_removed() {
    let (told, made) = removes(bounce().path(), "0.3", [1, 0]);
    assert!(made.abs() < 1e-2, "{made}");
    assert!(told.contains("inlet.0: 1 grains were taken out (guards.zones = \"remove\")"), "{told}");
}

/// The first grain flies back up into the zone just as the second comes in there, a little beside it.
#[test]
fn a_grain_in_the_way_of_one_that_comes_in_is_removed() {
    let folder = bounced("1,0,0,0.03,0.01,0,0,-1,0,0,0\n2,0.001,0,0.15,0.01,0,0,-1,0,0,0\n");
    let on_top = tool(folder.path(), "dem-run", &["down.toml", "in.mcap", "-o", "stopped.mcap"]);
    assert!(on_top.code == 3 && on_top.stderr.contains("on top of particle 1"), "{}", on_top.stderr);
    let (_, made) = removes(folder.path(), "0.15", [1, 1]);
    assert!(made.abs() < 1e-2, "{made}");
}

/// The first grain is back in the zone when the second, on its way in, runs into it deeper than the guard allows.
#[test]
fn a_grain_that_one_on_its_way_in_runs_into_is_removed() {
    let folder = bounced("1,0,0,0.03,0.01,0,0,-1,0,0,0\n2,0.001,0,0.13,0.01,0,0,-1,0,0,0\n");
    let hard = fs::read_to_string(folder.path().join("down.toml")).expect("read");
    let soft = hard.replace("young = 1e7", "young = 2e4").replace("until = 0.3", "until = 0.15");
    let (soft, wall) = soft.split_once("[[inlet]]").expect("an inlet");
    // The plate stays hard.
    let steel = "[[material]]\nname = \"steel\"\nyoung = 1e9\npoisson = 0.2\n\
                 [[contact]]\nbetween = [\"glass\", \"steel\"]\nlaw = \"hooke\"\nstiffness = 1e5\nrestitution = 1\n";
    let wall = wall.replace("material = \"glass\"", "material = \"steel\"");
    fs::write(folder.path().join("down.toml"), [soft, steel, "[[inlet]]", &wall].concat()).expect("written");
    let (_, made) = removes(folder.path(), "0.15", [1, 1]);
    assert!(made.abs() < 1e-2, "{made}");
}

#[test]
fn a_grain_that_comes_in_too_fast() {
    let folder = bounce();
    fs::copy(folder.path().join("down.toml"), folder.path().join("s.toml")).expect("copied");
    let words = ["comes in by inlet 0 at 1.0000e0 m/s", "shorten time.dt", "raise guards.motion"];
    stopped(
        folder.path(),
        "zones: a grain too fast for the step",
        &["in.mcap", "--set", "guards.motion=5e-4"],
        &words,
    );
}
