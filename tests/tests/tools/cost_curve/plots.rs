//! The plot of a curve.

use super::{ONE, curve, dropped, with};
use std::fs;
use tempfile::TempDir;

fn plotted(folder: &TempDir, options: &[&str]) -> String {
    curve(folder, &[options, &["--vary", "safety=0.1,0.5", "--work", "steps", "-o", "x.svg"]].concat());
    fs::read_to_string(folder.path().join("x.svg")).expect("a plot")
}

/// Errors are shares of the truth; where that is 0, they are in the unit of the measure, and so is the axis.
#[test]
fn the_axis_has_the_unit_of_the_errors() {
    let folder = with(&dropped());
    assert!(plotted(&folder, &ONE).contains("error in restitution [%]"));
    let energy =
        ["--set", "output.energy=true", "--measure", "integration of --energy --from 0.15", "--exact", "0"];
    let plot = plotted(&folder, &[&energy[..], &["--phases", "1", "--dir", "e"]].concat());
    assert!(plot.contains("error in integration [J]"), "{plot}");
}
