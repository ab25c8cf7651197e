//! Wear over every step: areas, depth and life, files for other programs, and what is said of walls without parts.

use super::{column, measure};
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{succeed, tool};
use serde_json::Value;
use tempfile::TempDir;

/// A tray of two triangles in millimetres, and a floor below, on which grains slide.
fn slid() -> TempDir {
    let scene = r#"gravity = [5, 0, -9.81]
[time]
until = 0.2
[output]
every = 0.02
wear = true
[[material]]
name = "ore"
density = 2500
young = 1e6
poisson = 0.25
[[material]]
name = "steel"
young = 1e6
poisson = 0.3
[[contact]]
between = ["*", "*"]
restitution = 0.3
sliding_friction = 0.4
[[fill]]
material = "ore"
shape = "box:0.01,0.01,0.006,0.05,0.05,0.02"
diameter = 0.008
count = 15
[[wall]]
name = "tray"
mesh = "tray.ply"
units = "mm"
material = "steel"
[[wall]]
name = "floor"
plane = [0, 0, -0.01, 0, 0, 1]
material = "ore"
"#;
    let tray = "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n\
        element face 2\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n200 0 0\n200 60 0\n0 60 0\n3 0 1 2\n3 0 2 3\n";
    let folder = folder(&[("s.toml", scene), ("tray.ply", tray)]);
    succeed(folder.path(), "dem-run", &["s.toml", "--threads", "1", "-o", "run.mcap"]);
    folder
}

/// A value of the report.
fn reported(folder: &TempDir, arguments: &[&str]) -> (Value, String) {
    let all = [&["run.mcap", "--report", "r.json"], arguments].concat();
    let done = succeed(folder.path(), "dem-measure", &all);
    let text = std::fs::read_to_string(folder.path().join("r.json")).unwrap();
    (serde_json::from_str(&text).unwrap(), done.stderr)
}

#[test]
fn work_per_area_depth_and_life_follow_from_each_other() {
    let folder = slid();
    let all = ["--wear", "all", "--wear-coefficient", "steel=2e-13", "--thickness", "12mm"];
    let worn = measure(&folder, &all);
    let of = |name: &str| column(&worn, name);
    let (work, per_area) = (of("sliding_work"), of("work_per_area"));
    assert!(work.iter().all(|w| *w > 0.0), "{work:?}");
    // In square metres, though the file of the tray is in millimetres.
    let area = 0.5 * 0.2 * 0.06;
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-9;
    for k in 0..2 {
        assert!(near(per_area[k] * area, work[k]), "{} J/m² of {} J", per_area[k], work[k]);
        let (depth, rate, life) = (of("depth")[k], of("rate")[k], of("life")[k]);
        assert!(near(depth, 1e3 * 2e-13 * per_area[k]), "{depth} mm");
        assert!(
            (rate / (depth * 3.6e6 / 0.2) - 1.0).abs() < 1e-3 && near(life, 12.0 / rate * 1000.0),
            "{rate} {life}"
        );
    }
    let (report, _) = reported(&folder, &all);
    let least = of("life").into_iter().fold(f64::INFINITY, f64::min);
    assert!((report["shortest_life"].as_f64().unwrap() / least - 1.0).abs() < 1e-9, "{report}");
    // A material without a coefficient has no depth, and one that is not there is refused.
    let other = measure(&folder, &["--wear", "all", "--wear-coefficient", "ore=1e-13"]);
    assert!(
        column(&other, "depth").iter().all(|d| d.is_nan()) && other.stderr.contains("2 rows without a depth")
    );
    let refused = tool(
        folder.path(),
        "dem-measure",
        &["run.mcap", "--wear", "all", "--wear-coefficient", "iron=1e-13"],
    );
    assert!(refused.code == 1 && refused.stderr.contains("no material 'iron'"), "{}", refused.stderr);
    let refused = tool(folder.path(), "dem-measure", &["run.mcap", "--wear", "all", "--thickness", "12mm"]);
    assert!(refused.code == 2 && refused.stderr.contains("needs --wear-coefficient"), "{}", refused.stderr);
}

#[test]
fn sums_of_intervals_that_begin_before_from_are_left_out() {
    let folder = slid();
    let work = |arguments: &[&str]| {
        column(&measure(&folder, &[&["--wear", "all"], arguments].concat()), "sliding_work")
    };
    let sum = |of: Vec<f64>| of.iter().sum::<f64>();
    let [whole, first, rest] =
        [&[][..], &["--until", "0.1"], &["--from", "0.1"]].map(|arguments| sum(work(arguments)));
    assert!(
        first > 0.0 && rest > 0.0 && ((first + rest) / whole - 1.0).abs() < 1e-9,
        "{first} + {rest} of {whole}"
    );
    let (_, said) = reported(&folder, &["--wear", "all", "--from", "0.1"]);
    assert!(said.contains("sums over every step (/wall_wear) from 0.1000"), "{said}");
    let (_, said) = reported(&folder, &["--wall-force", "all", "--from", "0.1"]);
    assert!(said.contains("before --from 0.1 s"), "{said}");
}

#[test]
fn a_plane_has_no_row_and_a_note_says_what_tells_its_wear() {
    let folder = slid();
    let (report, said) = reported(&folder, &["--wear", "all", "--wall", "floor", "-o", "w.csv"]);
    assert!(report["rows"] == 0 && !said.contains("sliding_work"), "{said}");
    assert!(said.contains("floor is a plane") && said.contains("--wall-force all --wall floor"), "{said}");
    let refused = tool(folder.path(), "dem-measure", &["run.mcap", "--wear", "all", "--wall", "7"]);
    assert!(
        refused.stderr.contains("no wall '7' in this run") && refused.stderr.contains("0 tray, 1 floor"),
        "{}",
        refused.stderr
    );
}

/// The numbers behind a head of PLY: rows of x, y, z and the properties, by name.
fn points_of(file: &[u8]) -> Vec<(String, Vec<f64>)> {
    let mark = b"end_header\n";
    let end = file.windows(mark.len()).position(|part| part == mark).unwrap() + mark.len();
    let head = String::from_utf8(file[..end].to_vec()).unwrap();
    let rows: usize = head.lines().find_map(|l| l.strip_prefix("element vertex ")).unwrap().parse().unwrap();
    let properties =
        head.lines().filter_map(|l| l.strip_prefix("property ")).filter(|l| !l.starts_with("list"));
    let properties: Vec<(&str, &str)> = properties.map(|l| l.split_once(' ').unwrap()).collect();
    let mut all: Vec<(String, Vec<f64>)> =
        properties.iter().map(|(_, name)| ((*name).to_owned(), Vec::new())).collect();
    let mut rest = &file[end..];
    for _ in 0..rows {
        for (k, (kind, _)) in properties.iter().enumerate() {
            let (value, size) = match *kind {
                "double" => (f64::from_le_bytes(rest[..8].try_into().unwrap()), 8),
                "uint" => (f64::from(u32::from_le_bytes(rest[..4].try_into().unwrap())), 4),
                other => panic!("{other}"),
            };
            all[k].1.push(value);
            rest = &rest[size..];
        }
    }
    all
}

#[test]
fn a_geometry_has_the_walls_with_all_numbers_of_the_rows() {
    let folder = slid();
    let all = ["--wear", "all", "--wear-coefficient", "1e-13", "--thickness", "0.012"];
    let worn = measure(&folder, &all);
    reported(&folder, &[&all[..], &["-o", "w.ply"]].concat());
    let points = points_of(&std::fs::read(folder.path().join("w.ply")).unwrap());
    let of = |name: &str| &points.iter().find(|(own, _)| own == name).unwrap_or_else(|| panic!("{name}")).1;
    // Corners of their own, in the metres of the scene.
    assert_eq!((of("x").len(), of("part")), (6, &vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0]));
    assert!((of("x").iter().copied().fold(0.0, f64::max) - 0.2).abs() < 1e-12);
    for name in [
        "mean_normal",
        "largest_normal",
        "sliding_work",
        "work_per_area",
        "pressure",
        "impacts",
        "depth",
        "rate",
        "life",
    ] {
        let rows = column(&worn, name);
        let near = |k: usize| {
            (of(name)[3 * k] - rows[k]).abs() <= 1e-9 * rows[k] && of(name)[3 * k] == of(name)[3 * k + 2]
        };
        assert!((0..2).all(near), "{name}: {:?} {rows:?}", of(name));
    }
    assert!((of("area")[0] - 0.006).abs() < 1e-12);
    reported(&folder, &[&all[..], &["-o", "w.vtp"]].concat());
    let text = std::fs::read(folder.path().join("w.vtp")).unwrap();
    let text = String::from_utf8_lossy(&text).into_owned();
    assert!(text.contains("NumberOfPolys=\"2\"") && text.contains("Name=\"depth\""));
    let refused = |arguments: &[&str], code: i32, part: &str| {
        let done = tool(folder.path(), "dem-measure", &[&["run.mcap"], arguments].concat());
        assert!(done.code == code && done.stderr.contains(part), "{arguments:?}: {}", done.stderr);
    };
    refused(&["--energy", "-o", "e.ply"], 2, "only --wear is a geometry");
    refused(&["--wear", "all", "--wall", "floor", "-o", "f.vtp"], 1, "no wall has spheres or triangles");
}
