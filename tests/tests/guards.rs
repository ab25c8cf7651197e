//! Guards of a run: each is tripped by a separate scene. The run ends with code 3, its file is whole, gives reason and remedy,
//! and ends in a checkpoint with numbers in it that a run can go on from.

use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::tools::{Done, succeed, tool};
use serde_json::Value;
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
const REFUSED: Case = case("Guards", "invalid limits are refused");

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
        &["particle 7", "in one step", "shorten dt or raise guards.motion"],
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
    let done = stopped(folder.path(), on, &wide, &["t = ", "particle", "shorten dt"]);
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
            &["particle 7", "in one step", "shorten dt"],
        );
    }
}

/// Numbers that no scene can mean are refused before the run, with key, value, unit and range.
#[test]
fn numbers_beyond_all_meaning() {
    let refused = |on: &str, particles: &str, more: &str, set: &[&str], words: &[&str]| {
        let folder = scene(particles, more);
        let done = tool(folder.path(), "dem-run", &[&["s.toml", "-o", "run.mcap"], set].concat());
        assert!(done.code == 1 && !folder.path().join("run.mcap").exists(), "{on}: {}", done.stderr);
        REFUSED.refused(on, &done.stderr, words);
    };
    for spin in ["1e15", "1e18", "1e99"] {
        let words = ["particle 7: spin", "rad/s is outside −1e12 to 1e12"];
        refused(
            &format!("a spin of {spin} rad/s"),
            &format!("7,0,0,0,0.01,0,0,0,0,{spin},0\n"),
            "",
            &[],
            &words,
        );
    }
    for speed in ["1e15", "1e99"] {
        let words = ["particle 7: velocity", "m/s is outside −1e12 to 1e12"];
        refused(
            &format!("a speed of {speed} m/s"),
            &format!("7,0,0,0,0.01,{speed},0,0,0,0,0\n"),
            "",
            &[],
            &words,
        );
    }
    let bond = "[[bond]]\nbetween = [\"glass\", \"glass\"]\ngap = 1e-3\nyoung = 1e308\npoisson = 0.2\n";
    let pair = "1,0,0,0,0.01,0,0,0,0,0,0\n2,0.0205,0,0,0.01,0,0,0,0,0,0\n";
    refused("a bond of 1e308 Pa", pair, bond, &[], &["bond.0.young", "1e-9 to 1e35 Pa"]);
    let domain = "[domain]\nperiodic = [\"x\"]\nlow = [-1, nan, 0]\nhigh = [1, 0, inf]\n";
    refused("NaN of an axis that is not periodic", pair, domain, &[], &["domain.low", "must be finite"]);
    for (set, words) in [
        ("gravity=[0,0,-1e300]", ["gravity", "m/s²"]),
        ("material.0.young=1e300", ["material.0.young", "1e-9 to 1e35 Pa"]),
        ("material.0.density=1e300", ["material.0.density", "kg/m³"]),
        ("time.until=1e300", ["time.until", "4e9 s"]),
        ("time.dt=1e-300", ["time.dt", "1e-18 to 4e9 s"]),
        ("neighbours.skin=1e300", ["neighbours.skin", "1e15 m"]),
    ] {
        refused(set, pair, "", &["--set", set], &words);
    }
}

/// Starts that cannot be are the scene's fault: refused with code 1 and the grains, and no file.
#[test]
fn grains_at_one_place() {
    for distance in ["0", "1e-300", "1e-12"] {
        let folder = scene(&format!("41,0,0,0,0.01,0,0,0,0,0,0\n42,{distance},0,0,0.01,0,0,0,0,0,0\n"), "");
        let done = tool(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
        assert!(
            done.code == 1
                && !folder.path().join("run.mcap").exists()
                && !folder.path().join("run.mcap.part").exists()
        );
        REFUSED.refused(
            &format!("centres {distance} m apart"),
            &done.stderr,
            &["s.toml", "41", "42", "move it"],
        );
    }
}

/// A downstream stage: grains fall in at 1 m/s, hit a plate behind the plane, and fly back up.
fn bounce() -> TempDir {
    bounced("1,0,0,0.04,0.01,0,0,-1,0,0,0\n")
}

/// The same with these grains upstream.
fn bounced(grains: &str) -> TempDir {
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
        "to take such grains out",
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
    removes(folder.path(), "0.15", [1, 1]);
}

#[test]
fn a_grain_that_comes_in_too_fast() {
    let folder = bounce();
    fs::copy(folder.path().join("down.toml"), folder.path().join("s.toml")).expect("copied");
    let words = ["comes in by inlet 0 at 1.0000e0 m/s", "shorten dt, or raise guards.motion"];
    stopped(
        folder.path(),
        "zones: a grain too fast for the step",
        &["in.mcap", "--set", "guards.motion=5e-4"],
        &words,
    );
}

#[test]
fn limits_that_are_none() {
    let folder = scene(COLLISION, "");
    for (set, words) in [
        ("guards.overlap=0", ["guards.overlap", "above 0"]),
        ("guards.overlap=-1", ["guards.overlap", "-1"]),
        ("guards.overlap=nan", ["guards.overlap", "NaN"]),
        ("guards.overlap=2", ["guards.overlap", "2"]),
        ("guards.motion=0", ["guards.motion", "above 0"]),
        ("guards.motion=nan", ["guards.motion", "NaN"]),
        ("guards.motion=-inf", ["guards.motion", "-inf"]),
        ("guards.zones=3", ["wrong kind of value", "expected true, false or \"remove\""]),
        ("guards.overlaps=0.1", ["overlaps", "did you mean 'overlap'"]),
    ] {
        let done = tool(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap", "--set", set]);
        assert_eq!(done.code, 1, "{set}: {}", done.stderr);
        REFUSED.refused(
            set,
            &done.stderr.to_lowercase(),
            &words.map(str::to_lowercase).each_ref().map(String::as_str),
        );
    }
}
