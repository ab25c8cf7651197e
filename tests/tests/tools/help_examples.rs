//! The Examples section of every `--help`: every line of it runs as it stands, of hulls with coarser cells.

use crate::every_option::files::{inputs, lammps};
use grainpipe_tests::tools::{line, program, succeed};
use grainpipe_tests::tree::tools;
use std::fs;
use std::path::Path;
use std::process::Command;

/// The lines under Examples.
fn examples(tool: &str) -> Vec<String> {
    // 100 columns, as where there is no terminal: no example may be broken there.
    let done = Command::new(program(tool)).arg("--help").env_remove("COLUMNS").output().expect("it starts");
    let help = String::from_utf8(done.stdout).expect("text");
    let lines = help.split("Examples:\n").nth(1).unwrap_or_default().lines();
    lines.take_while(|line| line.starts_with("  ")).map(|line| line.trim().to_owned()).collect()
}

/// The files that the examples name and do not write themselves.
fn given(folder: &Path) {
    let rename = |from: &str, to: &str| fs::copy(folder.join(from), folder.join(to)).unwrap();
    rename("s.toml", "scene.toml");
    rename("tetra.ply", "hopper.ply");
    rename("library/rock_1_1.ply", "stone.ply");
    rename("tetra.ply", "stone.stl");
    fs::rename(folder.join("library"), folder.join("stones")).unwrap();
    let scene = fs::read_to_string(folder.join("s.toml")).unwrap();
    let (rest, _) = scene.split_once("plane = ").unwrap();
    fs::write(folder.join("lined.toml"), format!("{rest}material = \"sinter\"\n")).unwrap();
    succeed(folder, "cloud-crop", &["scan.xyz", "-o", "scan.ply"]);
    succeed(folder, "dem-run", &["heap.toml", "-o", "heap.mcap"]);
    rename("heap.mcap", "soil.mcap");
    succeed(folder, "dem-run", &["bonded.toml", "-o", "bonded.mcap"]);
    succeed(folder, "dem-run", &["worn.toml", "-o", "worn.mcap"]);
    for stage in ["upstream", "downstream"] {
        let file = if stage == "upstream" { "up.toml" } else { "down.toml" };
        succeed(
            folder,
            "stage-split",
            &["plant.toml", "--at", "0,0,0.02,0,0,-1", "--keep", stage, "-o", file],
        );
    }
}

#[test]
fn every_example_in_a_help_runs() {
    let folder = inputs();
    given(folder.path());
    let (all, mut wrong, mut first) = (tools(), Vec::new(), ORDER.to_vec());
    first.extend(all.iter().map(String::as_str).filter(|tool| !ORDER.contains(tool)));
    let lammps = lammps();
    for tool in first.into_iter().filter(|tool| lammps || *tool != "dem-lammps") {
        let lines = examples(tool);
        if lines.len() < 2 || !lines.iter().any(|line| line.starts_with(tool)) {
            wrong.push(format!("{tool} --help has too few examples: {lines:?}"));
        }
        for text in lines {
            let done = line(folder.path(), &as_small(&text));
            if done.code != 0 {
                wrong.push(format!("{text}: {}: {}", done.code, done.stderr));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// The example as it stands, but with a coarse hull: the cells that a stone asks for take 20 s a line, and change nothing else.
fn as_small(text: &str) -> String {
    if text.starts_with("stone-hull") { format!("{text} --cells 24") } else { text.to_owned() }
}

/// Tools whose examples write what those of others read.
const ORDER: [&str; 6] = ["cloud-crop", "cloud-fill", "bluenoise-sample", "wallgen", "dem-run", "stone-mask"];
