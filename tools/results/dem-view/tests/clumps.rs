//! What the tool says of clumps, and of grains that are outside of a picture.

use assert_cmd::Command;
use std::{fs, path::Path};

/// A cloud of grains (x, z, clump) as PLY.
fn ply(grains: &[(f64, f64, usize)]) -> String {
    let mut text = format!("ply\nformat ascii 1.0\nelement vertex {}\n", grains.len());
    for (kind, name) in ["double x", "double y", "double z", "double radius", "uint id", "uint body"]
        .map(|s| s.split_once(' ').unwrap())
    {
        text += &format!("property {kind} {name}\n");
    }
    text += "end_header\n";
    for (id, (x, z, body)) in grains.iter().enumerate() {
        text += &format!("{x} {} {z} 0.06 {id} {body}\n", 0.1 * (id % 7) as f64);
    }
    text
}

fn said(folder: &Path, args: &[&str]) -> String {
    let ran = Command::new(env!("CARGO_BIN_EXE_dem-view")).current_dir(folder).args(args).assert().success();
    String::from_utf8_lossy(&ran.get_output().stderr).into_owned()
}

#[test]
fn clumps_are_counted_as_bodies_in_words_and_reports() {
    let folder = tempfile::tempdir().expect("a folder");
    let grains = [(0.0, 0.0, 0), (0.05, 0.0, 0), (0.0, 0.3, 2), (0.0, 0.35, 2), (0.5, 0.0, 4)];
    fs::write(folder.path().join("clumps.ply"), ply(&grains)).expect("written");
    for file in ["a.png", "a.html", "a.vtp", "a.gif"] {
        let said = said(folder.path(), &["clumps.ply", "-o", file, "--report", "report.json"]);
        assert!(said.contains("2 clumps of 4 spheres, 1 sphere"), "{file}: {said}");
        let report = fs::read_to_string(folder.path().join("report.json")).expect("there");
        let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
        let counts = ["clumps", "clump_spheres", "single_spheres"].map(|key| report[key].as_u64());
        assert_eq!(counts, [Some(2), Some(4), Some(1)], "{file}");
    }
    let alone: Vec<(f64, f64, usize)> = (0..5).map(|k| (0.1 * k as f64, 0.0, k)).collect();
    fs::write(folder.path().join("grains.ply"), ply(&alone)).expect("written");
    let said = said(folder.path(), &["grains.ply", "-o", "b.png", "--report", "report.json"]);
    let report = fs::read_to_string(folder.path().join("report.json")).expect("there");
    assert!(!said.contains("sphere") && !report.contains("clumps\":"), "{said} {report}");
}

#[test]
fn grains_outside_of_a_picture_are_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut grains: Vec<(f64, f64, usize)> =
        (0..500).map(|k| (0.1 * (k % 20) as f64, 0.1 * (k / 20) as f64, k)).collect();
    fs::write(folder.path().join("near.ply"), ply(&grains)).expect("written");
    grains.extend([(0.0, -300.0, 500), (1.0, -310.0, 501)]);
    fs::write(folder.path().join("far.ply"), ply(&grains)).expect("written");
    for (file, what) in [("a.png", "the picture"), ("a.gif", "a picture of the film")] {
        let said = said(folder.path(), &["far.ply", "-o", file]);
        assert!(said.contains(&format!("2 of 502 grains are outside {what}")), "{said}");
    }
    assert!(!said(folder.path(), &["near.ply", "-o", "b.png"]).contains("outside"));
    assert!(!said(folder.path(), &["far.ply", "-o", "b.png", "--camera", "1,-3,1"]).contains("outside"));
}
