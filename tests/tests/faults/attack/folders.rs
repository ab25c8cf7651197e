//! Tools that read folders, tables and recipes: stones, laboratory tests, calibration, curves of cost. Their inputs are those of the examples.

use super::example_files;
use crate::samples::Sample;
use grainpipe_tests::tools::line;
use std::fs;
use std::path::Path;

/// A recipe whose command has no loop that a damaged number could make endless.
const RECIPE: &str = r#"[settings]
trials = 8
[[parameter]]
name = "slope"
bounds = [1, 3]
[[test]]
name = "shear"
command = """awk 'BEGIN { print "u,tau"; print "0,0"; print 3 "," 3 * {slope}; print 6 "," 6 * {slope} }'"""
x = "u"
y = "tau"
deviation = 0.1
"#;

/// A call of each tool that succeeds, to which options are added.
pub const CALLS: &[(&str, &str)] = &[
    ("calibrate", "recipe.toml --data shear.csv -o out.csv"),
    ("calibrate", "--guess --material sand --size 2mm --moisture dry --repose-deg 33"),
    ("cost-curve", "s.toml --vary safety=0.2,0.4 --measure bed-height --set time.until=0.01 --work steps"),
    ("lab-test", "crush stone.toml --strain 2% --speed 0.2 -o out.csv"),
    ("lab-test", "direct-shear soil.toml --stress 1kPa --size 0.06 --print-preparation"),
    ("lab-test", "triaxial soil.toml --print-scene"),
    ("lab-test", "repose soil.toml --print-preparation"),
    ("stone-clean", "library/rock_1_1.ply --cells 16 -o out.ply"),
    ("stone-clump", "library/rock_1_1.ply --spheres 3 -o out.toml"),
    ("stone-hull", "photographs --masks masks --turntable turntable.toml --cells 12 -o out.ply"),
    ("stone-library", "pebble.ply -o out"),
    ("stone-mask", "photographs -o out"),
    (
        "stone-pack",
        "grains.csv library --content 0.2 --stone-density 2600 --soil-density 2600 --tries 9 -o out.ply",
    ),
];

/// Calls that read a damaged file, as `FILE`, or by its name.
pub const MESH: &[&str] = &[
    "stone-clean FILE --cells 16 -o out.ply",
    "stone-clean FILE -o out.ply",
    "stone-clump FILE --spheres 3 -o out.csv",
    "stone-clump FILE --measures",
    "stone-library FILE pebble.ply --variants 2 -o out",
];
/// A stone of a library.
pub const LIBRARY: &[&str] = &[
    "stone-pack grains.csv library --content 0.2 --stone-density 2600 --soil-density 2600 --tries 9 -o out.ply",
];
/// Photographs and masks.
pub const PHOTOGRAPHS: &[&str] = &[
    "stone-mask photographs -o out",
    "stone-hull photographs --masks masks --turntable turntable.toml --cells 12 -o out.ply",
];
/// Tables of cameras and of sizes.
pub const TABLES: &[&str] = &[
    "stone-hull photographs --masks masks --turntable turntable.toml --cells 12 -o out.ply",
    "stone-hull photographs --masks masks --poses poses.txt --cells 12 -o out.ply",
    "stone-pack grains.csv library --content 0.2 --stone-density 2600 --soil-density 2600 --grading grading.csv --tries 9 -o out.ply",
];
/// Recipes of calibration and their data.
pub const RECIPES: &[&str] = &["calibrate recipe.toml --data shear.csv -o out.csv"];
/// Samples of laboratory tests.
pub const LABORATORY: &[&str] = &[
    "lab-test crush stone.toml --strain 2% --speed 0.2 -o out.csv",
    "lab-test direct-shear soil.toml --stress 1kPa --size 0.06 --print-preparation",
    "lab-test triaxial soil.toml --print-scene",
];

/// All files of the examples, in their folders, with masks of the photographs.
///
/// # Panics
/// When they cannot be made.
pub fn files() -> Vec<(String, Vec<u8>)> {
    let folder = example_files::inputs();
    let done = line(folder.path(), "stone-mask photographs -o masks -q");
    assert!(done.code == 0, "{}", done.stderr);
    let mut found = Vec::new();
    gather(folder.path(), "", &mut found);
    found.retain(|f| f.0 != "recipe.toml");
    found.push(("recipe.toml".into(), RECIPE.into()));
    found.sort();
    found
}

fn gather(folder: &Path, within: &str, found: &mut Vec<(String, Vec<u8>)>) {
    for entry in fs::read_dir(folder).expect("a folder").flatten() {
        let name = format!("{within}{}", entry.file_name().to_string_lossy());
        match entry.path() {
            path if path.is_dir() => gather(&path, &format!("{name}/"), found),
            path => found.push((name, fs::read(path).expect("read"))),
        }
    }
}

/// Those of the files that a call of a tool may read.
pub fn of(files: &[(String, Vec<u8>)], tool: &str) -> Vec<(String, Vec<u8>)> {
    let read: &[&str] = match tool {
        "calibrate" => &["recipe.toml", "shear.csv"],
        "cost-curve" => &["s.toml"],
        "lab-test" => &["stone.toml", "stone.csv", "soil.toml"],
        "stone-hull" | "stone-mask" => &["photographs/", "masks/", "turntable.toml", "poses.txt"],
        "stone-pack" => &["grains.csv", "library/", "grading.csv"],
        "stone-clean" | "stone-clump" | "stone-library" => &["library/", "pebble.ply"],
        _ => &[],
    };
    files.iter().filter(|f| read.iter().any(|r| f.0.starts_with(r))).cloned().collect()
}

/// Files to be damaged, under their names.
pub fn samples(files: &[(String, Vec<u8>)], names: &[&'static str]) -> Vec<Sample> {
    let one = |name: &&'static str| {
        let found = files.iter().find(|f| f.0 == *name).unwrap_or_else(|| panic!("{name} is missing"));
        (*name, found.1.clone())
    };
    names.iter().map(one).collect()
}
