//! Cracks, fragments and grading of stones that fall on a floor and break.

use super::{column, failed, measure, sum};
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::succeed;
use std::fs;
use tempfile::TempDir;

/// Two stones of hexagonally packed grains, of which only those of one stone are bonded; one falls fast.
const SCENE: &str = r#"
gravity = [0, 0, -9.81]
[time]
until = 0.02
[output]
every = 0.002
[[material]]
name = "rock"
density = 2600
young = 1e8
poisson = 0.25
[[contact]]
between = ["rock", "rock"]
law = "hooke"
stiffness = 1e5
restitution = 0.3
sliding_friction = 0.4
[[bond]]
between = ["rock", "rock"]
kind = "contact"
gap = 1e-6
normal_stiffness = 1e5
shear_stiffness = 4e4
tensile_force = 1
shear_force = 0.7
weibull_modulus = 5
seed = 2
[[fill]]
material = "rock"
shape = "sphere:0,0,0.0102,0.01"
diameter = 0.004
lattice = "hexagonal"
cluster = 1
velocity = [0, 0, -3]
[[fill]]
material = "rock"
shape = "box:0.01,-0.004,0.0002,0.018,0.004,0.0082"
diameter = 0.004
lattice = "cubic"
cluster = 2
[[wall]]
name = "floor"
plane = "0,0,0,0,0,1"
material = "rock"
"#;

fn broken() -> TempDir {
    let folder = folder(&[("s.toml", SCENE)]);
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
    folder
}

#[test]
fn cracks_are_the_bonds_that_broke() {
    let folder = broken();
    let (cracks, bonds) = (measure(&folder, &["--cracks"]), measure(&folder, &["--bonds"]));
    let last = |name: &str| *column(&bonds, name).last().unwrap();
    let modes = column(&cracks, "mode");
    let count = |mode: f64| modes.iter().filter(|m| **m == mode).count() as f64;
    assert!(count(1.0) > 0.0 && count(2.0) > 0.0, "both ways: {modes:?}");
    assert_eq!([count(1.0), count(2.0)], [last("broken_by_tension"), last("broken_by_shear")]);
    let times = column(&cracks, "time");
    assert!(times.windows(2).all(|t| t[0] <= t[1]), "in their order");
    assert!(column(&cracks, "energy").iter().all(|e| *e > 0.0));
    // Stones that touch are not bonded.
    assert_eq!(column(&cracks, "cluster_i"), column(&cracks, "cluster_j"));
    let since = sum(&folder, &["--cracks", "--from", "0.005"], "cracks");
    assert_eq!(since, times.iter().filter(|t| **t >= 0.005).count() as f64);
}

#[test]
fn a_resumed_run_tells_each_crack_once() {
    let folder = broken();
    let all = column(&measure(&folder, &["--cracks"]), "id_i");
    for stop in ["0.004", "0.0031"] {
        succeed(folder.path(), "dem-run", &["s.toml", "--until", stop, "-o", "run.mcap"]);
        let first = column(&measure(&folder, &["--cracks"]), "id_i");
        succeed(folder.path(), "dem-run", &["s.toml", "--resume", "run.mcap", "-o", "rest.mcap"]);
        fs::rename(folder.path().join("rest.mcap"), folder.path().join("run.mcap")).unwrap();
        let rest = column(&measure(&folder, &["--cracks"]), "id_i");
        assert!(!first.is_empty() && !rest.is_empty(), "{stop}");
        assert_eq!([first, rest].concat(), all, "{stop}");
    }
}

#[test]
fn fragments_and_grading_hold_all_mass() {
    let folder = broken();
    let fragments = measure(&folder, &["--fragments"]);
    let (grains, mass) = (column(&fragments, "grains"), column(&fragments, "mass"));
    let all: f64 = grains.iter().sum();
    let one = 2600.0 * std::f64::consts::PI / 6.0 * 0.004f64.powi(3);
    assert!((mass.iter().sum::<f64>() / (all * one) - 1.0).abs() < 1e-9);
    assert!(grains.contains(&8.0), "the block stays whole: {grains:?}");
    let grading = measure(&folder, &["--grading", "--sieves", "0.005,0.01,0.03"]);
    let (before, after) = (column(&grading, "passing_before"), column(&grading, "passing_after"));
    assert_eq!([before[0], before[2], after[2]], [0.0, 1.0, 1.0]);
    assert!(after[0] > 0.1, "{after:?}");
    assert!(sum(&folder, &["--grading", "--sieves", "0.005,0.01,0.03"], "breakage") > 0.1);
    for (arguments, part) in [
        (&["--grading", "--sieves", "0.01,0.005"][..], "the smallest first"),
        (&["--bonds", "--sieves", "0.01"], "--sieves: is an option of --grading"),
        (&["--cracks", "--last"], "--cracks is measured over time"),
    ] {
        let message = failed(&folder, arguments);
        assert!(message.contains(part), "{message}");
    }
}
