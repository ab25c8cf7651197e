//! The examples and the page for the first day: each scene runs for a short time and can be drawn, and the commands of the page run.

use grainpipe_tests::tools::{line, program, succeed, tool};
use grainpipe_tests::tree::root;
use std::fs;
use tempfile::{TempDir, tempdir};

/// The names of the scenes in the folder of examples.
fn scenes() -> Vec<String> {
    let files = fs::read_dir(root().join("examples")).unwrap().map(|entry| entry.unwrap().path());
    let scenes = files.filter(|path| path.extension().is_some_and(|ending| ending == "toml"));
    let mut names: Vec<String> =
        scenes.map(|path| path.file_stem().unwrap().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn every_example_runs_and_is_drawn_without_a_warning() {
    let folder = tempdir().unwrap();
    let scenes = scenes();
    assert_eq!(scenes, ["beam", "drum", "first-plant", "hopper-and-belt", "screen", "screw"]);
    for name in scenes {
        let scene = root().join("examples").join(format!("{name}.toml")).display().to_string();
        let until = if name == "beam" { "0.01" } else { "0.05" };
        let mut words = vec![&*scene, "--until", until, "-o", "run.mcap"];
        if name == "first-plant" {
            // Its second kind of stones comes later.
            words.extend(["--set", "insert.1.from=0.02"]);
        }
        let done = succeed(folder.path(), "dem-run", &words);
        assert!(!done.stderr.contains("warning"), "{name}: {}", done.stderr);
        let done = succeed(folder.path(), "dem-view", &["run.mcap", "--size", "320x180", "-o", "run.png"]);
        assert!(!done.stderr.contains("warning"), "{name}: {}", done.stderr);
    }
}

/// Triangles that rest, turn and shake, belts, grains that come in. The beam is bonded.
#[test]
fn a_device_writes_the_same_file_of_every_example() {
    let folder = tempdir().unwrap();
    for name in scenes() {
        let scene = root().join("examples").join(format!("{name}.toml")).display().to_string();
        let words = |out| [&scene, "--until", "0.012", "-o", out, "--device", "local"];
        if name == "beam" {
            let done = tool(folder.path(), "dem-run", &words("there.mcap"));
            assert!(done.stderr.contains("--device: it does not compute bonds"), "{}", done.stderr);
            continue;
        }
        succeed(folder.path(), "dem-run", &words("there.mcap"));
        succeed(folder.path(), "dem-run", &words("here.mcap")[..5]);
        let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
        assert!(read("here.mcap") == read("there.mcap"), "{name}");
    }
}

#[test]
fn every_example_is_a_plant_of_the_makefile_and_stands_on_the_page() {
    let makefile = fs::read_to_string(root().join("examples/Makefile")).unwrap();
    let plants = makefile.lines().find_map(|line| line.strip_prefix("PLANTS := ")).unwrap();
    let mut plants: Vec<&str> = plants.split(' ').collect();
    plants.sort_unstable();
    assert_eq!(plants, scenes());
    let page = page();
    for name in scenes() {
        assert!(page.contains(&format!("(../../examples/{name}.toml)")), "{name}");
    }
    for link in page.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next()) {
        assert!(root().join("docs/start").join(link).exists(), "docs/start/first-scene.md links {link}");
    }
}

fn page() -> String {
    fs::read_to_string(root().join("docs/start/first-scene.md")).unwrap()
}

/// A folder in which the commands of the page find what they name, with a dem-run that stops after a moment.
#[cfg(unix)]
fn prepared() -> TempDir {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let folder = tempdir().unwrap();
    for name in ["sample-data", "pipelines", "examples"] {
        symlink(root().join(name), folder.path().join(name)).unwrap();
    }
    let scene = page().split("```toml\n").nth(1).unwrap().split("```").next().unwrap().to_owned();
    fs::write(folder.path().join("first.toml"), scene.replace("count = 800", "count = 60")).unwrap();
    fs::create_dir(folder.path().join("bin")).unwrap();
    let shim = folder.path().join("bin/dem-run");
    // Until the first stones are on the belt; other runs need not go that far.
    let text = format!(
        "#!/bin/sh\ncase \"$1\" in *belt.toml) until=0.35;; *) until=0.02;; esac\nexec '{}' \"$@\" --until $until\n",
        program("dem-run").display()
    );
    fs::write(&shim, text).unwrap();
    fs::set_permissions(&shim, fs::Permissions::from_mode(0o755)).unwrap();
    folder
}

#[test]
#[cfg(unix)]
fn the_commands_of_the_page_run_one_after_the_other() {
    let (page, folder) = (page(), prepared());
    let blocks: Vec<&str> =
        page.split("```sh\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert_eq!(blocks.len(), 6);
    for block in blocks.iter().filter(|block| !block.contains("make ")) {
        let done = line(folder.path(), &format!("set -e; PATH=$PWD/bin:$PATH\n{block}"));
        assert_eq!(done.code, 0, "{block}\n{}", done.stderr);
    }
    for file in ["first.html", "belt.png", "flow.csv", "speed.csv", "chute.mcap"] {
        assert!(folder.path().join(file).exists(), "{file}");
    }
}

/// The part of the belt scene that the page shows stands in the scene.
#[test]
fn the_page_shows_the_scene_as_it_is() {
    let scene = fs::read_to_string(root().join("examples/hopper-and-belt.toml")).unwrap();
    let plain = |text: &str| {
        text.lines()
            .map(|l| l.split('#').next().unwrap().trim_end().to_owned())
            .collect::<Vec<_>>()
            .join("\n")
    };
    let shown = page().split("```toml\n").nth(2).unwrap().split("```").next().unwrap().to_owned();
    for wall in shown.split("\n\n") {
        assert!(plain(&scene).contains(plain(wall).trim()), "{wall}");
    }
}
