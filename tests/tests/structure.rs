//! The shape of the code: the engine's imports go down its layers, and files stay small enough to read.

use grainpipe_tests::tree::{packages, root, sources};
use std::collections::{BTreeMap, BTreeSet};
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

/// Names of the top-level modules that a line of code names by `crate::`.
fn modules(line: &str) -> impl Iterator<Item = &str> {
    let code = line.split("//").next().unwrap_or_default();
    code.split("crate::")
        .skip(1)
        .map(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default())
}

#[test]
fn imports_of_the_engine_go_down_its_layers() {
    let source = root().join("crates/engine/dem/src");
    let all = sources(&source);
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
    let all = [sources(&root().join("crates")), sources(&root().join("tools"))].concat();
    let is_test = |file: &&PathBuf| {
        let inside = file.strip_prefix(root()).expect("below the root");
        inside.components().any(|part| part.as_os_str() == "tests") || file.ends_with("tests.rs")
    };
    let lines = |file: &PathBuf| fs::read_to_string(file).expect("text").lines().count();
    let long = all.iter().filter(|file| !is_test(file) && lines(file) > LONGEST);
    let long: Vec<String> = long.map(|file| format!("{}: {}", file.display(), lines(file))).collect();
    assert!(long.is_empty(), "above {LONGEST} lines: {long:#?}");
}

/// A line `name … → used, used` of the first block of a page, as `name → used, used`.
fn told(page: &Path) -> Vec<String> {
    let text = fs::read_to_string(page).unwrap_or_else(|e| panic!("{}: {e}", page.display()));
    let table = text.split("```").nth(1).unwrap_or_else(|| panic!("{}: no table", page.display()));
    let lines = table.lines().skip(1).filter(|line| !line.starts_with(' '));
    lines
        .map(|line| {
            let (text, uses) = line.split_once('→').unwrap_or((line, ""));
            let name = text.split(' ').next().unwrap_or_default();
            format!("{name} → {}", sorted(uses.split(',').map(str::trim)))
        })
        .collect()
}

/// Packages of `crates`, by name: their room, and the names that their manifest uses of them.
fn crates() -> BTreeMap<String, (String, Vec<String>)> {
    let rooms: BTreeMap<String, String> = packages("crates")
        .iter()
        .filter_map(|path| path.split_once('/'))
        .map(|(room, name)| (name.to_owned(), room.to_owned()))
        .collect();
    let uses = |room: &str, name: &str| {
        let manifest = root().join(format!("crates/{room}/{name}/Cargo.toml"));
        let manifest = fs::read_to_string(manifest).expect("it is there");
        let (_, rest) = manifest.split_once("\n[dependencies]\n").unwrap_or_default();
        let section = rest.split("\n[").next().unwrap_or_default();
        let used = section.lines().map(|line| line.split(['.', ' ']).next().unwrap_or_default());
        used.filter(|used| rooms.contains_key(*used)).map(str::to_owned).collect()
    };
    rooms.iter().map(|(name, room)| (name.clone(), (room.clone(), uses(room, name)))).collect()
}

/// The README of each room names its crates with the crates that they use, and `crates/README.md` the rooms.
#[test]
fn arrows_between_crates_are_those_of_their_manifests() {
    let crates = crates();
    let mut rooms: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (room, used) in crates.values() {
        let others = used.iter().map(|name| crates[name].0.as_str()).filter(|other| other != room);
        rooms.entry(room).or_default().extend(others);
    }
    let mut wrong = Vec::new();
    let mut compare = |page: PathBuf, arrows: Vec<String>| {
        let mut told = told(&page);
        told.sort();
        if told != arrows {
            wrong.push(format!("{}: tells {told:#?}, these are {arrows:#?}", page.display()));
        }
    };
    let arrow = |name: &str, used: String| format!("{name} → {used}");
    for room in rooms.keys() {
        let of_room = crates.iter().filter(|(_, (its, _))| its == room);
        let arrows = of_room.map(|(name, (_, used))| arrow(name, sorted(used.iter().map(String::as_str))));
        compare(root().join("crates").join(room).join("README.md"), arrows.collect());
    }
    let arrows = rooms.iter().map(|(room, used)| arrow(room, sorted(used.iter().copied()))).collect();
    compare(root().join("crates/README.md"), arrows);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Rooms stand above what they use, none has more than seven crates or tools, and tools have the rooms of the crates.
#[test]
fn rooms_are_small_and_in_order() {
    let crates = crates();
    let pages = fs::read_to_string(root().join("crates/README.md")).expect("it is there");
    let order: Vec<String> = told(&root().join("crates/README.md"))
        .iter()
        .map(|line| line.split(' ').next().unwrap_or_default().to_owned())
        .collect();
    let height =
        |room: &str| order.iter().position(|name| name == room).unwrap_or_else(|| panic!("{room}: {pages}"));
    for (name, (room, used)) in &crates {
        let above = used.iter().find(|other| height(&crates[*other].0) > height(room));
        assert_eq!(above, None, "{room}/{name} uses a crate whose room stands above");
    }
    for of in ["crates", "tools"] {
        let mut count: BTreeMap<String, usize> = BTreeMap::new();
        for package in packages(of) {
            *count.entry(package.split('/').next().unwrap_or_default().to_owned()).or_default() += 1;
        }
        assert!(count.values().all(|n| *n <= 7), "{of}: {count:?}");
        assert!(count.keys().all(|room| order.contains(room)), "{of}: {count:?}");
    }
}

fn sorted<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.filter(|name| !name.is_empty()).collect::<BTreeSet<_>>().into_iter().collect::<Vec<_>>().join(", ")
}
