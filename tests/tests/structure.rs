//! The shape of the code: the engine's imports go down its layers, and files stay small enough to read.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Layers of the engine, lowest first: a folder uses those before it.
const LAYERS: [&str; 16] = [
    "threads",
    "float",
    "simd",
    "space",
    "effects",
    "setup",
    "kernel",
    "walls",
    "model",
    "state",
    "neighbours",
    "passes",
    "forces",
    "observe",
    "device",
    "simulation",
];

/// Lines that a file may have, tests apart.
const LONGEST: usize = 350;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// All Rust files under a folder, without what is built.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        if entry.is_dir() && entry.file_name() != Some("target".as_ref()) {
            files(&entry, found);
        } else if entry.extension() == Some("rs".as_ref()) {
            found.push(entry);
        }
    }
}

/// Names of the top-level modules that a line of code names by `crate::`.
fn modules(line: &str) -> impl Iterator<Item = &str> {
    let code = line.split("//").next().unwrap_or_default();
    code.split("crate::")
        .skip(1)
        .map(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default())
}

#[test]
fn imports_of_the_engine_go_down_its_layers() {
    let source = root().join("crates/dem/src");
    let mut all = Vec::new();
    files(&source, &mut all);
    let mut wrong = BTreeSet::new();
    for file in all.iter().filter(|file| !file.ends_with("lib.rs")) {
        let own = file.strip_prefix(&source).expect("below").iter().next().expect("a name");
        let own = own.to_str().expect("text").trim_end_matches(".rs");
        let layer = |name: &str| LAYERS.iter().position(|l| *l == name);
        let height = layer(own).unwrap_or_else(|| panic!("{own} is in no layer"));
        let text = fs::read_to_string(file).expect("text");
        for used in text.lines().flat_map(modules).filter_map(layer).filter(|used| *used > height) {
            wrong.insert(format!("{} uses {}", file.display(), LAYERS[used]));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn no_file_is_too_long_to_read() {
    let mut all = Vec::new();
    files(&root().join("crates"), &mut all);
    files(&root().join("tools"), &mut all);
    let is_test = |file: &&PathBuf| {
        let inside = file.strip_prefix(root()).expect("below the root");
        inside.components().any(|part| part.as_os_str() == "tests") || file.ends_with("tests.rs")
    };
    let lines = |file: &PathBuf| fs::read_to_string(file).expect("text").lines().count();
    let long = all.iter().filter(|file| !is_test(file) && lines(file) > LONGEST);
    let long: Vec<String> = long.map(|file| format!("{}: {}", file.display(), lines(file))).collect();
    assert!(long.is_empty(), "above {LONGEST} lines: {long:#?}");
}

/// The table of `crates/README.md` names each crate of the workspace with the crates that it uses.
#[test]
fn arrows_between_crates_are_those_of_their_manifests() {
    let readme = fs::read_to_string(root().join("crates/README.md")).expect("it is there");
    let table = readme.split("```").nth(1).expect("a table");
    let told: Vec<String> = table
        .lines()
        .skip(1)
        .map(|line| {
            let (text, uses) = line.split_once('→').unwrap_or((line, ""));
            format!(
                "{} → {}",
                text.split(' ').next().unwrap_or_default(),
                sorted(uses.split(',').map(str::trim))
            )
        })
        .collect();
    let mut true_ones = Vec::new();
    let crates: BTreeSet<String> = fs::read_dir(root().join("crates"))
        .expect("a folder")
        .map(|entry| entry.expect("an entry"))
        .filter(|entry| entry.path().join("Cargo.toml").exists())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    for name in &crates {
        let manifest =
            fs::read_to_string(root().join(format!("crates/{name}/Cargo.toml"))).expect("it is there");
        let (_, rest) = manifest.split_once("\n[dependencies]\n").unwrap_or_default();
        let section = rest.split("\n[").next().unwrap_or_default();
        let used = section.lines().map(|line| line.split(['.', ' ']).next().unwrap_or_default());
        true_ones.push(format!("{name} → {}", sorted(used.filter(|used| crates.contains(*used)))));
    }
    let of_crates: Vec<String> = true_ones.iter().filter(|arrow| !told.contains(arrow)).cloned().collect();
    assert!(of_crates.is_empty(), "crates/README.md tells others than these: {of_crates:#?}");
    assert_eq!(told.iter().filter(|line| line.len() > 4).count(), crates.len(), "{told:#?}");
}

fn sorted<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.filter(|name| !name.is_empty()).collect::<BTreeSet<_>>().into_iter().collect::<Vec<_>>().join(", ")
}
