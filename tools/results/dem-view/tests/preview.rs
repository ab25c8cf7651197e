//! A scene before it runs.

use assert_cmd::Command;
use std::fs;
use std::path::Path;

/// Grains in a periodic box over a belt, an insertion, and a lid that moves as given.
fn scene(lid: &str) -> String {
    format!(
        r#"
[time]
until = 0.6
[domain]
periodic = ["x"]
low = [-0.1, -0.1, 0]
high = [0.1, 0.1, 0.4]
[[material]]
name = "stone"
density = 2500
young = 1e7
poisson = 0.25
[[contact]]
between = ["stone", "stone"]
restitution = 0.5
[[fill]]
material = "stone"
shape = "box:-0.08,-0.08,0.05,0.08,0.08,0.15"
diameter = 0.02
count = 20
[[insert]]
material = "stone"
shape = "box:-0.05,-0.05,0.2,0.05,0.05,0.25"
diameter = 0.02
velocity = [0, 0, -1]
rate_count = 10
[[wall]]
name = "belt"
plane = [0, 0, 0, 0, 0, 1]
material = "stone"
surface_velocity = [0.5, 0, 0]
[[wall]]
name = "lid"
plane = [0, 0, 0.4, 0, 0, -1]
material = "stone"
{lid}
"#
    )
}

const DOWN: &str = "motion = { translate = [0, 0, -0.2] }";

fn dem_view(folder: &Path, args: &[&str]) -> assert_cmd::assert::Assert {
    Command::cargo_bin("dem-view").expect("built").current_dir(folder).args(args).assert()
}

/// What the report says of a preview.
fn report(lid: &str, output: &str) -> serde_json::Value {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("s.toml"), scene(lid)).expect("written");
    dem_view(folder.path(), &["s.toml", "-o", output, "--report", "r.json"]).success();
    assert!(fs::metadata(folder.path().join(output)).expect("written").len() > 1000);
    serde_json::from_slice(&fs::read(folder.path().join("r.json")).expect("there")).expect("JSON")
}

fn outlines(report: &serde_json::Value) -> Vec<(String, usize)> {
    let layers = report["layers"].as_array().expect("layers").iter();
    let outline = |layer: &serde_json::Value| {
        Some((layer["outline"].as_str()?.to_owned(), layer["lines"].as_u64()? as usize))
    };
    layers.filter_map(outline).collect()
}

/// Everything that the scene has is in the preview once, and what it has not is not.
#[test]
fn a_preview_has_what_the_scene_has() {
    for output in ["p.png", "p.html"] {
        let of = report(DOWN, output);
        assert_eq!((&of["layers"][0]["spheres"], &of["layers"][0]["walls"]), (&20.into(), &2.into()));
        // A box has twelve edges; the rim of the lid has four, at three times.
        let wanted = [("fill", 12), ("insert", 12), ("periodic box", 12), ("later positions", 12)];
        let wanted: Vec<_> = wanted.map(|(word, count)| (word.to_owned(), count)).into();
        assert_eq!(outlines(&of), wanted, "{output}");
    }
}

/// Later positions are of walls that go somewhere: not of those at rest, nor of those that tremble.
#[test]
fn only_walls_that_go_somewhere_have_later_positions() {
    let later = |lid| outlines(&report(lid, "p.png")).iter().any(|(word, _)| word == "later positions");
    assert!(later(DOWN) && !later(""));
    assert!(!later("motion = { vibrate = { amplitude = [0, 0, 0.001], frequency = 20 } }"));
}

#[test]
fn what_only_a_run_has_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("s.toml"), scene(DOWN)).expect("written");
    fs::write(folder.path().join("c.xyz"), "0 0 0\n1 0 0\n").expect("written");
    for (args, words) in [
        (&["s.toml", "-o", "p.gif"][..], &["a scene is shown as it starts", "dem-run SCENE -o RUN.mcap"][..]),
        (&["s.toml", "--force-chains", "-o", "p.png"], &["--force-chains: a scene has not run"]),
        (&["s.toml", "--time", "1", "-o", "p.png"], &["--time: a scene has not run"]),
        (&["s.toml", "c.xyz", "-o", "p.png"], &["s.toml is a scene", "as dem-run takes them"]),
    ] {
        let done = dem_view(folder.path(), args).failure();
        let said = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
        words.iter().for_each(|word| assert!(said.contains(word), "{args:?}: {word} in {said}"));
        assert!(!folder.path().join("p.png").exists() && !folder.path().join("p.gif").exists());
    }
}
