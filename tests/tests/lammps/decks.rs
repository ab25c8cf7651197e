//! Decks: what is written, that it runs by itself, and what is refused by name.

use crate::{lmp, refusal};
use grainpipe_tests::recorded::frames;
use grainpipe_tests::scenes::{GLASS, Head, folder};
use grainpipe_tests::tools::{succeed, tool};
use std::fs;
use std::process::Command;
use tempfile::TempDir;

/// Grains that fall on a floor.
fn text() -> String {
    let head = Head {
        time: "until = 0.02",
        output: "every = 0.002",
        contact: "law = \"hooke\"\nstiffness = 1e3\nrestitution = 0.6\nsliding_friction = 0.4",
        ..GLASS
    };
    let fill = "shape = \"box:0,0,0,0.03,0.03,0.03\"\ndiameter = [0.004, 0.006]\ncount = 40";
    let floor = "name = \"floor\"\nplane = \"0,0,0,0,0,1\"\nmaterial = \"glass\"";
    format!("{}[[fill]]\nmaterial = \"glass\"\n{fill}\n[[wall]]\n{floor}\n", head.toml())
}

/// A folder with the scene.
pub fn scene() -> TempDir {
    folder(&[("s.toml", text())])
}

/// A line of a script that ends in & swallows the next one, also in a comment: names are escaped there.
#[test]
fn names_stay_in_their_comments() {
    let harmful = text().replace("\"glass\"", "'glass &'").replace("\"floor\"", "'5\" \"\"\" $x &'");
    let folder = folder(&[("s.toml", harmful), ("plain & simple.toml", text())]);
    for scene in ["s.toml", "plain & simple.toml"] {
        succeed(folder.path(), "dem-lammps", &[scene, "--write-deck", "deck"]);
        let input = fs::read_to_string(folder.path().join("deck/run.in")).unwrap();
        let comments = input.lines().filter_map(|line| line.split_once("# ")).map(|(_, comment)| comment);
        let harmful = comments.filter(|c| c.contains(['&', '"', '$'])).collect::<Vec<_>>();
        assert!(harmful.is_empty(), "{scene}: {harmful:?}");
        fs::remove_dir_all(folder.path().join("deck")).unwrap();
    }
}

/// A deck that was written runs with LAMMPS alone, and its dump is read back: the same run.
#[test]
fn a_deck_that_runs_elsewhere_gives_the_same_run() {
    if !lmp() {
        return;
    }
    let folder = scene();
    succeed(folder.path(), "dem-lammps", &["s.toml", "--write-deck", "deck"]);
    let deck = folder.path().join("deck");
    let batch = fs::read_to_string(deck.join("batch.sh")).unwrap();
    assert!(batch.contains("srun") && batch.contains("-in run.in"), "{batch}");
    let done =
        Command::new("lmp").args(["-in", "run.in", "-log", "none"]).current_dir(&deck).output().unwrap();
    assert!(done.status.success());
    succeed(folder.path(), "dem-lammps", &["s.toml", "--read-dump", "deck/frames.dump", "-o", "read.mcap"]);
    succeed(folder.path(), "dem-lammps", &["s.toml", "-o", "live.mcap"]);
    let [read, live] = ["read.mcap", "live.mcap"].map(|name| frames(&folder.path().join(name)));
    assert_eq!(read.len(), 11);
    assert!(read.iter().zip(&live).all(|(a, b)| a == b));
    // A dump that ends early is of another scene, or broken off.
    let done = tool(
        folder.path(),
        "dem-lammps",
        &["s.toml", "--until", "0.04", "--read-dump", "deck/frames.dump", "-o", "x.mcap"],
    );
    assert_eq!(done.code, 1);
    assert!(
        done.stderr.contains("the scene ends at 0.04") && done.stderr.contains("x.mcap.part"),
        "{}",
        done.stderr
    );
}

/// Other tools read what LAMMPS has computed.
#[test]
fn measures_and_pages_work() {
    if !lmp() {
        return;
    }
    let folder = scene();
    succeed(folder.path(), "dem-lammps", &["s.toml", "-o", "run.mcap", "--report", "r.json"]);
    succeed(folder.path(), "dem-measure", &["run.mcap", "--profile"]);
    succeed(folder.path(), "dem-view", &["run.mcap", "-o", "run.html"]);
    let report = fs::read_to_string(folder.path().join("r.json")).unwrap();
    assert!(report.contains("\"frames\": 11") && report.contains("\"particles\": 40"), "{report}");
}

/// What LAMMPS cannot do is refused by its name, with the nearest, before anything starts.
#[test]
fn everything_that_lammps_lacks_is_refused_by_name() {
    let folder = scene();
    let cases: &[(&[&str], &str, &str)] = &[
        (
            &["--set", "contact.0.law=\"walton_braun\"", "--set", "contact.0.tangential_ratio=0.5"],
            "walton_braun",
            "hooke",
        ),
        (
            &["--set", "contact.0.rolling_resistance=0.1", "--set", "contact.0.rolling_model=\"constant\""],
            "rolling_model",
            "spring",
        ),
        (&["--set", "contact.0.rolling_resistance=0.1"], "sizes of 'glass'", "single diameters"),
        (&["--set", "output.energy=true"], "output.energy", "leave it out"),
        (&["--set", "time.until_kinetic=1e-9"], "time.until_kinetic", "leave it out"),
        (&["--set", "local_damping.factor=0.7"], "local_damping", "restitution"),
        (&["--set", "precision=\"f32\""], "precision", "leave it out"),
        (
            &[
                "--set",
                "insert=[{ material = \"glass\", shape = \"box:0,0,1,0.1,0.1,1.1\", diameter = 0.006, velocity = [0,0,-1], \
                 rate_count = 10, when_blocked = \"skip\" }]",
            ],
            "insert.when_blocked",
            "keep the shape free",
        ),
        (
            &[
                "--set",
                "wall.0.motion={ swing = { about = [0,0,1], through = [0,0,0], amplitude = 0.1, frequency = 5 } }",
            ],
            "wall 'floor'",
            "translate",
        ),
    ];
    for (options, what, nearest) in cases {
        let said = refusal(folder.path(), options);
        assert!(said.contains("LAMMPS cannot run this scene"), "{said}");
        assert!(said.contains(what) && said.contains(nearest), "{options:?}: {said}");
    }
}

/// What the engine refuses has its place in the scene, as with dem-run.
#[test]
fn errors_of_the_setup_name_their_place() {
    let long = text().replace("[time]", "[time]\ndt = 1");
    let line = 1 + long.lines().position(|line| line == "dt = 1").unwrap();
    let folder = folder(&[("s.toml", text()), ("long.toml", long)]);
    for (words, place) in [
        (&["long.toml"][..], format!("long.toml:{line}:6")),
        (&["s.toml", "--set", "time.dt=1"], "s.toml with --set time.dt=1".to_owned()),
    ] {
        for program in ["dem-lammps", "dem-run"] {
            let said = tool(folder.path(), program, &[words, &["--check"]].concat()).stderr;
            assert!(said.contains(&format!("{program}: {place}: time.dt: 1")), "{said}");
        }
    }
}

/// With `--nearest` what can be replaced is, with a warning for each.
#[test]
fn the_nearest_is_taken_when_it_is_asked_for() {
    let folder = scene();
    let options = ["--set", "contact.0.rolling_resistance=0.1", "--set", "output.energy=true", "--nearest"];
    let done =
        succeed(folder.path(), "dem-lammps", &[&["s.toml", "--write-deck", "deck"], &options[..]].concat());
    let warnings = done.stderr.matches("the nearest is taken").count();
    assert_eq!(warnings, 2, "{}", done.stderr);
    let deck = fs::read_to_string(folder.path().join("deck/run.in")).unwrap();
    assert!(deck.contains("rolling sds"), "{deck}");
}

/// Options that change nothing are refused.
#[test]
fn options_that_change_nothing_are_refused() {
    let folder = scene();
    for (options, option) in [
        (&["--check", "--write-deck", "deck"][..], "--write-deck"),
        (&["--check", "--progress"], "--progress"),
        (&["--check", "-o", "x.mcap"], "-o"),
        (&["--write-deck", "deck", "--mpirun", "mpirun"], "--mpirun"),
        (&["--read-dump", "d.dump", "--lmp", "lmp"], "--lmp"),
        (&["--mpirun", "mpirun", "-o", "x.mcap"], "--mpirun"),
    ] {
        let done = tool(folder.path(), "dem-lammps", &[&["s.toml"], options].concat());
        assert_eq!(done.code, 2, "{options:?}: {}", done.stderr);
        assert!(done.stderr.starts_with(&format!("dem-lammps: {option}")), "{}", done.stderr);
    }
}
