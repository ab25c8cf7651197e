//! Clouds that are hardly one: each tool has a clear result, or a clear error.

use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::tools::tool;
use std::fs;
use std::ops::RangeInclusive;
use std::path::Path;
use tempfile::tempdir;

const CLEAR: Case = case(
    "Walls of spheres",
    "degenerate clouds (duplicates, a line, a plane, one point, none, far away, two close sheets): a result",
);
const REFUSED: Case =
    case("Walls of spheres", "points that cannot become a wall: refused with position and reason");

type Point = [f64; 3];

fn surface(z: f64) -> Vec<Point> {
    (0..400).map(|k| [0.01 * f64::from(k % 20), 0.01 * f64::from(k / 20), z]).collect()
}

/// Name and points of each cloud.
fn clouds() -> Vec<(&'static str, Vec<Point>)> {
    let with = |more: &[Point]| [surface(0.0), more.to_vec()].concat();
    let line = |step: Point| (0..50).map(|k| step.map(|s| s * f64::from(k))).collect();
    vec![
        ("plane", surface(0.0)),
        ("none", vec![]),
        ("one", vec![[1.0, 2.0, 3.0]]),
        ("two", vec![[0.0; 3], [0.01, 0.0, 0.0]]),
        ("same", vec![[1.0, 2.0, 3.0]; 50]),
        ("double", with(&surface(0.0)[..40])),
        ("twice", with(&surface(0.0))),
        ("line", line([0.01, 0.0, 0.0])),
        ("tilted", line([0.01, 0.02, 0.005])),
        ("nan", with(&[[f64::NAN, 0.0, 0.0]])),
        ("inf", with(&[[0.0, f64::INFINITY, 0.0]])),
        ("outlier", with(&[[1e9, 0.0, 0.0]])),
        ("far", with(&[[1e300, 0.0, 0.0], [-1.7e308, 0.0, 0.0]])),
        ("sheets", with(&surface(0.002))),
    ]
}

/// Points that came out, or what was said.
fn outcome(folder: &Path, words: &[&str]) -> Result<usize, String> {
    let _ = fs::remove_file(folder.join("out.ply"));
    let done = tool(folder, words[0], &[&words[1..], &["-o", "out.ply"]].concat());
    assert!([0, 1].contains(&done.code), "{words:?}: {}", done.stderr);
    assert!(!done.stderr.contains("panicked"), "{words:?}: {}", done.stderr);
    if done.code != 0 {
        assert!(!folder.join("out.ply").exists(), "{words:?} leaves a file");
        return Err(done.stderr);
    }
    let bytes = fs::read(folder.join("out.ply")).unwrap();
    let header = String::from_utf8_lossy(&bytes[..bytes.len().min(600)]).into_owned();
    let count = header.lines().find_map(|l| l.strip_prefix("element vertex ")).expect("a count");
    Ok(count.trim().parse().expect("a number"))
}

/// A number of points, or words of the refusal.
type Expected = Result<RangeInclusive<usize>, &'static [&'static str]>;

const fn n(count: usize) -> Expected {
    Ok(count..=count)
}

const fn refused(words: &'static [&'static str]) -> Expected {
    Err(words)
}

const EMPTY: Expected = refused(&["none.xyz", "nothing to read"]);
const NOT_FINITE: Expected = refused(&["point 400", "not finite", "cloud-crop"]);
const TOO_FAR: Expected = refused(&["point 400", "farther than", "cloud-crop"]);

/// For each cloud: what cloud-crop, alone and by distances, cloud-fill, bluenoise-sample by spacing and by count, and wallgen make of it.
const TABLE: [(&str, [Expected; 7]); 14] = [
    ("plane", [n(400), n(400), n(400), n(400), Ok(200..=400), n(10), n(400)]),
    ("none", [EMPTY, EMPTY, EMPTY, EMPTY, EMPTY, EMPTY, EMPTY]),
    (
        "one",
        [
            n(1),
            n(1),
            n(1),
            n(1),
            n(1),
            refused(&["count 10", "only 1 points"]),
            refused(&["1 points", "at least 2"]),
        ],
    ),
    ("two", [n(2), n(2), n(2), n(2), n(2), refused(&["count 10", "only 2 points"]), n(2)]),
    (
        "same",
        [
            n(50),
            n(50),
            n(50),
            // The others are left out, which is said.
            n(1),
            n(1),
            refused(&["count 10", "only 1 points"]),
            refused(&["same position", "bluenoise-sample"]),
        ],
    ),
    (
        "double",
        [
            n(440),
            n(440),
            n(440),
            n(440),
            Ok(200..=400),
            n(10),
            refused(&["points 0 and 400", "same position", "bluenoise-sample"]),
        ],
    ),
    (
        "twice",
        [
            n(800),
            n(800),
            n(800),
            n(800),
            Ok(200..=400),
            n(10),
            refused(&["same position", "bluenoise-sample"]),
        ],
    ),
    ("line", [n(50), n(50), n(50), n(50), Ok(30..=50), n(10), n(50)]),
    ("tilted", [n(50), n(50), n(50), n(50), n(50), n(10), n(50)]),
    ("nan", [n(400), n(400), n(400), n(400), NOT_FINITE, NOT_FINITE, NOT_FINITE]),
    ("inf", [n(400), n(400), n(400), n(400), NOT_FINITE, NOT_FINITE, NOT_FINITE]),
    ("outlier", [n(401), n(400), n(400), n(401), Ok(201..=401), n(10), n(401)]),
    ("far", [n(402), TOO_FAR, TOO_FAR, TOO_FAR, TOO_FAR, TOO_FAR, TOO_FAR]),
    ("sheets", [n(800), n(800), n(800), n(800), Ok(200..=400), n(10), n(800)]),
];

#[test]
fn clouds_that_are_hardly_one() {
    let folder = tempdir().unwrap();
    let f = folder.path();
    for ((name, points), (row, expected)) in clouds().into_iter().zip(TABLE) {
        assert_eq!(name, row);
        let text: String = points.iter().map(|[x, y, z]| format!("{x:e} {y:e} {z:e}\n")).collect();
        let file = format!("{name}.xyz");
        fs::write(f.join(&file), text).unwrap();
        let lines: [&[&str]; 7] = [
            &["cloud-crop", &file],
            &["cloud-crop", &file, "--largest", "0.05"],
            &["cloud-crop", &file, "--outliers", "6,10"],
            &["cloud-fill", &file],
            &["bluenoise-sample", &file, "--spacing", "0.01"],
            &["bluenoise-sample", &file, "--count", "10"],
            &["wallgen", &file, "--roughness", "0.001"],
        ];
        for (line, expected) in lines.iter().zip(expected) {
            let on = line.join(" ");
            match (outcome(f, line), expected) {
                (Ok(found), Ok(range)) => {
                    assert!(range.contains(&found), "{on}: {found} points, not {range:?}");
                    CLEAR.within(&on, found as f64, "points", *range.end() as f64);
                }
                (Err(said), Err(words)) => REFUSED.refused(&on, &said, words),
                (found, expected) => panic!("{on}: {found:?} instead of {expected:?}"),
            }
        }
    }
}
