//! Large clouds are held in memory once.

use assert_cmd::Command;
use std::{fs, io::Write};

/// Points of the cloud.
const POINTS: usize = 600_000;

/// A wavy sheet as a plain binary PLY of `float`, with a column that pictures do not show.
fn cloud() -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {POINTS}\nproperty float x\nproperty float y\nproperty \
         float z\nproperty float intensity\nend_header\n"
    )
    .into_bytes();
    for i in 0..POINTS {
        let (x, y) = ((i % 1000) as f32 * 1e-3, (i / 1000) as f32 * 1e-3);
        for value in [x, y, 0.05 * (20.0 * x).sin(), i as f32] {
            bytes.write_all(&value.to_le_bytes()).expect("room");
        }
    }
    bytes
}

/// Copies of the coordinates, and what is noted of each point, would add up: they took 181 and 53 MB.
#[test]
fn a_picture_and_a_page_of_a_cloud_take_little_more_than_its_points() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("cloud.ply"), cloud()).expect("written");
    for (out, most) in [("picture.png", 100_000_000), ("page.html", 40_000_000)] {
        let args = ["cloud.ply", "-o", out, "--threads", "1", "--report", "report.json"];
        let size: &[&str] = if out.ends_with("png") { &["--size", "320x180"] } else { &[] };
        let mut tool = Command::new(env!("CARGO_BIN_EXE_dem-view"));
        tool.current_dir(folder.path()).args(args).args(size).assert().success();
        let report = fs::read(folder.path().join("report.json")).expect("there");
        let report: serde_json::Value = serde_json::from_slice(&report).expect("JSON");
        let peak = report["peak_memory_bytes"].as_u64().expect("a number");
        assert!(peak < most, "{out}: {peak} bytes of memory at peak, {most} are enough");
    }
}
