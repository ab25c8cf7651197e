//! The tool from outside: what it writes, and what it says when it cannot.

use assert_cmd::Command;
use std::{collections::BTreeMap, fs, path::Path};
use stream::{
    Table, Values,
    mcap::{Provenance, Writer},
};

fn dem_view(folder: &Path, args: &[&str]) -> assert_cmd::assert::Assert {
    Command::new(env!("CARGO_BIN_EXE_dem-view")).current_dir(folder).args(args).assert()
}

fn spheres(z: f64, vz: f64) -> Table {
    let mut table = Table::default();
    for (name, value) in [("x", [0.0, 0.1]), ("y", [0.0, 0.1]), ("z", [z, z]), ("radius", [0.05, 0.04])] {
        table.push(name, Values::F64(value.to_vec())).expect("fits");
    }
    for (name, value) in [("vx", 0.0), ("vy", 0.0), ("vz", vz)] {
        table.push(name, Values::F64(vec![value, 2.0 * value])).expect("fits");
    }
    table.push("material", Values::U16(vec![0, 1])).expect("fits");
    table
}

/// A run of 5 frames, 0.1 s apart, with walls.
fn run() -> Vec<u8> {
    let mut writer = Writer::new(Vec::new(), &Provenance::default()).expect("begun");
    let materials = BTreeMap::from([("1".to_owned(), "{\"name\":\"coke\"}".to_owned())]);
    writer.metadata("materials", materials).expect("written");
    writer.points("/walls", 0, "world", &spheres(-1.0, 0.0)).expect("written");
    for k in 0..5u32 {
        let frame = spheres(-0.1 * f64::from(k), f64::from(k));
        writer.points("/particles", u64::from(k) * 100_000_000, "world", &frame).expect("written");
    }
    writer.finish().expect("finished")
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("run.mcap"), run()).expect("written");
    folder
}

fn said(assert: &assert_cmd::assert::Assert) -> String {
    String::from_utf8_lossy(&assert.get_output().stderr).into_owned()
}

#[test]
fn a_run_becomes_a_page_from_a_file_and_from_a_pipe() {
    let folder = folder();
    dem_view(folder.path(), &["run.mcap", "-o", "run.html", "--title", "T"]).success();
    let page = fs::read_to_string(folder.path().join("run.html")).expect("there");
    assert!(page.contains("\"coke\"") && page.contains("\"walls\"") && page.contains("<title>T</title>"));
    let piped =
        Command::new(env!("CARGO_BIN_EXE_dem-view")).args(["--title", "T"]).write_stdin(run()).assert();
    let piped = String::from_utf8_lossy(&piped.success().get_output().stdout).into_owned();
    assert_eq!(piped.replace("(stdin)", "(run.mcap)"), page);
}

#[test]
fn a_picture_is_of_the_time_asked_for() {
    let folder = folder();
    let picture = |args: &[&str], name: &str| {
        let all = [&["run.mcap", "-o", name, "--size", "320x200"], args].concat();
        let assert = dem_view(folder.path(), &all).success();
        (fs::read(folder.path().join(name)).expect("there"), said(&assert))
    };
    let (early, note) = picture(&["--time", "0.1"], "a.png");
    assert!(early.starts_with(b"\x89PNG") && note.contains("t = 0.100000 s"), "{note}");
    let (late, note) = picture(&["--camera", "-3,-1,0,0,0,0", "--colour", "vz", "--range", "-1,9"], "b.png");
    assert!(late != early && note.contains("t = 0.400000 s"), "{note}");
    assert_eq!(picture(&["--time", "0.1"], "c.png").0, early);
}

#[test]
fn a_cloud_and_a_run_are_shown_together() {
    let folder = folder();
    fs::write(folder.path().join("scan.xyz"), "0 0 0\n1 0 0\n0 1 0\n").expect("written");
    dem_view(folder.path(), &["run.mcap", "scan.xyz", "-o", "both.html"]).success();
    let page = fs::read_to_string(folder.path().join("both.html")).expect("there");
    assert!(page.contains("\"role\":\"cloud\"") && page.contains("\"role\":\"grains\""));
}

#[test]
fn what_comes_later_is_refused_by_name() {
    let folder = folder();
    for name in ["run.gif", "run.mp4", "run.vtp", "run.pvd", "run.jpeg", "run"] {
        let assert = dem_view(folder.path(), &["run.mcap", "-o", name]).code(2);
        assert!(said(&assert).contains(".html or .png"), "{}", said(&assert));
    }
    let assert = dem_view(folder.path(), &["run.mcap", "--pick", "-o", "x.html"]).code(2);
    assert!(said(&assert).contains("--pick: not available yet"));
}

#[test]
fn bad_input_is_named_and_leaves_no_file() {
    let folder = folder();
    let whole = run();
    fs::write(folder.path().join("cut.mcap"), &whole[..whole.len() / 2]).expect("written");
    fs::write(folder.path().join("empty.ply"), "").expect("written");
    let cases: [(&[&str], i32, &str); 7] = [
        (&["cut.mcap"], 1, "truncated"),
        (&["empty.ply"], 1, "empty.ply"),
        (&["none.mcap"], 1, "none.mcap"),
        (&["run.mcap", "--colour", "warmth"], 1, "'warmth'"),
        (&["run.mcap", "--camera", "above"], 2, "iso"),
        (&["run.mcap", "--range", "2,1"], 2, "the lower first"),
        (&["run.mcap", "--max-mb", "0"], 2, "above 0"),
    ];
    for (args, code, word) in cases {
        for name in ["out.html", "out.png"] {
            let assert = dem_view(folder.path(), &[args, &["-o", name]].concat()).code(code);
            assert!(said(&assert).contains(word), "{args:?}: {}", said(&assert));
            assert!(!folder.path().join(name).exists(), "{args:?}");
        }
    }
}
