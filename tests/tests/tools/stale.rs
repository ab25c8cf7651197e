//! Results that are used again: only as long as every file that they were made from is what it was.

use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{line, succeed};
use std::fs;
use std::path::Path;

/// Two grains whose places are in a file that the scene names.
const SCENE: &str = r#"[time]
until = 0.002
dt = 1e-5
[output]
every = 0.002
[[material]]
name = "a"
density = 2600
young = 1e6
poisson = 0.25
[[contact]]
between = ["*", "*"]
restitution = 0.5
[[particles]]
material = "a"
source = "grains.csv"
"#;

const RECIPE: &str = r#"[settings]
trials = 6
first = 4
batch = 2
[[parameter]]
name = "g"
bounds = [1, 3]
[[test]]
name = "t"
command = "dem-run {here}/s.toml -q -o r.mcap && dem-measure r.mcap --track 0 -q | tail -1 | awk -F, -v g={g} '{ print $3 * g }'"
value = 4
deviation = 0.1
"#;

fn grains(folder: &Path, x: f64) {
    fs::write(folder.join("grains.csv"), format!("x,y,z,radius\n{x},0,0,0.1\n9,0,0,0.1\n")).unwrap();
}

/// The value found by a calibration.
fn found(folder: &Path, out: &str) -> f64 {
    succeed(folder, "calibrate", &["r.toml", "-q", "--jobs", "1", "-o", out]);
    let text = fs::read_to_string(folder.join(out)).unwrap();
    let row: Vec<&str> = text.lines().nth(1).unwrap().split(',').collect();
    row.iter().filter_map(|cell| cell.parse().ok()).next().unwrap()
}

/// The recipe's line names the scene; the scene names the file that changes. The folder has a space, so that the line has quotes.
#[test]
fn a_trial_is_made_again_when_a_file_that_its_scene_names_has_changed() {
    let outer = folder::<&str>(&[]);
    let plant = outer.path().join("my plant");
    fs::create_dir(&plant).unwrap();
    fs::write(plant.join("s.toml"), SCENE).unwrap();
    fs::write(plant.join("r.toml"), RECIPE).unwrap();
    grains(&plant, 2.0);
    let first = found(&plant, "a.csv");
    assert!((first - 2.0).abs() < 0.2, "{first}");
    assert!((found(&plant, "again.csv") - first).abs() < 1e-12, "nothing has changed");
    grains(&plant, 4.0);
    let then = found(&plant, "b.csv");
    assert!((then - 1.0).abs() < 0.2, "{then}");
}

/// The line before each run reads a file from stdin, which no word of it names as an argument.
#[test]
fn a_point_is_made_again_when_the_file_behind_its_line_has_changed() {
    let folder = folder(&[("s.toml", SCENE)]);
    let path = folder.path();
    grains(path, 2.0);
    fs::write(path.join("my scan.xyz"), "0 0 -1\n0.1 0 -1\n0 0.1 -1\n0.1 0.1 -1\n").unwrap();
    let sweep = |each: &str| {
        let call = format!(
            "cost-curve s.toml --vary safety=0.2,0.4 --reference safety=0.2 --in-use safety=0.4 --set time.dt='\"auto\"' --set output.every=0.02 \
             --set time.until=0.04 --phases 1 --measure bed-height --work steps --dir points --report r.json -q --each '{each}'"
        );
        let done = line(path, &call);
        assert_eq!(done.code, 0, "{}", done.stderr);
        fs::read_to_string(path.join("r.json")).unwrap()
    };
    let each = "F=\"my scan.xyz\"; wallgen --roughness 0.001 --radius 0.02 --material a -q < \"$F\"";
    sweep(each);
    assert!(sweep(each).contains("2 of them made before"), "nothing has changed");
    fs::write(path.join("my scan.xyz"), "0 0 -2\n0.1 0 -2\n0 0.1 -2\n0.1 0.1 -2\n").unwrap();
    assert!(sweep(each).contains("0 of them made before"), "the scan is another");
}
