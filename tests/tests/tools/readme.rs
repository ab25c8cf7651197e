//! The commands of README.md: every one runs as it stands, in a copy of the folders that it names, dem-run for a moment only.

use grainpipe_tests::tools::{program, succeed};
use grainpipe_tests::tree::{root, tools};
use std::fs;
use std::process::Command;
use tempfile::tempdir;

fn readme() -> String {
    fs::read_to_string(root().join("README.md")).expect("README.md is there")
}

/// The blocks of shell commands.
fn blocks(text: &str) -> Vec<&str> {
    text.split("```sh\n").skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

/// The words behind a piece of text, wherever it occurs.
fn behind<'a>(text: &'a str, start: &str) -> Vec<&'a str> {
    let word = |rest: &'a str| rest.split(|c: char| !c.is_ascii_alphanumeric() && c != '-').next();
    text.split(start).skip(1).filter_map(word).filter(|w| !w.is_empty()).collect()
}

#[test]
fn every_make_target_exists() {
    let rules = |name: &str| fs::read_to_string(root().join("pipelines").join(name)).expect("rules of make");
    let (readme, makefile) = (readme(), rules("Makefile") + &rules("furnace.mk"));
    let targets = behind(&readme, "make -C pipelines ");
    assert!(targets.len() > 4, "{targets:?}");
    for target in targets {
        assert!(makefile.lines().any(|l| l.starts_with(&format!("{target}:"))), "make -C pipelines {target}");
    }
}

/// The number of attacks is that of the page that the attack writes.
#[test]
fn the_number_of_attacks_is_that_of_the_page() {
    let page = fs::read_to_string(root().join("docs/evidence/reliability.md"))
        .expect("docs/evidence/reliability.md is there");
    let (before, _) = page.split_once(" cases, seed ").expect("a count");
    let count: String = before.chars().rev().take_while(char::is_ascii_digit).collect();
    let count: String = count.chars().rev().collect();
    let readme = readme();
    let (_, line) = readme.split_once("(docs/evidence/reliability.md)").expect("a link");
    let said: String = line.lines().next().expect("a line").chars().filter(char::is_ascii_digit).collect();
    assert_eq!(said, count);
}

#[test]
fn every_file_that_is_linked_exists() {
    let readme = readme();
    for link in readme.split("](").skip(1).filter_map(|rest| rest.split([')', '#']).next()) {
        assert!(root().join(link).exists(), "README.md links {link}");
    }
}

/// Options in the text.
#[test]
fn every_option_is_in_its_tools_help() {
    let readme = readme();
    // Blocks stand between backticks as well.
    let code: Vec<&str> = readme.split('`').skip(1).step_by(2).collect();
    let (tools, mut seen) = (tools(), 0);
    for command in code.iter().flat_map(|c| c.split(['|', '\n'])).flat_map(|c| c.split("&&")) {
        let mut words = command.split_whitespace();
        let Some(name) = words.next().filter(|n| tools.contains(*n)) else { continue };
        let help = String::from_utf8_lossy(&succeed(&root(), name, &["--help"]).stdout).into_owned();
        for option in words.filter(|w| w.starts_with("--")) {
            seen += 1;
            assert!(help.split([' ', ',', '=', '\n']).any(|w| w == option), "{name} has no {option}");
        }
    }
    assert!(seen > 10, "{seen} options");
}

#[test]
#[cfg(unix)]
fn every_block_runs() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let (folder, sources) = (tempdir().unwrap(), root().canonicalize().unwrap());
    let at = |name: &str| folder.path().join(name);
    symlink(sources.join("sample-data"), at("sample-data")).unwrap();
    for copied in ["pipelines/scenes", "pipelines/furnace"] {
        fs::create_dir_all(at(copied)).unwrap();
        for entry in fs::read_dir(sources.join(copied)).unwrap() {
            let entry = entry.unwrap();
            fs::copy(entry.path(), at(copied).join(entry.file_name())).unwrap();
        }
    }
    // What `make -C pipelines furnace` makes first.
    fs::create_dir_all(at("pipelines/out/furnace")).unwrap();
    let chute = "cloud-crop sample-data/chute/chute.ply --remove halfspace:0,0,0,-0.766,0,0.643 | bluenoise-sample --spacing 0.1 \
                 | wallgen --radius uniform --roughness 0.008 --facing 0.643,0,0.766 --material steel -o pipelines/out/furnace/chute.mcap";
    // The tools, but dem-run stops after a moment.
    fs::create_dir(at("bin")).unwrap();
    let engine = program("dem-run");
    fs::write(at("bin/dem-run"), format!("#!/bin/sh\nexec '{}' \"$@\" --until 0.001\n", engine.display()))
        .unwrap();
    fs::set_permissions(at("bin/dem-run"), fs::Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:{}:/usr/bin:/bin", at("bin").display(), engine.parent().unwrap().display());
    let readme = readme();
    let runs: Vec<&str> = blocks(&readme).into_iter().filter(|b| !b.contains("make ")).collect();
    assert_eq!(runs.len(), 3);
    for block in std::iter::once(chute).chain(runs) {
        let mut shell = Command::new("bash");
        shell.args(["-eo", "pipefail", "-c", block]).current_dir(folder.path()).env("PATH", &path);
        let done = shell.output().expect("bash starts");
        assert!(done.status.success(), "{block}\n{}", String::from_utf8_lossy(&done.stderr));
    }
    let made = ["up.mcap", "inwards.mcap", "outwards.mcap"].map(|name| at("pipelines/furnace").join(name));
    assert!(at("run.html").exists() && made.iter().all(|file| file.exists()));
}
