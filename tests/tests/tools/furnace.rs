//! The blast furnace of the first page: its stages against the undivided plant, and the full form, whose numbers the docs name.

use grainpipe_tests::tools::{Done, line, succeed};
use grainpipe_tests::tree::root;
use std::fs;
use std::path::Path;
use tempfile::{TempDir, tempdir};

/// The rules, the scenes and the samples, where a relative path finds them.
#[cfg(unix)]
fn folder() -> TempDir {
    let folder = tempdir().unwrap();
    let root = root();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir_all(at("pipelines/furnace")).unwrap();
    std::os::unix::fs::symlink(root.join("sample-data"), at("sample-data")).unwrap();
    for name in ["Makefile", "furnace.mk", "plant.mk", "install.mk"] {
        fs::copy(root.join("pipelines").join(name), at("pipelines").join(name)).unwrap();
    }
    for entry in fs::read_dir(root.join("pipelines/furnace")).unwrap() {
        let entry = entry.unwrap();
        fs::copy(entry.path(), at("pipelines/furnace").join(entry.file_name())).unwrap();
    }
    folder
}

fn make(folder: &Path, target: &str) -> Done {
    // BIN= takes the tools from the path.
    let done = line(folder, &format!("make --no-print-directory -C pipelines {target} FURNACE_BUILD= BIN="));
    assert_eq!(done.code, 0, "{target}: {}", done.stderr);
    done
}

/// Time at which half of the coke has left the storage hopper [s].
const HALF: &str = "9.4";

/// What has passed a level by then, undivided and in stages: the bed on the gate flows into the cut as if it were not there.
#[test]
#[cfg(unix)]
fn the_flow_through_the_cut_is_that_of_the_undivided_furnace() {
    let folder = folder();
    for file in ["upstream.toml", "downstream.toml"] {
        make(folder.path(), &format!("out/furnace/{file}"));
    }
    let (plant, out) = (folder.path().join("pipelines/furnace"), folder.path().join("pipelines/out/furnace"));
    let until = ["--until", HALF, "--threads", "1"];
    let up = succeed(&out, "dem-run", &[&["upstream.toml", "-o", "up.mcap"], &until[..]].concat());
    assert!(!up.stderr.contains("warning"), "{}", up.stderr);
    let replayed = succeed(&out, "stage-replay", &["up.mcap", "--keep-times", "-o", "inlet.mcap"]);
    assert!(!replayed.stderr.contains("warning"), "{}", replayed.stderr);
    succeed(&out, "dem-run", &[&["downstream.toml", "inlet.mcap", "-o", "down.mcap"], &until[..]].concat());
    succeed(&plant, "dem-run", &[&["plant.toml", "-o", "undivided.mcap"], &until[..]].concat());
    let passed = |folder: &Path, run: &str| {
        let done = succeed(folder, "dem-measure", &[run, "--flow", "0,0,0.3,0,0,-1", "-o", "flow.csv"]);
        let words = done.stderr.split("forward ").nth(1).and_then(|rest| rest.split(',').next());
        words.and_then(|number| number.parse::<f64>().ok()).unwrap_or_else(|| panic!("{}", done.stderr))
    };
    let (staged, undivided) = (passed(&out, "down.mcap"), passed(&plant, "undivided.mcap"));
    assert!(undivided > 150.0, "{undivided}");
    // Three seeds of the undivided plant differ by up to 8 %.
    assert!((staged / undivided - 1.0).abs() < 0.15, "{staged} in stages, {undivided} undivided");
}

#[test]
#[cfg(unix)]
fn the_full_form_is_a_million_grains_as_its_page_says() {
    let folder = folder();
    let told = make(folder.path(), "furnace-explain");
    let told = String::from_utf8_lossy(&told.stdout) + &*told.stderr;
    let page = root().join("docs/how-to/furnace.md");
    let page = fs::read_to_string(page).unwrap();
    let behind = |text: &str, start: &str| -> String {
        let rest = text.split(start).nth(1).unwrap_or_else(|| panic!("{start}: {text}"));
        rest.trim_start().chars().take_while(char::is_ascii_digit).collect()
    };
    let grains: u64 = behind(&told, "insert.1 bring about").parse().unwrap();
    let steps: f64 = behind(&told, "\nsteps").parse().unwrap();
    let grouped = format!("{} {:03} {:03} grains", grains / 1_000_000, grains / 1000 % 1000, grains % 1000);
    assert!(grains >= 1_000_000 && page.contains(&grouped), "{grouped}");
    assert!(page.contains(&format!("{:.0} million steps", steps / 1e6)), "{steps}");
}
