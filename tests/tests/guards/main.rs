//! Guards of a run: each is tripped by a separate scene. The run ends with code 3, its file is whole, gives reason and remedy,
//! and ends in a checkpoint with numbers in it that a run can go on from.

mod refused;
mod remedies;
mod zones;

use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::tools::{Done, succeed, tool};
use std::fs;
use std::path::Path;
use stream::Table;
use stream::mcap::{Event, Reader};
use tempfile::{TempDir, tempdir};

const TRIPPED: Case = case("Guards", "stops with code 3, a reason and a remedy");
const RESUMES: Case =
    case("Guards", "the file of a stopped run is whole and ends in a checkpoint that resumes");
const EXACT: Case =
    case("Guards", "resumed with a raised guard: bit for bit as if the guard had not tripped");

const HEAD: &str = r#"[time]
until = 0.02
dt = 1e-5
[output]
every = 0.002
[[material]]
name = "glass"
density = 2500
young = 1e7
poisson = 0.2
[[contact]]
between = ["*", "*"]
restitution = 0.9
sliding_friction = 0.3
[[particles]]
material = "glass"
source = "p.csv"
"#;

/// A folder with a scene and its particles: id, x, y, z, radius, vx, vy, vz, wx, wy, wz.
fn scene(particles: &str, more: &str) -> TempDir {
    let folder = tempdir().expect("a folder");
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("written");
    write("s.toml", &format!("{HEAD}{more}"));
    write("p.csv", &format!("id,x,y,z,radius,vx,vy,vz,wx,wy,wz\n{particles}"));
    folder
}

struct Run {
    whole: bool,
    frames: Vec<(u64, Table)>,
    reason: String,
    last: String,
}

fn read(path: &Path) -> Run {
    let mut run = Run { whole: true, frames: Vec::new(), reason: String::new(), last: String::new() };
    for event in Reader::new(fs::File::open(path).expect("the file is there")) {
        let Ok(event) = event else {
            run.whole = false;
            break;
        };
        match event {
            Event::Points { topic, time_ns, table } => {
                run.last.clone_from(&topic);
                run.frames.extend((topic == "/particles").then_some((time_ns, table)));
            }
            Event::Bytes { topic, data, .. } => {
                let text = String::from_utf8_lossy(&data);
                if topic == "/log" && text.contains("\"stopped\"") {
                    run.reason = text.into_owned();
                }
                run.last = topic;
            }
            Event::Metadata { .. } => {}
        }
    }
    run
}

/// Runs a scene that a guard stops, and looks at all that must hold of its file.
fn stopped(folder: &Path, on: &str, set: &[&str], words: &[&str]) -> Done {
    let arguments = [&["s.toml", "-o", "run.mcap", "--threads", "1"], set].concat();
    let done = tool(folder, "dem-run", &arguments);
    println!("{on}: {}", done.stderr);
    TRIPPED.refused(on, &done.stderr, words);
    assert_eq!(done.code, 3, "{}", done.stderr);
    let run = read(&folder.join("run.mcap"));
    assert!(!folder.join("run.mcap.part").exists(), "{on}: it has its name");
    assert!(run.whole && run.last == "/checkpoint", "{on}: whole {}, ends in {}", run.whole, run.last);
    assert!(words.iter().all(|word| run.reason.contains(word)), "{on}: the log says {}", run.reason);
    let numbers = run.frames.iter().flat_map(|f| f.1.columns()).flat_map(|c| c.values.to_f64());
    assert!(numbers.into_iter().all(f64::is_finite), "{on}: frames hold numbers");
    done
}

/// Goes on from the file of the stopped run; gives how it ends.
fn resumed(folder: &Path, set: &[&str]) -> Done {
    tool(folder, "dem-run", &[&["s.toml", "--resume", "run.mcap", "-o", "rest.mcap"], set].concat())
}

/// The resumed run, with the guard raised, and one that never had it: the frames they share.
fn exact(folder: &Path, on: &str, raised: &[&str]) {
    succeed(folder, "dem-run", &[&["s.toml", "-o", "whole.mcap"], raised].concat());
    let done = resumed(folder, raised);
    assert_eq!(done.code, 0, "{}", done.stderr);
    let (whole, rest) = (read(&folder.join("whole.mcap")).frames, read(&folder.join("rest.mcap")).frames);
    assert!(!rest.is_empty() && rest.len() < whole.len(), "it went on from where it was stopped");
    let differ = rest.iter().zip(&whole[whole.len() - rest.len()..]).filter(|(a, b)| a != b).count();
    EXACT.within(on, differ as f64, "frames", 0.0);
}

/// Two grains that meet at 2 m/s overlap by a tenth of their radius.
const COLLISION: &str = "1,-0.011,0,0,0.01,1,0,0,0,0,0\n2,0.011,0,0,0.01,-1,0,0,0,0,0\n";

#[test]
fn overlap() {
    let folder = scene(COLLISION, "");
    let guard = ["--set", "guards.overlap=0.01"];
    stopped(
        folder.path(),
        "overlap",
        &guard,
        &["particle 1", "particle 2", "overlaps", "young of glass ≥ ", "m/s", "raise guards.overlap"],
    );
    let again = resumed(folder.path(), &guard);
    RESUMES.refused("overlap, the guard as it was", &again.stderr, &["stopped by a guard", "overlaps"]);
    assert_eq!(again.code, 3);
    exact(folder.path(), "overlap", &["--set", "guards.overlap=0.9"]);
}

/// The modulus that a message names bears the impact, and three quarters of it do not.
#[test]
fn the_modulus_that_is_named_bears_the_impact() {
    let folder = scene(COLLISION, "");
    let guard = ["--set", "guards.overlap=0.05", "--set", "time.dt=1e-7"];
    let done = stopped(folder.path(), "overlap, a modulus", &guard, &["young of glass ≥ "]);
    let (_, said) = done.stderr.split_once("young of glass ≥ ").expect("it is named");
    let young: f64 = said.split_whitespace().next().and_then(|word| word.parse().ok()).expect("a number");
    for (share, code) in [(1.0, 0), (0.5, 3)] {
        let stiff = format!("material.0.young={:e}", share * young);
        let again = tool(folder.path(), "dem-run", &[&["s.toml", "--set", &stiff], &guard[..]].concat());
        assert_eq!(again.code, code, "{stiff}: {}", again.stderr);
    }
}

/// The cure that a message names works: a step that was sound when the run began stays the step of the run, also where
/// one that begins with the raised guard would need a shorter one.
#[test]
fn overlap_raised_beyond_the_step() {
    for (step, on) in [("safety = 0.95", "overlap, dt = \"auto\""), ("dt = 1e-4", "overlap, dt given")] {
        let folder = scene(COLLISION, "");
        fs::write(
            folder.path().join("s.toml"),
            HEAD.replace("dt = 1e-5", step).replace("every = 0.002", "every = 0.005"),
        )
        .expect("written");
        stopped(
            folder.path(),
            on,
            &["--set", "guards.overlap=0.01"],
            &["particle 1", "raise guards.overlap"],
        );
        let done = resumed(folder.path(), &["--set", "guards.overlap=0.9"]);
        assert_eq!(done.code, 0, "{on}: {}", done.stderr);
        let end = read(&folder.path().join("rest.mcap")).frames.last().map(|f| f.0);
        assert!(end.is_some_and(|time| time > 19_000_000), "{on}: to its end, not {end:?} ns");
    }
}

/// A grain that falls freely until it is too fast for its step.
#[test]
fn motion_in_one_step() {
    let folder = scene("7,0,0,0,0.01,0,0,0,0,0,0\n", "");
    let toml = format!("gravity = [0, 0, -9810]\n{HEAD}");
    fs::write(folder.path().join("s.toml"), toml).expect("written");
    let guard = ["--set", "guards.motion=0.1"];
    stopped(
        folder.path(),
        "motion",
        &guard,
        &["particle 7", "in one step", "shorten time.dt", "raise guards.motion"],
    );
    exact(folder.path(), "motion", &["--set", "guards.motion=10"]);
}

/// Two grains whose centres coincide after exactly one step: their force has no direction. The state is lost within that step, and the
/// checkpoint is of before.
#[test]
fn numbers_that_are_lost() {
    let (on, step) = ("NaN: two grains at one place", 2f64.powi(-17));
    let (way, none) = (11.0 / 1024.0, "0,0,0,0,0");
    let speed = way / step;
    let folder =
        scene(&format!("1,{},0,0,0.01,{speed},{none}\n2,{way},0,0,0.01,{},{none}\n", -way, -speed), "");
    // Averaged, they push each other apart before they are at one place.
    let toml = HEAD.replace("dt = 1e-5", &format!("dt = {step:e}\ncontacts = \"sampled\""));
    fs::write(folder.path().join("s.toml"), toml).expect("written");
    let wide = ["--set", "guards.motion=10"];
    let done = stopped(folder.path(), on, &wide, &["t = ", "particle", "shorten time.dt"]);
    let said = done.stderr.contains("is not finite") && done.stderr.contains("the checkpoint is of t = ");
    assert!(said && !done.stderr.contains("at (NaN"), "{}", done.stderr);
    // It goes on from a time before, and comes to the same end: nothing of what is lost is in the checkpoint.
    let again = resumed(folder.path(), &wide);
    RESUMES.refused(on, &again.stderr, &["stopped by a guard", "is not finite"]);
    assert_eq!(again.code, 3);
    let rest = read(&folder.path().join("rest.mcap"));
    assert!(rest.whole && rest.last == "/checkpoint");
}

/// A speed that no step can follow is stopped in the first one; nothing of it is a number that is none.
#[test]
fn speeds_beyond_all_steps() {
    for speed in ["1e9", "1e12"] {
        let folder = scene(&format!("7,0,0,0,0.01,{speed},0,0,0,0,0\n"), "");
        stopped(
            folder.path(),
            &format!("a speed of {speed} m/s"),
            &[],
            &["particle 7", "in one step", "shorten time.dt"],
        );
    }
}
