//! Stones of real shape: clumps with the mass of a mesh, and the chain from settled soil to a run with bonded stones.

use grainpipe_tests::recorded::{frames, tables};
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{succeed, tool};
use grainpipe_tests::tree::root;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use stream::Table;
use tempfile::TempDir;

fn json(folder: &Path, name: &str) -> Value {
    serde_json::from_slice(&fs::read(folder.join(name)).unwrap()).unwrap()
}

/// The files of the pipeline, and a small soil: 6000 grains on a lattice.
fn chain() -> TempDir {
    let at = |k: usize| 0.005 * k as f64 + 0.0025;
    let row = |k: usize| format!("{},{},{},0.0025\n", at(k % 20), at(k / 20 % 20), at(k / 400));
    let soil: String = ["x,y,z,radius\n".to_owned()].into_iter().chain((0..6000).map(row)).collect();
    let folder = folder(&[("soil.csv", soil)]);
    for name in ["rock-fill.toml", "grading.csv", "soil.toml"] {
        fs::copy(root().join("pipelines/rock-fill").join(name), folder.path().join(name)).unwrap();
    }
    folder
}

/// The options of the pipeline.
fn pack<'a>(library: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let options =
        ["soil.csv", library, "--content", "0.25", "--stone-density", "2650", "--soil-density", "2650"];
    [&options[..], &["--grading", "grading.csv", "--seed", "1", "-q"], more].concat()
}

#[test]
fn soil_becomes_a_specimen_of_bonded_stones_and_runs() {
    let folder = chain();
    let (path, library) = (folder.path(), root().join("sample-data/stones"));
    let library = library.to_str().unwrap();
    let mut all = Vec::new();
    for threads in ["1", "2"] {
        let outputs = [
            "--threads",
            threads,
            "--report",
            "r.json",
            "--places",
            "p.csv",
            "--surfaces",
            "s.ply",
            "-o",
            "specimen.ply",
        ];
        succeed(path, "stone-pack", &pack(library, &outputs));
        all.push(["p.csv", "s.ply", "specimen.ply"].map(|name| fs::read(path.join(name)).unwrap()));
    }
    assert!(all[0] == all[1], "other threads, other bytes");
    let report = json(path, "r.json");
    let content = report["content"].as_f64().unwrap();
    assert!((content / 0.25 - 1.0).abs() <= 0.01, "{content}");
    for class in report["classes"].as_array().unwrap() {
        let [found, wanted] = ["share", "share_wanted"].map(|key| class[key].as_f64().unwrap());
        assert!((found / wanted - 1.0).abs() < 0.02, "{class}");
    }
    let density = format!("material.1.density={}", report["grain_density"]);
    succeed(
        path,
        "dem-run",
        &["rock-fill.toml", "--set", &density, "--set", "time.until=0.001", "-q", "-o", "run.mcap"],
    );
    // Bonds are within stones, and hold.
    let run = path.join("run.mcap");
    let column = |table: &Table, name: &str| table.get(name).unwrap().to_f64();
    let grains = frames(&run).pop().unwrap();
    let cluster: BTreeMap<u64, f64> =
        column(&grains, "id").into_iter().map(|id| id as u64).zip(column(&grains, "cluster")).collect();
    let bonds = tables(&run, "/bonds").pop().unwrap();
    for (i, j) in column(&bonds, "id_i").into_iter().zip(column(&bonds, "id_j")) {
        let [i, j] = [i, j].map(|id| cluster.get(&(id as u64)).copied().unwrap_or(0.0));
        assert!(i == j && i > 0.0);
    }
    let bonds = bonds.rows();
    assert!(bonds > 100, "{bonds}");
}

/// The lines that `--scene` writes make a scene in which all grains weigh what soil and stones do.
#[test]
fn the_lines_of_a_scene_have_the_density_of_the_stones_grains() {
    let folder = chain();
    let (path, library) = (folder.path(), root().join("sample-data/stones"));
    let outputs = ["--scene", "lines.toml", "--report", "r.json", "-o", "packed.ply"];
    succeed(path, "stone-pack", &pack(library.to_str().unwrap(), &outputs));
    let lines = fs::read_to_string(path.join("lines.toml")).unwrap();
    let soil = "[time]\nuntil = 0.01\n[[material]]\nname = \"soil\"\ndensity = 2650\nyoung = 1e6\npoisson = 0.25\n\
                [[contact]]\nbetween = [\"*\", \"*\"]\nrestitution = 0.5\n";
    let scene = format!("{soil}{lines}young = 1e6\npoisson = 0.25\n");
    fs::write(path.join("s.toml"), scene).unwrap();
    succeed(path, "dem-run", &["s.toml", "-q", "-o", "run.mcap"]);
    succeed(
        path,
        "dem-measure",
        &["run.mcap", "--extent", "--last", "-q", "--report", "e.json", "-o", "e.csv"],
    );
    let table = fs::read_to_string(path.join("e.csv")).unwrap();
    let cells: Vec<f64> = table.lines().nth(1).unwrap().split(',').map(|c| c.parse().unwrap()).collect();
    let mass = json(path, "r.json")["mass"].as_f64().unwrap();
    assert!((cells[8] / mass - 1.0).abs() < 1e-5, "{} {mass}", cells[8]);
    // Without a name of the grains' file, its lines would name none.
    let nowhere = tool(path, "stone-pack", &pack(library.to_str().unwrap(), &["--scene", "lines.toml"]));
    assert!(nowhere.code == 2 && nowhere.stderr.contains("give -o FILE.ply"), "{}", nowhere.stderr);
}

/// A clump weighs what its mesh does, also with few spheres, and turns about the mesh's centre.
#[test]
fn a_clump_has_the_mass_of_its_mesh() {
    let folder = folder(&[("s.toml", String::new())]);
    let path = folder.path();
    let block = root().join("sample-data/stones/block.ply");
    let block = block.to_str().unwrap();
    succeed(path, "stone-clump", &[block, "--spheres", "4", "--report", "r.json", "-q", "-o", "clump.toml"]);
    let volume = json(path, "r.json")["volume"].as_f64().unwrap();
    let scene = "[time]\nuntil = 0.001\ndt = 1e-5\n[[material]]\nname = \"rock\"\ndensity = 2000\nyoung = 1e6\npoisson = 0.25\n\
                 [[contact]]\nbetween = [\"*\", \"*\"]\nrestitution = 0.5\n[[body]]\nclump = \"stone\"\nposition = [0, 0, 0]\nscale = 2\n";
    let clump = fs::read_to_string(path.join("clump.toml")).unwrap();
    fs::write(path.join("s.toml"), scene.to_owned() + &clump).unwrap();
    succeed(path, "dem-run", &["s.toml", "-q", "-o", "run.mcap"]);
    let mass = tables(&path.join("run.mcap"), "/bodies").pop().unwrap().get("mass").unwrap().get(0);
    assert!((mass / (2000.0 * 8.0 * volume) - 1.0).abs() < 1e-6, "{mass} {volume}");
}

/// No body has such moments; one material for all and one for each; a run names its own.
#[test]
fn wrong_moments_and_materials_are_refused_with_a_cure() {
    let folder = chain();
    let path = folder.path();
    let head =
        "[time]\nuntil = 0.001\n[[material]]\nname = \"rock\"\ndensity = 2000\nyoung = 1e6\npoisson = 0.25\n";
    let refused = |text: &str, part: &str| {
        fs::write(path.join("s.toml"), [head, text].concat()).unwrap();
        let done = tool(path, "dem-run", &["s.toml", "--check"]);
        assert!(done.code != 0 && done.stderr.contains(part), "{text}: {}", done.stderr);
    };
    let clump = |moments: &str| {
        format!(
            "[[clump]]\nname = \"a\"\nmaterial = \"rock\"\nspheres = [[0, 0, 0, 1]]\nmoments = {{ {moments} }}\n"
        )
    };
    refused(
        &clump("volume = 1, centre = [0, 0, 0], inertia = [1, 1, 3, 0, 0, 0]"),
        "no body has these moments",
    );
    refused(
        &clump("volume = -1, centre = [0, 0, 0], inertia = [1, 1, 1, 0, 0, 0]"),
        "clump.0.moments.volume",
    );
    let sum = clump("volume = 1, centre = [0, 0, 0], inertia = [1, 1, 1, 0, 0, 0]") + "mass = \"sum\"\n";
    refused(&sum, "leave one of them out");
    let soil = |keys: &str| format!("[[particles]]\nsource = \"soil.csv\"\n{keys}\n");
    refused(&soil("materials = [\"rock\"]"), "no column 'material'");
    refused(&soil("materials = [\"rock\"]\nmaterial = \"rock\""), "leave one of them out");
}

#[test]
fn wrong_stones_are_refused_with_a_cure() {
    let folder = chain();
    let path = folder.path();
    let mesh = |faces: &str, size: &str| {
        let count = faces.lines().count();
        format!(
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face {count}\n\
             property list uchar int vertex_indices\nend_header\n0 0 0\n{size} 0 0\n0 {size} 0\n0 0 {size}\n{faces}"
        )
    };
    let closed = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
    fs::create_dir(path.join("empty")).unwrap();
    for (name, text, part) in [
        ("open.ply", mesh("3 0 2 1\n3 0 1 3\n3 0 3 2\n", "0.1"), "not closed"),
        ("mm.ply", mesh(closed, "100"), "--units mm"),
        ("turned.ply", mesh("3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 3 2\n", "0.1"), "orient"),
    ] {
        let dir = path.join(name).with_extension("");
        fs::create_dir(&dir).unwrap();
        fs::write(dir.join(name), text).unwrap();
        let done = tool(path, "stone-clump", &[dir.join(name).to_str().unwrap(), "--spheres", "3"]);
        assert!(done.code == 1 && done.stderr.contains(part), "{name}: {}", done.stderr);
        let done = tool(path, "stone-pack", &pack(dir.to_str().unwrap(), &["-o", "x.ply"]));
        assert!(done.code == 1 && done.stderr.contains(part), "{name}: {}", done.stderr);
    }
    let none = tool(path, "stone-pack", &pack("empty", &["-o", "x.ply"]));
    assert!(none.code == 1 && none.stderr.contains("has no mesh"), "{}", none.stderr);
    let dense = ["soil.csv", "empty", "--content", "0.2", "--stone-density", "2650"];
    let none = tool(path, "stone-pack", &[&dense[..], &["-o", "x.ply"]].concat());
    assert!(none.code == 2 && none.stderr.contains("--soil-density"), "{}", none.stderr);
    assert!(!path.join("x.ply").exists());
}
