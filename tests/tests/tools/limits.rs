//! Numbers that are typing errors: more steps and frames than can be waited for, times that no file holds, keys of thousands of names.

use grainpipe_tests::scenes::{SINTER, folder, write};
use grainpipe_tests::tools::{Done, succeed, tool};
use std::path::Path;
use tempfile::TempDir;

fn scene() -> TempDir {
    let fill =
        "[[fill]]\nmaterial = \"sinter\"\nshape = \"box:0,0,0,0.1,0.1,0.1\"\ndiameter = 0.01\ncount = 3\n";
    folder(&[("s.toml", [&SINTER.toml(), fill, &SINTER.floor()].concat())])
}

fn check(folder: &Path, options: &[&str]) -> Done {
    tool(folder, "dem-run", &[&["s.toml", "--check"], options].concat())
}

fn refused(folder: &Path, options: &[&str], code: i32, parts: &[&str]) {
    let done = check(folder, options);
    assert_eq!(done.code, code, "{options:?}: {}", done.stderr);
    assert!(done.stderr.len() < 600, "{} characters: {}", done.stderr.len(), done.stderr);
    for part in parts {
        assert!(done.stderr.contains(part), "{options:?}: '{part}' is not in {}", done.stderr);
    }
}

#[test]
fn steps_and_frames_that_cannot_be_meant_are_refused_with_their_number() {
    let folder = scene();
    let f = folder.path();
    refused(f, &["--set", "time.dt=1e-300"], 1, &["time.dt = 1e-300 s", "is outside the range", "1e-18"]);
    refused(f, &["--set", "time.dt=1e-14"], 1, &["3.000e13 steps of 1.0000e-14 s", "guards.steps"]);
    let few = ["--set", "time.dt=1e-6"];
    refused(
        f,
        &[&few[..], &["--set", "output.every=1e-6", "--until", "20"]].concat(),
        1,
        &["output.every", "2.000e7 frames"],
    );
    refused(
        f,
        &[&few[..], &["--set", "output.every=\"step\"", "--until", "20"]].concat(),
        1,
        &["2.000e7 frames"],
    );
    refused(
        f,
        &[&few[..], &["--set", "output.checkpoint=1e-6", "--until", "20"]].concat(),
        1,
        &["2.000e7 checkpoints"],
    );
    // A key of the scene allows them.
    let meant = check(f, &["--set", "time.dt=1e-14", "--set", "guards.steps=1e14"]);
    assert_eq!(meant.code, 0, "{}", meant.stderr);
    let meant =
        [&few[..], &["--set", "output.every=1e-6", "--until", "20", "--set", "guards.frames=3e7"]].concat();
    assert_eq!(check(f, &meant).code, 0);
    // And a lower limit than the usual one holds, too.
    refused(f, &["--set", "guards.steps=10"], 1, &["more than guards.steps = 1e1"]);
    refused(f, &["--set", "guards.steps=1e30"], 1, &["guards.steps = 1", "is outside the range"]);
}

#[test]
fn times_that_no_file_holds_are_refused() {
    let folder = scene();
    let f = folder.path();
    let parts = ["time.until = 1e308 s", "is outside the range", "to 4e9 s"];
    refused(f, &["--until", "1e308"], 1, &parts);
    refused(f, &["--set", "time.until=1e308"], 1, &parts);
    succeed(f, "dem-run", &["s.toml", "--until", "0.01", "-q", "-o", "run.mcap"]);
    for (name, options) in [
        ("dem-measure", &["run.mcap", "--contacts", "--until", "1e308"][..]),
        ("dem-measure", &["run.mcap", "--contacts", "--time", "nan"]),
        ("dem-measure", &["run.mcap", "--flow", "0,0,0.01,0,0,-1", "--span", "1e-300"]),
        ("dem-view", &["run.mcap", "-o", "x.gif", "--every", "1e-300"]),
        ("stage-replay", &["run.mcap", "--ahead", "1e308"]),
        ("stage-replay", &["run.mcap", "--from", "1e308"]),
    ] {
        let done = tool(f, name, options);
        assert_eq!(done.code, 2, "{name} {options:?}: {}", done.stderr);
    }
    let done = tool(f, "dem-measure", &["run.mcap", "--flow", "0,0,0.01,0,0,-1", "--span", "1e-9"]);
    assert!(done.code == 1 && done.stderr.contains("more than 1000000 spans"), "{}", done.stderr);
}

#[test]
fn a_key_of_thousands_of_names_is_refused_in_a_short_line() {
    let folder = scene();
    let f = folder.path();
    let deep = vec!["a"; 20_000].join(".");
    refused(f, &["--set", &format!("{deep}=1")], 2, &["--set a.a.a", "has 20000 names", "at most 12"]);
    refused(
        f,
        &["--set", &format!("time.dt={}1{}", "[".repeat(20_000), "]".repeat(20_000))],
        1,
        &["--set time.dt=[["],
    );
    write(f, "deep.toml", format!("{}{deep} = 1\n", SINTER.toml()));
    assert_eq!(tool(f, "dem-run", &["deep.toml", "--check"]).code, 1);
    let done = tool(
        f,
        "cost-curve",
        &["s.toml", "--vary", "safety=0.1,0.2", "--measure", "overlap", "--set", &format!("{deep}=1")],
    );
    assert!(done.code == 2 && done.stderr.contains("has 20000 names"), "{}: {}", done.code, done.stderr);
}
