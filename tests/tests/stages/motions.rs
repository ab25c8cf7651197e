//! Free fall in the zones, and the foremost point as what passes: from the cut to the stage downstream.

use super::{passages, text};
use dem::setup::Particle;
use geom::Vec3;
use grainpipe_tests::scenes::{AT, folder};
use grainpipe_tests::tools::{line, succeed, tool};
use stages::outlet::crossing::CrossingRow;
use std::fs;
use tempfile::TempDir;

const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.81);

/// Both stages with options of the cut, the upstream one done.
fn stages(cut: &[&str]) -> TempDir {
    let folder = folder(&[("plant.toml", text())]);
    for (keep, file) in [("upstream", "up.toml"), ("downstream", "down.toml")] {
        let split = ["plant.toml", "--at", AT, "--keep", keep, "-o", file];
        succeed(folder.path(), "stage-split", &[&split, cut].concat());
    }
    succeed(folder.path(), "dem-run", &["up.toml", "-o", "up.mcap"]);
    folder
}

/// When a passage that is generated arrives: t such that what is tested is on the plane z = 0, and its state then.
fn arrival(p: &CrossingRow, gravity: Vec3, lead: f64) -> (f64, Vec3, Vec3) {
    let Particle { position: x, velocity: v, .. } = p.particle;
    // z(τ) − lead = 0, going down.
    let depth = x.z - lead;
    let t = if gravity.z == 0.0 {
        -depth / v.z
    } else {
        (v.z + (v.z * v.z - 2.0 * gravity.z * depth).sqrt()) / -gravity.z
    };
    (p.time + t, x + v * t + gravity * (0.5 * t * t), v + gravity * t)
}

/// Whatever the motion, the test and the plane whose intervals are kept: each grain arrives as it was recorded.
#[test]
fn every_motion_brings_the_recorded_state_to_the_calculation_plane() {
    for (motion, gravity) in [("constant", Vec3::zeros()), ("ballistic", GRAVITY)] {
        for test in ["centre", "lowest"] {
            let folder = stages(&["--motion", motion, "--test", test, "--length", "0.02"]);
            let path = |name: &str| folder.path().join(name);
            let recorded = passages(&path("up.mcap"));
            assert!(recorded.len() > 30, "{}", recorded.len());
            for intervals in ["both", "generation"] {
                let options = ["up.mcap", "--intervals", intervals, "-o", "in.mcap"];
                succeed(folder.path(), "stage-replay", &options);
                let mut replayed = passages(&path("in.mcap"));
                assert!(replayed.windows(2).all(|w| w[0].time <= w[1].time), "time order");
                assert_eq!(replayed[0].time, 0.0, "{motion} {test} {intervals}");
                replayed.sort_by_key(|p| p.particle.id);
                let mut wanted = recorded.clone();
                wanted.sort_by_key(|p| p.particle.id);
                assert_eq!(wanted.len(), replayed.len());
                let lead = |p: &CrossingRow| if test == "lowest" { p.particle.radius } else { 0.0 };
                let first = recorded[0].time;
                let ahead = arrival(
                    &replayed[wanted.iter().position(|w| w.time == first).unwrap()],
                    gravity,
                    lead(&recorded[0]),
                )
                .0;
                for (a, b) in wanted.iter().zip(&replayed) {
                    let (time, x, v) = arrival(b, gravity, lead(b));
                    let what = format!("{motion} {test} {intervals}: grain {}", a.particle.id);
                    assert!((v - a.particle.velocity).norm() < 1e-10, "{what}: {v} {}", a.particle.velocity);
                    if intervals == "both" {
                        assert!((time - ahead - (a.time - first)).abs() < 1e-10, "{what}: {time} s");
                        assert!((x - a.particle.position).norm() < 1e-10, "{what}: {x}");
                    } else {
                        assert_eq!(b.time, a.time - first, "{what}");
                        assert!((b.particle.position.x - a.particle.position.x).abs() < 1e-14, "{what}");
                    }
                }
            }
            succeed(folder.path(), "stage-replay", &["up.mcap", "-o", "in.mcap"]);
            succeed(folder.path(), "dem-run", &["down.toml", "in.mcap", "-o", "down.mcap"]);
        }
    }
}

/// The stage downstream takes motion, test and gravity from the record, and refuses others.
#[test]
fn a_record_that_was_made_for_another_zone_is_refused() {
    let folder = stages(&["--motion", "ballistic", "--test", "lowest"]);
    succeed(folder.path(), "stage-replay", &["up.mcap", "-o", "in.mcap"]);
    let run =
        |set: &str| tool(folder.path(), "dem-run", &["down.toml", "in.mcap", "--set", set, "-o", "x.mcap"]);
    let told = [
        (
            "inlet.0.motion=constant",
            "inlet.0.motion = \"constant\"",
            "was made for \"ballistic\"",
            "--move constant",
        ),
        ("inlet.0.test=centre", "inlet.0.test = \"centre\"", "was made for \"lowest\"", "same test"),
        ("gravity=[0,0,-1.62]", "gravity = [0, 0, -1.62] m/s²", "[0, 0, -9.81] m/s²", "--move constant"),
        (
            "inlet.0.plant=0123456789abcdef",
            "inlet.0.plant = \"0123456789abcdef\"",
            "was made for",
            "stage-split",
        ),
    ];
    for (set, place, why, cure) in told {
        let done = run(set);
        assert_eq!(done.code, 1, "{set}: {}", done.stderr);
        for word in [place, why, cure, "in.mcap"] {
            assert!(done.stderr.contains(word), "{set}: '{word}' is not in {}", done.stderr);
        }
    }
    let line = line(
        folder.path(),
        "stage-replay up.mcap --move constant | dem-run down.toml - --set inlet.0.motion=constant -o x.mcap",
    );
    assert_eq!(line.code, 0, "{}", line.stderr);
}

/// Only what is upstream of the cut makes the mark: a record serves any number of downstream variants, and no other plant.
#[test]
fn a_record_of_another_plant_is_refused_and_another_chute_is_not() {
    let folder = stages(&[]);
    succeed(folder.path(), "stage-replay", &["up.mcap", "-o", "in.mcap"]);
    let cut = |text: String| {
        fs::write(folder.path().join("other.toml"), text).unwrap();
        let split = ["other.toml", "--at", AT, "--keep", "downstream", "-o", "other-down.toml"];
        succeed(folder.path(), "stage-split", &split);
        tool(folder.path(), "dem-run", &["other-down.toml", "in.mcap", "-o", "x.mcap"])
    };
    let lower = format!(
        "{}[[fill]]\nmaterial = \"sinter\"\nshape = \"box:-0.05,-0.05,-0.09,0.05,0.05,-0.05\"\ndiameter = 0.01\ncount = 3\n",
        text()
    );
    let done = cut(lower);
    assert_eq!(done.code, 0, "another downstream part: {}", done.stderr);
    let done = cut(text().replace("mass = 0.15", "mass = 0.14"));
    assert!(done.code == 1 && done.stderr.contains("inlet.0.plant"), "{}", done.stderr);
}
