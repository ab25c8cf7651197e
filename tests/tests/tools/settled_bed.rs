//! A scene that starts from the last frame of a run: contacts with walls keep their histories, however the walls are listed and named.

use grainpipe_tests::scenes::{Head, RUBS, folder};
use grainpipe_tests::tools::{Done, tool};
use scene::input::ParticleFile;
use serde_json::Value;
use std::path::Path;
use tempfile::TempDir;

const GRIT: Head = Head {
    time: "until = 0.8\nuntil_unbalanced = 1e-5",
    output: "every = 0.1\nprecision = \"f64\"",
    material: "grit",
    density: 2500.0,
    young: 5e6,
    contact: RUBS,
};

/// Corners of a bin [m], and its triangles: floor and four sides.
const CORNERS: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [0.03, 0.0, 0.0],
    [0.03, 0.03, 0.0],
    [0.0, 0.03, 0.0],
    [0.0, 0.0, 0.1],
    [0.03, 0.0, 0.1],
    [0.03, 0.03, 0.1],
    [0.0, 0.03, 0.1],
];
const SIDES: [[usize; 3]; 10] = [
    [0, 1, 2],
    [0, 2, 3],
    [0, 1, 5],
    [0, 5, 4],
    [1, 2, 6],
    [1, 6, 5],
    [2, 3, 7],
    [2, 7, 6],
    [3, 0, 4],
    [3, 4, 7],
];

/// An OBJ of some triangles.
fn obj(corners: &[[f64; 3]], triangles: &[[usize; 3]]) -> String {
    let corners = corners.iter().map(|[x, y, z]| format!("v {x} {y} {z}\n"));
    let triangles = triangles.iter().map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1));
    corners.chain(triangles).collect()
}

/// The bin as another program writes it: corners and triangles in other orders, some turned over.
fn listed_otherwise() -> String {
    let corners: Vec<[f64; 3]> = CORNERS.iter().rev().copied().collect();
    let turned = |(n, t): (usize, &[usize; 3])| {
        let [a, b, c] = t.map(|k| 7 - k);
        [[a, b, c], [b, c, a], [c, b, a]][n % 3]
    };
    obj(&corners, &SIDES.iter().rev().enumerate().map(turned).collect::<Vec<_>>())
}

/// The bin with a floor of four triangles.
fn refined() -> String {
    let corners: Vec<[f64; 3]> = CORNERS.iter().copied().chain([[0.015, 0.015, 0.0]]).collect();
    let floor = [[0, 1, 8], [1, 2, 8], [2, 3, 8], [3, 0, 8]];
    obj(&corners, &floor.iter().chain(&SIDES[2..]).copied().collect::<Vec<_>>())
}

fn wall(name: &str, shape: &str) -> String {
    let name = if name.is_empty() { String::new() } else { format!("name = \"{name}\"\n") };
    format!("[[wall]]\n{name}{shape}\nmaterial = \"grit\"\n")
}

fn particles(rest: &str) -> String {
    format!("[[particles]]\n{rest}\n")
}

/// A bed that has come to rest in the bin, on a ball and on grains that are fixed, between planes with and without names.
fn settled() -> TempDir {
    let fill = "[[fill]]\nmaterial = \"grit\"\nshape = \"box:0.002,0.006,0.012,0.028,0.024,0.09\"\ndiameter = [0.005, 0.006]\ncount = 110\n";
    let walls = [
        wall("bin", "mesh = \"bin.obj\""),
        wall("", "solid = \"sphere:0.01,0.015,0.002,0.005\""),
        wall("", "plane = \"0,0.004,0,0,1,0\""),
        wall("front", "plane = \"0,0.026,0,0,-1,0\""),
    ];
    let scene = GRIT.toml()
        + &particles("source = \"stones.csv\"\nmaterial = \"grit\"\nfixed = true")
        + fill
        + &walls.concat();
    let stones = "x,y,z,radius\n0.022,0.01,0.001,0.004\n0.02,0.02,0.002,0.003\n0.025,0.016,0.001,0.0035\n";
    let turned_stones =
        "x,y,z,radius\n0.025,0.016,0.001,0.0035\n0.022,0.01,0.001,0.004\n0.02,0.02,0.002,0.003\n";
    let folder = folder(&[
        ("settle.toml", scene),
        ("stones.csv", stones.to_owned()),
        ("turned_stones.csv", turned_stones.to_owned()),
        ("bin.obj", obj(&CORNERS, &SIDES)),
        ("otherwise.obj", listed_otherwise()),
        ("refined.obj", refined()),
    ]);
    grainpipe_tests::tools::succeed(folder.path(), "dem-run", &["settle.toml", "-q", "-o", "settle.mcap"]);
    folder
}

/// A short run of a scene that starts from the bed: what was said, and the last frame as bits.
fn goes_on(folder: &Path, name: &str, parts: &[String]) -> (Done, Vec<[f64; 3]>) {
    let head = Head { time: "until = 0.01", output: "every = 0.01\nprecision = \"f64\"", ..GRIT }.toml();
    let (scene, run) = (format!("{name}.toml"), format!("{name}.mcap"));
    std::fs::write(folder.join(&scene), head + &parts.concat()).expect("a folder");
    let report = format!("{name}.json");
    let done = tool(folder, "dem-run", &[&scene, "-o", &run, "--report", &report]);
    assert_eq!(done.code, 0, "{name}: {}", done.stderr);
    let file = ParticleFile::read(&folder.join(run), 1.0).expect("a run");
    (done, file.particles.iter().map(|p| p.position.into()).collect())
}

fn farthest(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    assert_eq!(a.len(), b.len());
    let away = |(p, q): (&[f64; 3], &[f64; 3])| (0..3).map(|k| (p[k] - q[k]).abs()).fold(0.0, f64::max);
    a.iter().zip(b).map(away).fold(0.0, f64::max)
}

/// Order of triangles and of their corners, names, the order of walls, of fixed grains and of entries: none of them is where a wall is.
#[test]
fn a_bed_stays_at_rest_however_its_walls_are_listed() {
    let folder = settled();
    let bed = particles("source = \"settle.mcap\"");
    let stones = |file: &str| particles(&format!("source = \"{file}\"\nmaterial = \"grit\"\nfixed = true"));
    let ball = wall("", "solid = \"sphere:0.01,0.015,0.002,0.005\"");
    let (back, front) = ("plane = \"0,0.004,0,0,1,0\"", "plane = \"0,0.026,0,0,-1,0\"");
    let bin = |name: &str, file: &str| wall(name, &format!("mesh = \"{file}\""));
    let same = [
        stones("stones.csv"),
        bed.clone(),
        bin("bin", "bin.obj"),
        ball.clone(),
        wall("", back),
        wall("front", front),
    ];
    let (said, at_rest) = goes_on(folder.path(), "same", &same);
    assert!(!said.stderr.contains("without history"), "{}", said.stderr);
    let bed_first = [bed.clone(), stones("turned_stones.csv")];
    let walls = [
        wall("", "plane = \"0,0,-5,0,0,1\""),
        wall("", front),
        wall("vessel", back),
        bin("", "otherwise.obj"),
        ball.clone(),
    ];
    let (said, otherwise) = goes_on(folder.path(), "otherwise", &[&bed_first[..], &walls].concat());
    assert!(!said.stderr.contains("without history"), "{}", said.stderr);
    let away = farthest(&at_rest, &otherwise);
    assert!(away < 1e-10, "listed otherwise they move by {away} m more");

    // A wall that is not there any more leaves no contact; one that was replaced does, which is said.
    let opened = [stones("stones.csv"), bed.clone(), bin("bin", "bin.obj"), ball.clone(), wall("", back)];
    let (said, _) = goes_on(folder.path(), "opened", &opened);
    assert!(!said.stderr.contains("without history"), "{}", said.stderr);
    let replaced =
        [stones("stones.csv"), bed, bin("bin", "refined.obj"), ball, wall("", back), wall("front", front)];
    let (said, _) = goes_on(folder.path(), "replaced", &replaced);
    let text = said.stderr.lines().find(|line| line.contains("without history")).expect("a warning");
    assert!(text.contains("settle.mcap: ") && text.contains("where wall 'bin' was"), "{text}");
    let report = std::fs::read_to_string(folder.path().join("replaced.json")).expect("a report");
    let report: Value = serde_json::from_str(&report).expect("JSON");
    let told = report["warnings"].as_array().into_iter().flatten().filter_map(Value::as_str);
    assert_eq!(told.filter(|w| w.contains("without history")).count(), 1, "{report}");
}
