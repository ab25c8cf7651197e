//! The mark of a plant: a record serves every variant of what lies behind the cut, and not another hopper or other grains.

use grainpipe_tests::tools::succeed;
use std::fs;
use std::path::Path;
use tempfile::tempdir;

const PLANT: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 0.3
[[material]]
name = "sinter"
density = 3300
young = 5e7
poisson = 0.25
[[material]]
name = "steel"
young = 2e8
poisson = 0.3
[[material]]
name = "liner"
young = 1e7
poisson = 0.4
[[contact]]
between = ["*", "*"]
restitution = 0.5
sliding_friction = 0.3
[[contact]]
between = ["sinter", "sinter"]
restitution = 0.6
sliding_friction = 0.5
[[contact]]
between = ["sinter", "liner"]
restitution = 0.4
sliding_friction = 0.2
[[fill]]
material = "sinter"
shape = "cylinder:0,0,0.02,0,0,0.12,0.04"
diameter = [0.008, 0.012]
mass = 0.15
[[wall]]
name = "hopper"
mesh = "hopper.ply"
material = "steel"
[[wall]]
name = "chute"
mesh = "chute.ply"
material = "liner"
[[wall]]
name = "floor"
plane = "0,0,-0.5,0,0,1"
material = "liner"
"#;

/// A triangle 0.05 m high, its lowest corner at `low` [m].
fn triangle(path: &Path, low: f64) {
    let text = format!(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
         property list uchar int vertex_indices\nend_header\n0.1 0 {low}\n0.2 0 {low}\n0.1 0.1 {}\n3 0 1 2\n",
        low + 0.05
    );
    fs::write(path, text).unwrap();
}

/// The mark that the stage of a plant gets.
fn mark(folder: &Path, plant: &str, keep: &str) -> String {
    fs::write(folder.join("plant.toml"), plant).unwrap();
    let cut = ["plant.toml", "--at", "0,0,0,0,0,-1", "--keep", keep, "-o", "stage.toml"];
    succeed(folder, "stage-split", &cut);
    let stage = fs::read_to_string(folder.join("stage.toml")).unwrap();
    stage.lines().find_map(|l| l.strip_prefix("plant = ")).expect("a mark").to_owned()
}

#[test]
fn a_mark_tells_another_upstream_stage_and_no_other_downstream_one() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    for (file, low) in [("hopper.ply", 0.05), ("hopper2.ply", 0.051), ("copy.ply", 0.05)] {
        triangle(&folder.join(file), low);
    }
    for (file, low) in [("chute.ply", -0.2), ("chute2.ply", -0.05)] {
        triangle(&folder.join(file), low);
    }
    let first = mark(folder, PLANT, "upstream");
    let of = |from: &str, to: &str| {
        assert!(PLANT.contains(from), "{from}");
        mark(folder, &PLANT.replace(from, to), "downstream")
    };
    assert_eq!(mark(folder, PLANT, "downstream"), first);
    let turns =
        "mesh = \"chute.ply\"\nmotion = { rotate = { about = [0, 1, 0], through = [0, 0, -0.2], rpm = 10 } }";
    let other_floor = "poisson = 0.4\n[[material]]\nname = \"rubber\"\nyoung = 1e6\npoisson = 0.4";
    for (from, to) in [
        ("mesh = \"chute.ply\"", "mesh = \"chute2.ply\""),
        ("mesh = \"chute.ply\"", turns),
        ("mesh = \"chute.ply\"", "plane = \"0,0,-0.2,0.5,0,1\""),
        ("young = 1e7", "young = 2e7"),
        ("sliding_friction = 0.2", "sliding_friction = 0.25"),
        ("mesh = \"chute.ply\"\nmaterial = \"liner\"", "mesh = \"chute.ply\"\nmaterial = \"steel\""),
        ("poisson = 0.4", other_floor),
        ("plane = \"0,0,-0.5,0,0,1\"", "plane = \"0,0,-0.6,0,0,1\""),
        ("until = 0.3", "until = 0.4"),
        ("name = \"hopper\"", "name = \"bunker\""),
        ("hopper.ply", "copy.ply"),
    ] {
        assert_eq!(of(from, to), first, "a variant: {to}");
    }
    for (from, to) in [
        ("hopper.ply", "hopper2.ply"),
        ("sliding_friction = 0.5", "sliding_friction = 0.6"),
        ("sliding_friction = 0.3", "sliding_friction = 0.35"),
        ("young = 5e7", "young = 6e7"),
        ("mass = 0.15", "mass = 0.14"),
        ("-9.81", "-9.8"),
    ] {
        assert_ne!(of(from, to), first, "another plant: {to}");
    }
}

/// A file of the same name whose triangles have changed is another hopper.
#[test]
fn a_mesh_that_was_written_again_changes_the_mark() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    triangle(&folder.join("hopper.ply"), 0.05);
    triangle(&folder.join("chute.ply"), -0.2);
    let first = mark(folder, PLANT, "upstream");
    triangle(&folder.join("chute.ply"), -0.25);
    assert_eq!(mark(folder, PLANT, "downstream"), first);
    triangle(&folder.join("hopper.ply"), 0.06);
    assert_ne!(mark(folder, PLANT, "downstream"), first);
}
