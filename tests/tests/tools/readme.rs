//! The commands of README.md and of the pages that it leads to first: each runs as it stands, in a copy of the folders that it names, dem-run
//! for a moment only.

use grainpipe_tests::tools::{program, succeed};
use grainpipe_tests::tree::{packages, root, tools};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::tempdir;

fn read(page: &str) -> String {
    fs::read_to_string(root().join(page)).unwrap_or_else(|why| panic!("{page}: {why}"))
}

/// Pages whose commands run.
const PAGES: [&str; 3] = ["README.md", "docs/how-to/scan-to-walls.md", "docs/how-to/furnace.md"];

/// Words that README.md may have, its picture and its tables counted.
const WORDS: usize = 450;

#[test]
fn the_readme_is_one_screen() {
    let words = read("README.md").split_whitespace().count();
    assert!(words <= WORDS, "{words} words");
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
    let (text, makefile) = (PAGES.map(read).concat(), rules("Makefile") + &rules("furnace.mk"));
    let targets = behind(&text, "make -C pipelines ");
    assert!(targets.len() > 4, "{targets:?}");
    for target in targets {
        assert!(makefile.lines().any(|l| l.starts_with(&format!("{target}:"))), "make -C pipelines {target}");
    }
}

/// Files below a folder that hold commands: pages, scripts, rules of make, workflows.
fn with_commands(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let has_commands = [".md", ".sh", ".yml", ".mk"].iter().any(|ending| name.ends_with(ending));
        if path.is_dir() && !["target", "out", "build", ".git", "book"].contains(&name.as_str()) {
            with_commands(&path, found);
        } else if has_commands || name == "Makefile" || path.ends_with(".ci/run") {
            found.push(path);
        }
    }
}

/// A package that was renamed is named by its new name everywhere.
#[test]
fn every_package_that_a_command_of_cargo_names_exists() {
    let in_rooms = ["crates", "tools"]
        .into_iter()
        .flat_map(|r| packages(r).into_iter().map(move |p| format!("{r}/{p}")));
    let others = ["tests", "pipelines/studies", "pipelines/pages"].map(str::to_owned);
    let name = |folder: String| {
        let manifest = read(&format!("{folder}/Cargo.toml"));
        let (_, rest) = manifest.split_once("name = \"").expect("a name");
        rest.split('"').next().unwrap_or_default().to_owned()
    };
    let known: BTreeSet<String> = in_rooms.chain(others).map(name).collect();
    let (mut files, mut seen, mut wrong) = (Vec::new(), 0, Vec::new());
    with_commands(&root(), &mut files);
    for file in files {
        let text = fs::read_to_string(&file).expect("text");
        for line in text.lines().filter(|line| line.to_lowercase().contains("cargo")) {
            for package in behind(line, " -p ") {
                seen += 1;
                if !known.contains(package) {
                    wrong.push(format!("{}: -p {package}", file.display()));
                }
            }
        }
    }
    assert!(seen > 20 && wrong.is_empty(), "{seen}, {wrong:#?}");
}

/// The number of attacks is that of the page that the attack writes.
#[test]
fn the_number_of_attacks_is_that_of_the_page() {
    let page = read("docs/evidence/reliability.md");
    let (before, _) = page.split_once(" cases, seed ").expect("a count");
    let count: String = before.chars().rev().take_while(char::is_ascii_digit).collect();
    let count: String = count.chars().rev().collect();
    let overview = read("docs/evidence/overview.md");
    let (_, line) = overview.split_once("(reliability.md)").expect("a link");
    let said: String = line.lines().next().expect("a line").chars().filter(char::is_ascii_digit).collect();
    assert_eq!(said, count);
}

/// Pages that people read before they call a tool: all but those of evidence, which tell what was run.
fn guides() -> Vec<String> {
    let docs = root().join("docs");
    let folders = ["start", "how-to", "reference"].map(|room| docs.join(room));
    let files = folders.iter().flat_map(|folder| fs::read_dir(folder).expect("a folder"));
    let pages = files
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension() == Some("md".as_ref()));
    let mut pages: Vec<String> =
        pages.map(|page| page.strip_prefix(root()).expect("below").display().to_string()).collect();
    pages.push("README.md".to_owned());
    pages.sort();
    pages
}

/// Options in the text and in the blocks of shell commands.
#[test]
fn every_option_is_in_its_tools_help() {
    let (tools, mut seen, mut wrong) = (tools(), 0, Vec::new());
    let mut helps: BTreeMap<String, String> = BTreeMap::new();
    for page in guides() {
        let text = read(&page);
        // Blocks stand between backticks as well.
        let code: Vec<&str> = text.split('`').skip(1).step_by(2).collect();
        for command in code.iter().flat_map(|c| c.split(['|', '\n', '#'])).flat_map(|c| c.split("&&")) {
            let mut words = command.split_whitespace();
            let Some(name) = words.next().filter(|n| tools.contains(*n)) else { continue };
            let help = helps.entry(name.to_owned()).or_insert_with(|| {
                String::from_utf8_lossy(&succeed(&root(), name, &["--help"]).stdout).into_owned()
            });
            for option in words.filter(|w| w.starts_with("--") && w.len() > 2) {
                let option = option.split('=').next().unwrap_or_default().trim_end_matches([',', ';', '.']);
                seen += 1;
                if !help.split([' ', ',', '=', '\n', '<', '|', '>']).any(|w| w == option) {
                    wrong.push(format!("{page}: {name} has no {option}"));
                }
            }
        }
    }
    assert!(seen > 200, "{seen} options");
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Scenes that a guide asks to save, `# NAME.toml` in their first line.
#[test]
fn every_scene_of_a_guide_can_run() {
    let mut seen = 0;
    for page in guides() {
        let text = read(&page);
        for scene in text.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next()) {
            let Some(name) = scene.lines().next().and_then(|line| line.strip_prefix("# ")) else { continue };
            if !name.ends_with(".toml") || !scene.contains("[[fill]]") && !scene.contains("[[insert]]") {
                continue;
            }
            let folder = tempdir().unwrap();
            let drawings = root().join("examples/drawings").display().to_string();
            fs::write(folder.path().join(name), scene.replace("examples/drawings", &drawings)).unwrap();
            let done = succeed(folder.path(), "dem-run", &[name, "--check"]);
            assert!(!done.stderr.contains("warning"), "{page}: {}", done.stderr);
            seen += 1;
        }
    }
    assert!(seen >= 2, "{seen} scenes");
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
    let pages = PAGES.map(read);
    let known = |block: &&str| !block.contains("make ") && !block.contains("scan.e57");
    let runs: Vec<&str> = pages.iter().flat_map(|page| blocks(page)).filter(known).collect();
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
