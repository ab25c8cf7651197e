//! Steps on a device: the same file, byte for byte, and what is refused.

use super::{checkpoints, with};
use grainpipe_tests::tools::{succeed, tool};
use std::fs;
use std::path::Path;

/// Forty grains in a box whose floor shakes and one side of which runs like a belt.
const BOX: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 0.1
[output]
every = 0.02
checkpoint = 0.03
[[material]]
name = "sand"
density = 2650
young = 1e7
poisson = 0.25
[[contact]]
between = ["*", "*"]
restitution = 0.3
sliding_friction = 0.5
rolling_resistance = 0.1
[[fill]]
material = "sand"
shape = "box:0.001,0.001,0.001,0.029,0.029,0.06"
diameter = 0.008
count = 40
[[wall]]
box = [0, 0, 0, 0.03, 0.03, 0.1]
faces = ["x-", "x+", "y-", "y+"]
material = "sand"
[[wall]]
name = "floor"
plane = "0,0,0,0,0,1"
material = "sand"
motion = { vibrate = { amplitude = [0, 0, 2e-4], frequency = 50 } }
"#;

#[test]
fn a_device_writes_the_same_file() {
    let folder = with(BOX);
    let at = |name: &str| folder.path().join(name);
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "here.mcap"]);
    let done = succeed(folder.path(), "dem-run", &["s.toml", "--device", "local", "-o", "there.mcap"]);
    assert!(done.stderr.contains(" on this processor"), "{}", done.stderr);
    assert!(fs::read(at("here.mcap")).unwrap() == fs::read(at("there.mcap")).unwrap());
    // A run goes on on the other.
    succeed(
        folder.path(),
        "dem-run",
        &["s.toml", "--until", "0.07", "--device", "local", "-o", "begun.mcap"],
    );
    succeed(folder.path(), "dem-run", &["s.toml", "--resume", "begun.mcap", "-o", "rest.mcap"]);
    let last = |name: &str| checkpoints(&at(name)).pop();
    assert!(last("rest.mcap").is_some() && last("rest.mcap") == last("here.mcap"));
}

/// A guard that trips before anything was written says the same, and leaves a run that can go on.
#[test]
fn a_guard_says_the_same() {
    let folder = with(&BOX.replace("[[material]]", "[guards]\noverlap = 0.002\n[[material]]"));
    let said = |options: &[&str], out: &str| {
        let done = tool(folder.path(), "dem-run", &[&["s.toml", "-o", out], options].concat());
        assert_eq!(done.code, 3, "{}", done.stderr);
        let reason = done.stderr.lines().find(|line| line.contains("stopped by a guard")).expect("a guard");
        reason.split("; to go past").next().unwrap_or_default().to_owned()
    };
    assert_eq!(said(&["--device", "local"], "there.mcap"), said(&[], "here.mcap"));
    assert_eq!(checkpoints(&folder.path().join("there.mcap")).len(), 1);
}

#[test]
fn what_a_device_does_not_compute_is_named() {
    let scene = BOX.replace("[[contact]]", "[sleep]\nspeed = 1e-3\ntime = 0.1\n[[contact]]");
    let folder = with(&scene.replace("every = 0.02", "every = 0.02\nenergy = true"));
    let done = tool(folder.path(), "dem-run", &["s.toml", "--device", "local", "-o", "s.mcap"]);
    let expected =
        "--device: it does not compute sleep, the energy ledger (docs/how-to/gpu.md says what it does)";
    assert!(done.code != 0 && done.stderr.contains(expected), "{}", done.stderr);
    assert!(!folder.path().join("s.mcap").exists());
    let explained = |folder: &Path| {
        String::from_utf8(succeed(folder, "dem-run", &["s.toml", "--explain"]).stdout).unwrap()
    };
    let refused = explained(folder.path());
    assert!(refused.contains("\nGPU            does not compute sleep, the energy ledger\n"), "{refused}");
    let computed = explained(with(BOX).path());
    assert!(computed.contains("\nGPU            computes it: --device cuda\n"), "{computed}");
}

/// Where there is no GPU, and where there is none of this number.
#[test]
fn a_device_that_is_not_there() {
    let folder = with(BOX);
    let done = tool(folder.path(), "dem-run", &["s.toml", "--device", "cuda:99", "-o", "s.mcap"]);
    let none = ["there is no CUDA driver here", "there is no GPU 99 here"];
    assert!(done.code != 0 && none.iter().any(|why| done.stderr.contains(why)), "{}", done.stderr);
    assert!(done.stderr.contains("run without --device"), "{}", done.stderr);
    let done = tool(folder.path(), "dem-run", &["s.toml", "--device", "gpu", "-o", "s.mcap"]);
    assert!(
        done.code == 2 && done.stderr.contains("give cuda, cuda:1 for the second GPU, or local"),
        "{}",
        done.stderr
    );
}
