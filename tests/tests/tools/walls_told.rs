//! What wallgen tells of a wall besides its spheres: the pairs whose roughness it changed, and the widest gap.

use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{succeed, tool};
use serde_json::Value;
use std::path::Path;

/// A grid of points [m], every second row closer, and a point left out.
fn cloud() -> String {
    let y = [0.0, 0.01, 0.018, 0.028, 0.036, 0.046, 0.054];
    let place = |k: usize| (0.01 * (k % 8) as f64, y[k / 8]);
    let kept = (0..56).filter(|&k| k != 27).map(place);
    kept.map(|(x, y)| format!("{x} {y} 0\n")).collect()
}

/// The list of changed pairs and the report of a wall with radii of this method.
fn changes(folder: &Path, radius: &str) -> (String, Value) {
    let cloud = ["cloud.xyz", "--roughness", "0.001", "--radius", radius];
    let outputs = ["-o", "w.mcap", "--report", "w.json", "--changes", "c.csv"];
    succeed(folder, "wallgen", &[&cloud[..], &outputs].concat());
    let report = std::fs::read_to_string(folder.join("w.json")).expect("a report");
    let csv = std::fs::read_to_string(folder.join("c.csv")).expect("a list");
    (csv, serde_json::from_str(&report).expect("JSON"))
}

fn numbers(line: &str, separator: char) -> Vec<f64> {
    line.split(separator).map(|n| n.parse().expect("a number")).collect()
}

/// A row names two points, their distance and their middle.
fn assert_names_a_pair(row: &[f64], points: &[Vec<f64>]) {
    let (a, b) = (&points[row[0] as usize], &points[row[1] as usize]);
    let apart = (a[0] - b[0]).hypot(a[1] - b[1]);
    assert!((apart - row[5]).abs() < 1e-12 && (0.5 * (a[0] + b[0]) - row[2]).abs() < 1e-12, "{row:?}");
}

#[test]
fn changes_lists_the_pairs_whose_roughness_is_not_the_one_asked_for() {
    let folder = folder(&[("cloud.xyz", cloud())]);
    let points: Vec<Vec<f64>> = cloud().lines().map(|line| numbers(line, ' ')).collect();
    for radius in ["solve", "uniform"] {
        let (csv, report) = changes(folder.path(), radius);
        let mut lines = csv.lines();
        assert_eq!(lines.next(), Some("point_i,point_j,x,y,z,distance,asked,made"));
        let rows: Vec<Vec<f64>> = lines.map(|line| numbers(line, ',')).collect();
        assert!(!rows.is_empty());
        let count = report["changes"]["pairs_changed"].as_u64();
        assert_eq!(Some(rows.len() as u64), count, "{radius}: {report}");
        let largest = rows.iter().map(|r| (r[7] - r[6]).abs()).fold(0.0, f64::max);
        let told = report["changes"]["largest_change"].as_f64().expect("a number");
        assert!((largest - told).abs() < 1e-12, "{radius}: {largest} m in the list, {told} m in the report");
        for row in rows {
            assert_names_a_pair(&row, &points);
            assert_eq!(row[6], 0.001);
        }
    }
}

/// Four points of a lattice around one that is missing: the widest sphere touches them in its middle.
#[test]
fn gaps_tells_the_largest_sphere_that_passes_without_a_particle() {
    let even: String = (0..81).filter(|&k| k != 40).map(|k| format!("{} {} 0\n", k % 9, k / 9)).collect();
    let folder = folder(&[("cloud.xyz", even)]);
    let words = ["cloud.xyz", "--radius", "0.6", "-o", "w.mcap", "--report", "w.json"];
    let done = tool(folder.path(), "wallgen", &[&words[..], &["--gaps"]].concat());
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(
        done.stderr.contains("largest sphere that passes")
            && done.stderr.contains("(4.0000, 4.0000, 0.0000)"),
        "{}",
        done.stderr
    );
    let report = std::fs::read_to_string(folder.path().join("w.json")).expect("a report");
    let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    let widest = report["widest_gap"]["diameter"].as_f64().expect("a gap");
    assert!((widest - 2.0 * (1.0 - 0.6)).abs() < 1e-9, "{widest}");
    let plain = tool(folder.path(), "wallgen", &words);
    assert!(plain.code == 0 && !plain.stderr.contains("passes"), "not asked for: {}", plain.stderr);
}

/// PLY is geometry alone: what it would lose is refused.
#[test]
fn properties_that_ply_has_no_place_for_are_refused() {
    let folder = folder(&[("cloud.xyz", cloud())]);
    for option in ["--material", "--friction", "--restitution", "--young", "--poisson"] {
        let options = ["cloud.xyz", "--radius", "0.006", option, "0.3", "-o", "walls.ply"];
        let done = tool(folder.path(), "wallgen", &options);
        assert!(
            done.code == 2 && done.stderr.contains(&format!("{option}: a PLY file has no place")),
            "{}",
            done.stderr
        );
    }
}

/// The same for a table of regions; their velocity has columns, and stays.
#[test]
fn properties_of_regions_that_ply_has_no_place_for_are_refused() {
    let table = |key: &str| format!("[[region]]\nname = \"worn\"\nshape = \"box:0,0,-1,0.02,1,1\"\n{key}\n");
    let folder = folder(&[
        ("cloud.xyz", cloud()),
        ("f.toml", table("friction = 0.3")),
        ("v.toml", table("velocity = [0.1, 0, 0]")),
    ]);
    let wall = |file: &str| {
        let options = ["cloud.xyz", "--roughness", file, "--radius", "0.006", "-o", "walls.ply"];
        tool(folder.path(), "wallgen", &options)
    };
    let refused = wall("f.toml");
    let wanted = "f.toml: material 'wall-worn' has properties, and a PLY file has no place";
    assert!(refused.code == 2 && refused.stderr.contains(wanted), "{}", refused.stderr);
    let done = wall("v.toml");
    assert_eq!(done.code, 0, "{}", done.stderr);
    let header = std::fs::read(folder.path().join("walls.ply")).expect("a wall");
    assert!(String::from_utf8_lossy(&header).contains("property double vx"));
}

/// An option that would change no sphere is refused, and the cure is one that works.
#[test]
fn options_that_change_no_sphere_are_refused() {
    let folder = folder(&[("cloud.xyz", cloud())]);
    let wall = |options: &str| {
        let words = format!("cloud.xyz {options} -o w.mcap");
        tool(folder.path(), "wallgen", &words.split(' ').collect::<Vec<_>>())
    };
    for (options, wanted) in [
        ("--radius 0.006 --representative mean", "--representative: the radius is given (--radius 0.006)"),
        ("--radius 0.006 --facing 0,0,1 --place centre", "--facing: the flow side changes nothing"),
        ("--radius 0.006 --flow-at 0,0,1 --place centre", "--flow-at: the flow side changes nothing"),
    ] {
        let done = wall(options);
        assert!(done.code == 2 && done.stderr.contains(wanted), "{options}: {}", done.stderr);
    }
    for options in [
        "--roughness 0.001 --radius uniform --representative mean",
        "--radius 0.006 --flow-at 0,0,1 --place surface",
    ] {
        let done = wall(options);
        assert_eq!(done.code, 0, "{options}: {}", done.stderr);
    }
}

/// z = 0.02 sin 20x on a lattice of 8 mm is one sheet; a second sheet 3 mm under it prints a warning.
#[test]
fn a_smooth_wave_is_no_pair_of_sheets() {
    let wave = |shift: f64| -> String {
        let at = |k: i32| (0.008 * f64::from(k % 60), 0.008 * f64::from(k / 60));
        let line =
            |(x, y): (f64, f64)| format!("{} {y} {}\n", x + shift, 0.02 * (20.0 * x).sin() - 0.75 * shift);
        (0..3600).map(at).map(line).collect()
    };
    let folder = folder(&[("one.xyz", wave(0.0)), ("two.xyz", wave(0.0) + &wave(0.004))]);
    let told = |cloud: &str| {
        let words = [cloud, "--roughness", "0.0005", "--radius", "uniform", "-o", "w.mcap"];
        let done = tool(folder.path(), "wallgen", &words);
        assert_eq!(done.code, 0, "{}", done.stderr);
        done.stderr.contains("two sheets of the surface")
    };
    assert!(!told("one.xyz") && told("two.xyz"));
}

/// A sparse cloud prints a warning; the cures that the warning and the help name work.
#[test]
fn a_cloud_too_sparse_for_its_roughness_is_told_and_the_cures_work() {
    let points = |k: i32| (0.01 * f64::from(k % 60), 0.01 * f64::from(k / 60));
    let is_there = |(x, y): &(f64, f64)| {
        *x < 0.3 || (((100.0 * x).round() as i32) % 4 == 1 && ((100.0 * y).round() as i32) % 4 == 1)
    };
    let cloud: String = (0..1800).map(points).filter(is_there).map(|(x, y)| format!("{x} {y} 0\n")).collect();
    let square = "v 0 0 0\nv 0.59 0 0\nv 0.59 0.29 0\nv 0 0.29 0\nf 1 2 3\nf 1 3 4\n";
    let folder = folder(&[("cloud.xyz", cloud), ("square.obj", square.to_owned())]);
    let wall = |inputs: &str| {
        let words = format!("{inputs} --roughness 0.0005 --radius uniform -o w.mcap");
        let done = tool(folder.path(), "wallgen", &words.split(' ').collect::<Vec<_>>());
        assert_eq!(done.code, 0, "{}", done.stderr);
        done.stderr
    };
    assert!(wall("cloud.xyz").contains("times as deep as asked"));
    let drawn = wall("cloud.xyz --from-mesh square.obj");
    assert!(drawn.contains("of them on the drawing") && !drawn.contains("as deep as asked"), "{drawn}");
    let f = folder.path();
    succeed(f, "cloud-fill", &["cloud.xyz", "--for-spacing", "0.01", "-o", "filled.ply"]);
    succeed(f, "bluenoise-sample", &["filled.ply", "--spacing", "0.01", "-o", "even.ply"]);
    let filled = wall("even.ply");
    assert!(!filled.contains("as deep as asked"), "{filled}");
}
