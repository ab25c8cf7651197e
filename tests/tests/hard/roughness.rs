//! ζ from nothing to half the spacing, and beyond: wall spheres that are finite and exact, or refused.

use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::tools::{succeed, tool};
use std::fs;
use std::path::Path;
use tempfile::tempdir;

const RADIUS: Case = case("Walls of spheres", "ζ from P·10⁻¹⁵ to P/2: the radius is (P²/4 + ζ²)/2ζ");
const DENT: Case = case("Walls of spheres", "ζ from P·10⁻¹⁵ to P/2: the dents that wallgen reports are ζ");
const REFUSED: Case = case(
    "Walls of spheres",
    "ζ above P/2, zero, negative, or so small that the radius is not a number: refused with the reason",
);

const SPACING: f64 = 0.01;

/// 400 points in squares of 10 mm.
fn grid() -> String {
    let at = |k: usize| SPACING * k as f64;
    (0..400).map(|k| format!("{:.17e} {:.17e} 0\n", at(k % 20), at(k / 20))).collect()
}

/// Radii [m] of a PLY in text.
fn radii(path: &Path) -> Vec<f64> {
    let text = fs::read_to_string(path).expect("text");
    let (header, rows) = text.split_once("end_header\n").expect("a header");
    let names: Vec<_> = header.lines().filter(|l| l.starts_with("property")).collect();
    let column = names.iter().position(|l| l.ends_with(" radius")).expect("a radius");
    rows.lines().map(|r| r.split(' ').nth(column).expect("a column").parse().expect("a number")).collect()
}

#[test]
fn roughness_from_nothing_to_half_the_spacing() {
    let folder = tempdir().unwrap();
    let f = folder.path();
    fs::write(f.join("grid.xyz"), grid()).unwrap();
    for mode in ["uniform", "solve"] {
        for share in [1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 0.1, 0.3, 0.4999999, 0.5] {
            let zeta = share * SPACING;
            let asked = format!("{zeta:e}");
            let arguments = [
                "grid.xyz",
                "--roughness",
                &asked,
                "--radius",
                mode,
                "-o",
                "w.ply",
                "--ascii",
                "--report",
                "r.json",
            ];
            succeed(f, "wallgen", &arguments);
            let expected = 0.5 * (0.25 * SPACING * SPACING / zeta + zeta);
            let all = radii(&f.join("w.ply"));
            assert_eq!(all.len(), 400);
            let off = all.iter().map(|r| (r / expected - 1.0).abs()).fold(0.0, f64::max);
            RADIUS.within(&format!("{mode}, ζ/P = {share:e}"), off, "–", 1e-9);
            let report = fs::read(f.join("r.json")).unwrap();
            let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
            let dent =
                |k: usize| (report["changes"]["dents"][k].as_f64().expect("a number") / zeta - 1.0).abs();
            // Spheres that hardly meet: the depth goes with the root of what they overlap.
            let limit = if share > 0.4 { 1e-6 } else { 1e-9 };
            DENT.within(&format!("{mode}, ζ/P = {share:e}"), dent(0).max(dent(1)).max(dent(2)), "–", limit);
        }
        for (zeta, words) in [
            ("5.0000001e-3", &["roughness 0.005", "half", "0.01 m"][..]),
            ("0.02", &["roughness 0.02 m", "half", "at most 0.005 m"]),
            ("1e-320", &["roughness", "radius"]),
            ("0", &["--roughness 0 m", "positive"]),
            ("-0.001", &["--roughness -0.001 m", "positive"]),
            ("nan", &["--roughness"]),
        ] {
            let zeta = format!("--roughness={zeta}");
            let done = tool(f, "wallgen", &["grid.xyz", &zeta, "--radius", mode, "-o", "no.ply"]);
            assert!(done.code != 0 && !f.join("no.ply").exists(), "{}", done.stderr);
            REFUSED.refused(&format!("{mode}, {zeta}"), &done.stderr, words);
            assert!(done.stderr.len() < 400, "{}", done.stderr);
        }
    }
}
