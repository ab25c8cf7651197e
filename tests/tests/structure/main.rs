//! The shape of the code: the engine's imports go down its layers, and files stay small enough to read.

mod features;
mod imports;

use grainpipe_tests::tree::{packages, root, sources};
use imports::Package;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Layers of the engine's crates, lowest first: a folder uses those before it.
const LAYERS: [(&str, &[&str]); 3] = [
    ("laws", &["float", "simd", "space", "slowing", "effects", "contact"]),
    ("gpu", &["tables", "compositions", "threads", "moves", "lists", "triangles"]),
    (
        "dem",
        &[
            "threads",
            "space",
            "setup",
            "walls",
            "model",
            "state",
            "neighbours",
            "passes",
            "forces",
            "observe",
            "device",
            "simulation",
        ],
    ),
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
    let mut wrong = BTreeSet::new();
    for (package, layers) in LAYERS {
        let source = root().join(format!("crates/engine/{package}/src"));
        for file in sources(&source).iter().filter(|file| !file.ends_with("lib.rs")) {
            let own = file.strip_prefix(&source).expect("below").iter().next().expect("a name");
            let own = own.to_str().expect("text").trim_end_matches(".rs");
            let layer = |name: &str| layers.iter().position(|l| *l == name);
            let height = layer(own).unwrap_or_else(|| panic!("{package}/{own} is in no layer"));
            let text = fs::read_to_string(file).expect("text");
            for used in text.lines().flat_map(modules).filter_map(layer).filter(|used| *used > height) {
                wrong.insert(format!("{} uses {}", file.display(), layers[used]));
            }
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

/// Files in one ring, at most.
const RING: usize = 3;

/// Imports go one way; the face of a folder and one or two of its files may know each other.
#[test]
fn no_ring_of_files_is_larger_than_a_small_folder() {
    let mut large = Vec::new();
    for of in ["crates", "tools"] {
        for name in packages(of) {
            let package = Package::read(&root().join(of).join(&name).join("src"));
            for ring in package.circles() {
                // The face of a folder, which has its name, belongs to it.
                let is_face = |name: &Vec<String>| {
                    ring.iter().any(|other| other.len() > name.len() && other.starts_with(name))
                };
                let folder = |name: &Vec<String>| match is_face(name) {
                    true => name.clone(),
                    false => name[..name.len().saturating_sub(1)].to_vec(),
                };
                let is_one = ring.iter().all(|name| folder(name) == folder(&ring[0]));
                if ring.len() > RING || !is_one {
                    large.push(format!("{name}:\n{}", package.ties(&ring).join("\n")));
                }
            }
        }
    }
    assert!(large.is_empty(), "{}", large.join("\n"));
}

/// `tools/README.md` names each room of tools with what is in it.
#[test]
fn the_page_of_tools_has_every_room() {
    let page = fs::read_to_string(root().join("tools/README.md")).expect("it is there");
    let mut told = BTreeSet::new();
    for row in page.lines().filter(|line| line.starts_with("| [")) {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let room = cells[1].split([']', '[']).nth(1).expect("a link");
        told.extend(cells[2].split('`').skip(1).step_by(2).map(|tool| format!("{room}/{tool}")));
    }
    assert_eq!(told, packages("tools"));
}

/// A package's line in its manifest says what it is: registries and `cargo metadata` show it.
#[test]
fn every_package_says_what_it_is() {
    let all = ["crates", "tools"].map(|of| packages(of).into_iter().map(move |path| format!("{of}/{path}")));
    for package in all.into_iter().flatten() {
        let manifest = fs::read_to_string(root().join(&package).join("Cargo.toml")).expect("it is there");
        let said = manifest.lines().find_map(|line| line.strip_prefix("description = \""));
        assert!(said.is_some_and(|words| words.len() > 12), "{package}/Cargo.toml has no description");
        for key in ["repository", "keywords", "categories"] {
            assert!(manifest.contains(&format!("\n{key}.workspace = true\n")), "{package}/Cargo.toml: {key}");
        }
    }
}

/// A citation names the version of the workspace.
#[test]
fn the_citation_has_the_version_of_the_workspace() {
    let read = |name: &str| fs::read_to_string(root().join(name)).expect("it is there");
    let (manifest, citation) = (read("Cargo.toml"), read("CITATION.cff"));
    let version = manifest.lines().find_map(|line| line.strip_prefix("version = ")).expect("a version");
    assert!(citation.contains(&format!("\nversion: {}\n", version.trim_matches('"'))), "{version}");
}
