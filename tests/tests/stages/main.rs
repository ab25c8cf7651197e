//! A plant cut in two: the stages are scenes, crossings keep their intervals, and pipes change no byte.

mod bonds;
mod clumps;
mod ledger;
mod live;
mod marks;
mod motions;
mod order;
mod parts;
mod paths;
mod refused;
mod replays;

use grainpipe_tests::recorded::tables;
use grainpipe_tests::scenes::{ABOVE, AT, SINTER, folder, write};
use grainpipe_tests::tools::{line, succeed, tool};
use grainpipe_tests::tree::root;
use stages::outlet::crossing::{CrossingRow, from_table};
use std::fs;
use std::path::Path;
use stream::Table;
use tempfile::{TempDir, tempdir};

/// Grains fall through the plane z = 0 onto a floor.
fn text() -> String {
    let floor =
        "[[wall]]\nname = \"floor\" # at the bottom\nplane = \"0,0,-0.1,0,0,1\"\nmaterial = \"sinter\"\n";
    SINTER.toml() + ABOVE + floor
}

/// A folder with the plant and both of its stages.
fn plant() -> TempDir {
    plant_of(&text(), &[], &[])
}

/// The same for any plant, with files that it names, and options of the cut; grains move at constant velocity in its zone unless these say otherwise.
fn plant_of(text: &str, files: &[(&str, &str)], options: &[&str]) -> TempDir {
    let folder = folder(files);
    write(folder.path(), "plant.toml", text);
    for (keep, file) in [("upstream", "up.toml"), ("downstream", "down.toml")] {
        let cut = ["plant.toml", "--at", AT, "--keep", keep, "-o", file];
        let constant: &[&str] = if options.contains(&"--motion") { &[] } else { &["--motion", "constant"] };
        succeed(folder.path(), "stage-split", &[&cut, constant, options].concat());
    }
    folder
}

fn passages(path: &Path) -> Vec<CrossingRow> {
    tables(path, "/crossings").iter().flat_map(|table| from_table("test", table, 1).unwrap()).collect()
}

/// The last table of a topic.
fn last_of(path: &Path, of: &str) -> Option<Table> {
    tables(path, of).pop()
}

#[test]
fn both_stages_can_run_and_keep_their_comments() {
    let folder = plant();
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert!(read("down.toml").contains("# at the bottom") && read("up.toml").contains("[[outlet]]"));
    assert!(!read("down.toml").contains("[[fill]]") && read("down.toml").contains("[[inlet]]"));
    succeed(folder.path(), "dem-run", &["up.toml", "--check"]);
    let done = tool(folder.path(), "dem-run", &["down.toml", "--check"]);
    assert!(done.code == 1 && done.stderr.contains("INLET.mcap"), "{}", done.stderr);
    let split = |arguments: &[&str]| {
        tool(folder.path(), "stage-split", &[&["plant.toml", "--keep", "upstream"], arguments].concat())
    };
    let short = split(&["--at", AT, "--length", "0.012"]);
    assert!(
        short.code == 1 && short.stderr.contains("0.012 m is not above the largest diameter"),
        "{}",
        short.stderr
    );
    let through = split(&["--at", "0,0,0.07,0,0,-1"]);
    assert!(through.code == 1 && through.stderr.contains("fill.0 lies on both sides"), "{}", through.stderr);
    assert_eq!(split(&["--at", "0,0,0"]).code, 2);
}

#[test]
fn replay_keeps_intervals_places_and_states_exactly() {
    let folder = plant();
    let path = |name: &str| folder.path().join(name);
    succeed(folder.path(), "dem-run", &["up.toml", "-o", "up.mcap"]);
    succeed(
        folder.path(),
        "stage-replay",
        &["up.mcap", "--intervals", "generation", "--length", "0.02", "-o", "in.mcap"],
    );
    let (recorded, replayed) = (passages(&path("up.mcap")), passages(&path("in.mcap")));
    assert!(recorded.len() > 30 && recorded.len() == replayed.len(), "{}", recorded.len());
    assert_eq!(replayed[0].time, 0.0);
    let first = recorded[0].time;
    for (a, b) in recorded.iter().zip(&replayed) {
        assert_eq!(b.time, a.time - first);
        assert!(a.particle.position.z.abs() < 1e-12, "recorded on the storage plane");
        assert!(
            (b.particle.position.z - 0.02).abs() < 1e-12,
            "generated a length before the calculation plane"
        );
        assert_eq!(
            (a.particle.position.x, a.particle.position.y),
            (b.particle.position.x, b.particle.position.y)
        );
        assert_eq!((a.particle.velocity, a.particle.spin), (b.particle.velocity, b.particle.spin));
        assert_eq!((a.particle.id, a.particle.radius), (b.particle.id, b.particle.radius));
    }
    assert!(recorded.windows(2).all(|w| w[0].time <= w[1].time), "time order");
}

#[test]
fn replay_can_keep_intervals_and_places_at_the_calculation_plane_too() {
    let folder = plant();
    let path = |name: &str| folder.path().join(name);
    succeed(folder.path(), "dem-run", &["up.toml", "-o", "up.mcap"]);
    succeed(folder.path(), "stage-replay", &["up.mcap", "--intervals", "both", "-o", "in.mcap"]);
    let (recorded, replayed) = (passages(&path("up.mcap")), passages(&path("in.mcap")));
    let ahead = -replayed[0].particle.position.z / recorded[0].particle.velocity.z;
    assert!(
        ahead > 0.0 && (replayed[0].particle.position.z - 1.2 * 0.012).abs() < 1e-3,
        "first: a zone before"
    );
    for (a, b) in recorded.iter().zip(&replayed) {
        assert_eq!(b.time, a.time - recorded[0].time);
        let arrives = b.particle.position + b.particle.velocity * ahead;
        assert!((arrives - a.particle.position).norm() < 1e-12, "it arrives where it was recorded");
    }
    succeed(folder.path(), "dem-run", &["down.toml", "in.mcap", "-o", "down.mcap"]);
}

#[test]
fn windows_of_time_and_kept_times() {
    let folder = plant();
    let path = |name: &str| folder.path().join(name);
    succeed(folder.path(), "dem-run", &["up.toml", "-o", "up.mcap"]);
    let all = passages(&path("up.mcap"));
    succeed(folder.path(), "stage-replay", &["up.mcap", "--keep-times", "-o", "kept.mcap"]);
    let kept = passages(&path("kept.mcap"));
    assert_eq!(kept.len(), all.len());
    for a in &kept {
        let b = all.iter().find(|b| b.particle.id == a.particle.id).unwrap();
        let arrives = a.particle.position + a.particle.velocity * (b.time - a.time);
        assert!(
            (arrives - b.particle.position).norm() < 1e-12,
            "{} arrives as it was recorded",
            b.particle.id
        );
        assert!(a.time >= 0.0 && a.time < b.time, "{} s, {} s", a.time, b.time);
    }
    assert!(kept.windows(2).all(|w| w[0].time <= w[1].time), "time order");
    let (from, until) = (all[10].time, all[20].time);
    let window = [format!("--from={from:?}"), format!("--until={until:?}")];
    succeed(folder.path(), "stage-replay", &["up.mcap", &window[0], &window[1], "-o", "w.mcap"]);
    let ids = |list: &[CrossingRow]| list.iter().map(|p| p.particle.id).collect::<Vec<_>>();
    assert_eq!(ids(&passages(&path("w.mcap"))), ids(&all[10..20]));
    assert_eq!(passages(&path("w.mcap"))[0].time, 0.0);
}

#[test]
fn one_pipe_and_one_after_the_other_give_the_same_bytes() {
    let folder = plant();
    let done = line(
        folder.path(),
        "dem-run up.toml -o up.mcap && stage-replay up.mcap -o in.mcap && dem-run down.toml in.mcap -o after.mcap",
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let done = line(folder.path(), "dem-run up.toml | stage-replay | dem-run down.toml - -o piped.mcap");
    assert_eq!(done.code, 0, "{}", done.stderr);
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("after.mcap") == bytes("piped.mcap"));
    let entered = done.stderr.lines().rfind(|l| l.contains("steps")).unwrap_or_default();
    assert!(!entered.contains(" 0 particles"), "{entered}");
}

#[test]
fn a_downstream_run_resumes_in_the_middle_of_its_inlet() {
    let folder = plant();
    let done = line(
        folder.path(),
        "dem-run up.toml -o up.mcap && stage-replay up.mcap -o in.mcap && dem-run down.toml in.mcap -o whole.mcap \
         && dem-run down.toml in.mcap --until 0.05 -o part.mcap \
         && dem-run down.toml in.mcap --resume part.mcap -o rest.mcap",
    );
    assert_eq!(done.code, 0, "{}", done.stderr);
    let last = |name: &str| last_of(&folder.path().join(name), "/particles");
    assert!(last("whole.mcap").is_some() && last("whole.mcap") == last("rest.mcap"));
}

#[test]
fn an_inlet_that_breaks_off_is_an_error_and_leaves_nothing() {
    let folder = plant();
    succeed(folder.path(), "dem-run", &["up.toml", "-o", "up.mcap"]);
    succeed(folder.path(), "stage-replay", &["up.mcap", "-o", "in.mcap"]);
    let bytes = fs::read(folder.path().join("in.mcap")).unwrap();
    for (name, part) in [("cut.mcap", &bytes[..bytes.len() - 900]), ("start.mcap", &bytes[..1500])] {
        fs::write(folder.path().join(name), part).unwrap();
        let done = tool(folder.path(), "dem-run", &["down.toml", name, "-o", "x.mcap"]);
        assert!(done.code == 1 && done.stderr.contains(name), "{}", done.stderr);
        assert!(!folder.path().join("x.mcap").exists());
    }
    let done =
        line(folder.path(), "dem-run up.toml | head -c 30000 | stage-replay | dem-run down.toml - -o x.mcap");
    assert!(done.code != 0 && !folder.path().join("x.mcap").exists(), "a dead upstream: {}", done.stderr);
    let run = tool(folder.path(), "dem-run", &["down.toml", "up.mcap", "-o", "x.mcap"]);
    assert!(run.stderr.contains("pass it through stage-replay"), "{}", run.stderr);
    let plane = tool(
        folder.path(),
        "dem-run",
        &["down.toml", "in.mcap", "--set", "inlet.0.plane=0,0,-0.05,0,0,-1", "-o", "x.mcap"],
    );
    assert!(plane.stderr.contains("was made for the plane"), "{}", plane.stderr);
    succeed(folder.path(), "dem-run", &["plant.toml", "-o", "plant.mcap", "--until", "0.02"]);
    let none = tool(folder.path(), "stage-replay", &["plant.mcap", "-o", "x.mcap"]);
    assert!(none.code == 1 && none.stderr.contains("without [[outlet]]"), "{}", none.stderr);
}

/// The source document's condition: a zone that is not longer than the largest particle lets two stages touch.
#[test]
fn a_zone_shorter_than_the_largest_particle_is_refused_everywhere() {
    let folder = plant();
    succeed(folder.path(), "dem-run", &["up.toml", "-o", "up.mcap"]);
    let done = tool(folder.path(), "stage-replay", &["up.mcap", "--length", "0.01", "-o", "x.mcap"]);
    assert!(done.code == 1 && done.stderr.contains("largest diameter"), "{}", done.stderr);
    let done = tool(folder.path(), "dem-run", &["up.toml", "--set", "outlet.0.length=0.01", "-o", "x.mcap"]);
    assert!(done.code == 1 && done.stderr.contains("largest diameter"), "{}", done.stderr);
}

/// The scene of the `stages` pipeline, started: both stages find their walls from another folder.
#[test]
fn the_plant_of_the_pipelines_can_be_cut_at_its_mouth() {
    let folder = tempdir().unwrap();
    let scene = root().join("pipelines/scenes/plant.toml");
    let scene = scene.to_str().unwrap();
    for (keep, file) in [("upstream", "up.toml"), ("downstream", "down.toml")] {
        let cut = ["--at", "0,0,0.6,0,0,-1", "--length", "0.006", "--keep", keep, "-o", file];
        succeed(folder.path(), "stage-split", &[&[scene], &cut[..]].concat());
    }
    let up = succeed(folder.path(), "dem-run", &["up.toml", "--check"]);
    assert!(up.stderr.contains("2 walls"), "chute and box are not upstream: {}", up.stderr);
    let line = "dem-run up.toml --until 0.2 --set fill.0.mass=0.02 | stage-replay --intervals both \
                | dem-run down.toml - --until 0.1 -o down.mcap";
    let done = grainpipe_tests::tools::line(folder.path(), line);
    assert_eq!(done.code, 0, "{}", done.stderr);
}
