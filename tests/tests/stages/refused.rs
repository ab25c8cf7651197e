//! What does not go together in stages is refused where it is given, or told where it may be meant.

use super::{passages, plant, plant_of, text};
use grainpipe_tests::scenes::{AT, SINTER, write};
use grainpipe_tests::tools::{line, succeed, tool};
use std::fs;

/// Grains keep their mass on the way in.
#[test]
fn another_density_is_refused() {
    for motion in ["constant", "ballistic", "recorded"] {
        let folder = plant_of(&text(), &[], &["--motion", motion]);
        let done = line(folder.path(), "dem-run up.toml -o up.mcap && stage-replay up.mcap -o in.mcap");
        assert_eq!(done.code, 0, "{}", done.stderr);
        let done = tool(
            folder.path(),
            "dem-run",
            &["down.toml", "in.mcap", "--set", "material.0.density=1000", "-o", "x.mcap"],
        );
        assert_eq!(done.code, 1, "{motion}: {}", done.stderr);
        for wanted in ["material.0.density = 1000 kg/m³", "3300 kg/m³", "density of the stage upstream"] {
            assert!(done.stderr.contains(wanted), "{motion}: {wanted}: {}", done.stderr);
        }
    }
}

/// Stages that are cut again make grains of their own in each part: no two have one id.
#[test]
fn ids_of_three_stages_that_all_make_grains() {
    let fill = |z: f64| {
        format!(
            "[[fill]]\nmaterial = \"sinter\"\nshape = \"cylinder:0,0,{z},0,0,{},0.04\"\ndiameter = 0.01\ncount = 20\n",
            z + 0.05
        )
    };
    let floor = "[[wall]]\nplane = \"0,0,-0.5,0,0,1\"\nmaterial = \"sinter\"\n";
    let folder = plant_of(&(SINTER.toml() + &fill(0.05) + &fill(-0.15) + &fill(-0.4) + floor), &[], &[]);
    let at = "0,0,-0.25,0,0,-1";
    for (keep, file) in [("upstream", "middle.toml"), ("downstream", "last.toml")] {
        succeed(folder.path(), "stage-split", &["down.toml", "--at", at, "--keep", keep, "-o", file]);
    }
    let done = line(
        folder.path(),
        "dem-run up.toml | stage-replay | dem-run middle.toml - --set guards.overlap=1 | stage-replay | dem-run last.toml - --set guards.overlap=1 -o last.mcap",
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
}

/// Grains of a file that stays downstream have the ids that they had in the plant, and those that are filled in upstream, too.
#[test]
fn ids_of_a_file_that_stays_downstream() {
    let file = "id,x,y,z,radius\n0,0,0,-0.09,0.006\n7,0.03,0,-0.09,0.006\n";
    let own = "[[particles]]\nsource = \"own.csv\"\nmaterial = \"sinter\"\n";
    let folder = plant_of(&(text() + own), &[("own.csv", file)], &[]);
    let done = line(
        folder.path(),
        "dem-run up.toml -o up.mcap && stage-replay up.mcap | dem-run down.toml - -o down.mcap",
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let least = passages(&folder.path().join("up.mcap")).iter().map(|p| p.particle.id).min();
    assert!(least.is_some_and(|id| id >= 8), "{least:?}");
}

#[test]
fn cuts_that_no_grain_can_pass_are_refused() {
    let folder = plant();
    let domain = "[domain]\nperiodic = [\"x\"]\nlow = [-0.1, 0, 0]\nhigh = [0.1, 0, 0]\n";
    write(folder.path(), "periodic.toml", text() + domain);
    let split = |arguments: &[&str]| {
        tool(folder.path(), "stage-split", &[arguments, &["--keep", "upstream", "-o", "x.toml"]].concat())
    };
    for (arguments, wanted) in [
        (&["periodic.toml", "--at", "0.05,0,0,1,0,-1"][..], "periodic along x"),
        (&["up.toml", "--at", "0,0,-0.05,0,0,-1"], "outlet.0 is a cut upstream of this one"),
        (&["up.toml", "--at", AT], "outlet.0 is a cut upstream of this one"),
    ] {
        let done = split(arguments);
        assert!(done.code == 1 && done.stderr.contains(wanted), "{arguments:?}: {}", done.stderr);
    }
    let endless = split(&["plant.toml", "--at", AT, "--length", "inf"]);
    assert!(endless.code == 2 && endless.stderr.contains("not a finite number"), "{}", endless.stderr);
    assert_eq!(split(&["periodic.toml", "--at", AT]).code, 0, "along another axis");
    let done = line(
        folder.path(),
        "dem-run up.toml -o up.mcap && stage-replay up.mcap -o in.mcap && stage-replay in.mcap -o y.mcap",
    );
    assert!(done.code == 1 && done.stderr.contains("is an inlet already"), "{}", done.stderr);
}

/// What comes in from far away, or appears inside the zone, or ends before the run does, prints a warning.
#[test]
fn odd_inflow_is_told() {
    let file = "id,x,y,z,radius\n0,0,0,1e-9,0.005\n1,0.03,0,0.1,0.005\n2,0,0.03,0.15,0.005\n";
    let floor = "[[wall]]\nplane = \"0,0,-0.1,0,0,1\"\nmaterial = \"sinter\"\n";
    let scene = SINTER.toml() + "[[particles]]\nsource = \"slow.csv\"\nmaterial = \"sinter\"\n" + floor;
    let folder = plant_of(&scene, &[("slow.csv", file)], &[]);
    let done = line(folder.path(), "dem-run up.toml -o up.mcap && stage-replay up.mcap -o in.mcap");
    assert!(done.code == 0 && done.stderr.contains("2 grains start up to"), "{}", done.stderr);
    assert!(done.stderr.contains("--ahead"), "{}", done.stderr);

    let folder = plant_of(&text(), &[], &["--motion", "recorded"]);
    let done = line(
        folder.path(),
        "dem-run up.toml -o up.mcap && stage-replay up.mcap --from 0.15 -o in.mcap && stage-replay up.mcap -o all.mcap 2> all.txt",
    );
    assert!(
        done.code == 0 && done.stderr.contains("inside the zone when the replay begins"),
        "{}",
        done.stderr
    );
    assert!(!fs::read_to_string(folder.path().join("all.txt")).unwrap().contains("inside the zone"));
    let done = line(folder.path(), "stage-replay up.mcap --intervals generation -o x.mcap");
    assert!(
        done.code == 1 && done.stderr.contains("--intervals generation does not work with recorded paths"),
        "{}",
        done.stderr
    );

    let folder = plant();
    let done = line(
        folder.path(),
        "dem-run up.toml --until 0.14 -o up.mcap && stage-replay up.mcap --keep-times -o in.mcap && dem-run down.toml in.mcap -o down.mcap",
    );
    assert!(done.code == 0 && done.stderr.contains("inlet.0: the record ends at t = 0.1"), "{}", done.stderr);
    let done = line(
        folder.path(),
        "dem-run up.toml -o up.mcap && stage-replay up.mcap -o in.mcap && dem-run down.toml in.mcap --until 0.2 -o down.mcap",
    );
    assert!(done.code == 0 && !done.stderr.contains("the record ends"), "{}", done.stderr);
}
