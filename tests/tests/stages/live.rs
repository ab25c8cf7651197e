//! Stages at once: a middle stage, an upstream that dies, ids that clash, records that are cut short.

use super::{passages, plant, text};
use grainpipe_tests::scenes::AT;
use grainpipe_tests::tools::{line, succeed, tool};
use std::fs;
use tempfile::tempdir;

/// Up, middle, down: an inlet and an outlet in one scene, one after the other and all three at once.
#[test]
fn three_stages_give_the_same_bytes_at_once() {
    let folder = tempdir().unwrap();
    let text = text().replace("0,0,-0.1,0,0,1", "0,0,-0.2,0,0,1").replace("until = 0.3", "until = 0.25");
    fs::write(folder.path().join("plant.toml"), text).unwrap();
    let split = |from: &str, at: &str, keep: &str, to: &str| {
        succeed(
            folder.path(),
            "stage-split",
            &[from, "--at", at, "--keep", keep, "--length", "0.015", "-o", to],
        );
    };
    split("plant.toml", AT, "upstream", "up.toml");
    split("plant.toml", AT, "downstream", "rest.toml");
    split("rest.toml", "0,0,-0.1,0,0,-1", "upstream", "middle.toml");
    split("rest.toml", "0,0,-0.1,0,0,-1", "downstream", "down.toml");
    let middle = fs::read_to_string(folder.path().join("middle.toml")).unwrap();
    assert!(middle.contains("[[inlet]]") && middle.contains("[[outlet]]"), "{middle}");
    let done = line(
        folder.path(),
        "dem-run up.toml -o up.mcap && stage-replay up.mcap -o in.mcap && dem-run middle.toml in.mcap -o middle.mcap \
         && stage-replay middle.mcap -o in2.mcap && dem-run down.toml in2.mcap -o after.mcap \
         && dem-run up.toml | stage-replay | dem-run middle.toml - | stage-replay | dem-run down.toml - -o piped.mcap",
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("after.mcap") == bytes("piped.mcap"));
    let (first, second) =
        (passages(&folder.path().join("up.mcap")), passages(&folder.path().join("middle.mcap")));
    assert!(second.len() > 20 && second.len() <= first.len(), "{} of {}", second.len(), first.len());
    // The record of the wrong stage.
    let wrong = tool(folder.path(), "dem-run", &["down.toml", "in.mcap", "-o", "x.mcap"]);
    assert!(wrong.code == 1 && wrong.stderr.contains("inlet.0.p"), "{}", wrong.stderr);
}

/// kill -9 of the stage upstream: both others fail, and there is no result that looks whole.
#[test]
fn an_upstream_that_is_killed_is_an_error_downstream() {
    let folder = plant();
    for after in ["0.1", "0.4"] {
        let kill = format!(
            "{{ dem-run up.toml --until 1000 & p=$!; sleep {after}; kill -9 $p; wait $p; }} | stage-replay > in.part; \
             echo replay ${{PIPESTATUS[1]}} >&2; \
             {{ dem-run up.toml --until 1000 & p=$!; sleep {after}; kill -9 $p; wait $p; }} | stage-replay \
             | dem-run down.toml - --until 900 -o x.mcap"
        );
        let done = line(folder.path(), &kill);
        assert_ne!(done.code, 0, "{}", done.stderr);
        assert!(done.stderr.contains("replay 1"), "stage-replay fails: {}", done.stderr);
        assert!(!folder.path().join("x.mcap").exists(), "no short result");
        assert!(done.stderr.contains("dem-run: "), "{}", done.stderr);
    }
}

/// Ids of the record and of the scene downstream: refused, with the two ways out.
#[test]
fn ids_that_clash_are_refused() {
    let folder = plant();
    let own = "\n[[fill]]\nmaterial = \"sinter\"\nshape = \"box:-0.05,-0.05,-0.09,0.05,0.05,-0.05\"\ndiameter = 0.01\ncount = 40\n";
    let down = fs::read_to_string(folder.path().join("down.toml")).unwrap();
    fs::write(folder.path().join("clash.toml"), format!("{down}{own}")).unwrap();
    let done = line(
        folder.path(),
        "dem-run up.toml -o up.mcap && stage-replay up.mcap -o in.mcap && dem-run clash.toml in.mcap -o x.mcap",
    );
    assert_eq!(done.code, 1, "{}", done.stderr);
    assert!(
        done.stderr.contains("is in the run already") && done.stderr.contains("--first-id"),
        "{}",
        done.stderr
    );
    let done = line(
        folder.path(),
        "stage-replay up.mcap --first-id 5000 | dem-run clash.toml - --until 0.1 -o x.mcap",
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
}

/// A cut close above the floor, or below it: refused with the distances and the way out.
#[test]
fn a_plane_whose_zone_reaches_through_a_wall_is_refused() {
    let folder = plant();
    for (at, words) in [
        (
            "0,0,-0.095,0,0,-1",
            ["wall 'floor' lies 0.005 m behind the plane", "zone of 0.0144 m", "0.0094 m upstream"],
        ),
        (
            "0,0,-0.11,0,0,-1",
            ["lies 0.01 m behind wall 'floor'", "where no grain can be", "normal points to"],
        ),
    ] {
        for keep in ["upstream", "downstream"] {
            let done = tool(
                folder.path(),
                "stage-split",
                &["plant.toml", "--at", at, "--keep", keep, "-o", "x.toml"],
            );
            assert_eq!(done.code, 1, "{}", done.stderr);
            for word in words {
                assert!(done.stderr.contains(word), "'{word}' is not in {}", done.stderr);
            }
        }
    }
}

/// What lies in the zone of an inlet when grains come in: the run stops, and says which of the two comes in.
#[test]
fn an_inlet_on_top_of_what_is_there_stops_the_run() {
    let folder = plant();
    let down = fs::read_to_string(folder.path().join("down.toml")).unwrap();
    let heap = "\n[[fill]]\nmaterial = \"sinter\"\nshape = \"cylinder:0,0,-0.02,0,0,0.02,0.04\"\ndiameter = 0.01\ncount = 80\n";
    fs::write(
        folder.path().join("full.toml"),
        format!("first_id = 2000000000\n{}{heap}", down.replace("[0, 0, -9.81]", "[0, 0, -0.001]")),
    )
    .unwrap();
    let done = line(
        folder.path(),
        "dem-run up.toml -o up.mcap && stage-replay up.mcap | dem-run full.toml - -o x.mcap",
    );
    assert_eq!(done.code, 3, "{}", done.stderr);
    for word in ["comes in by inlet 0", "on top of particle 20000000", "stage-replay --ahead", "m, "] {
        assert!(done.stderr.contains(word), "'{word}' is not in {}", done.stderr);
    }
}
