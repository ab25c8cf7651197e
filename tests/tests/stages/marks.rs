//! The mark of a plant: a record serves every variant of what lies behind the cut, and not another hopper or other grains.

use grainpipe_tests::scenes::{ABOVE, AT, Head, SINTER};
use grainpipe_tests::tools::succeed;
use std::fs;
use std::path::Path;
use tempfile::tempdir;

/// A hopper and a chute of triangles, a floor; each of its own material.
fn plant() -> String {
    let head = Head { output: "", contact: "restitution = 0.5\nsliding_friction = 0.3", ..SINTER };
    head.toml() + ABOVE + WALLS
}

const WALLS: &str = r#"[[material]]
name = "steel"
young = 2e8
poisson = 0.3
[[material]]
name = "liner"
young = 1e7
poisson = 0.4
[[contact]]
between = ["sinter", "sinter"]
restitution = 0.6
sliding_friction = 0.5
[[contact]]
between = ["sinter", "liner"]
restitution = 0.4
sliding_friction = 0.2
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
    let cut = ["plant.toml", "--at", AT, "--keep", keep, "-o", "stage.toml"];
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
    let plant = plant();
    let first = mark(folder, &plant, "upstream");
    let of = |from: &str, to: &str| {
        assert!(plant.contains(from), "{from}");
        mark(folder, &plant.replace(from, to), "downstream")
    };
    assert_eq!(mark(folder, &plant, "downstream"), first);
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
    let plant = plant();
    let first = mark(folder, &plant, "upstream");
    triangle(&folder.join("chute.ply"), -0.25);
    assert_eq!(mark(folder, &plant, "downstream"), first);
    triangle(&folder.join("hopper.ply"), 0.06);
    assert_ne!(mark(folder, &plant, "downstream"), first);
}

/// A silo of planes is upstream where grains start beside them; what planes do behind the cut, or far away, is no matter of the mark.
#[test]
fn planes_beside_the_column_of_grains_are_in_the_mark() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let silo = |material: &str, x: f64, low: f64| {
        let sides = format!(
            "box = [{}, -0.045, {low}, {x}, 0.045, 0.2]\nfaces = [\"x-\", \"x+\", \"y-\", \"y+\", \"z-\"]",
            -x
        );
        let plane = |p: &str| format!("[[wall]]\nplane = \"{p}\"\nmaterial = \"liner\"\n");
        let walls: String = ["0,0,-0.2,0.5,0,1", "1,0,0,-1,0,0"].map(plane).concat();
        let without = plant().split("[[wall]]").next().unwrap().to_owned();
        format!("{without}[[wall]]\nname = \"silo\"\n{sides}\nmaterial = \"{material}\"\n{walls}")
    };
    let first = mark(folder, &silo("steel", 0.045, -0.5), "upstream");
    let of = |text: &str| mark(folder, text, "downstream");
    let plain = silo("steel", 0.045, -0.5);
    assert_eq!(of(&plain), first);
    let other = |from: &str, to: &str| {
        assert!(plain.contains(from), "{from}");
        of(&plain.replace(from, to))
    };
    assert_eq!(of(&silo("steel", 0.045, -0.6)), first, "its floor is behind the cut");
    assert_eq!(other("0,0,-0.2,0.5,0,1", "0,0,-0.2,0.4,0,1"), first, "a chute");
    assert_eq!(other("1,0,0,-1,0,0", "1.5,0,0,-1,0,0"), first, "far away");
    assert_eq!(other("young = 1e7", "young = 2e7"), first, "its material");
    assert_ne!(of(&silo("steel", 0.047, -0.5)), first, "a wider silo");
    assert_ne!(of(&silo("liner", 0.045, -0.5)), first, "a silo of another material");
    let slanting = "0,0,-0.2,0.5,0,1";
    assert_ne!(other(slanting, "0.042,0,0,-0.9,0,0.1"), first, "a plane that cuts the column");
}

/// Clumps are in the mark with their shape.
#[test]
fn other_clumps_are_another_plant() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    let clumps = |x: f64| {
        let clump = format!(
            "[[clump]]\nname = \"pair\"\nmaterial = \"sinter\"\nspheres = [[0, 0, 0, 0.004], [{x}, 0, 0, 0.004]]\n"
        );
        let sized = "diameter = [0.008, 0.012]";
        let text = plant()
            .replace(sized, "clump = \"pair\"")
            .replace("[[fill]]\nmaterial = \"sinter\"\n", "[[fill]]\n");
        text.split("[[wall]]").next().unwrap().to_owned() + &clump
    };
    let first = mark(folder, &clumps(0.004), "upstream");
    assert_eq!(mark(folder, &clumps(0.004), "downstream"), first);
    assert_ne!(mark(folder, &clumps(0.005), "downstream"), first);
}
