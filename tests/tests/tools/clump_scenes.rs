//! Scenes with rigid clumps, as a user runs them.

use grainpipe_tests::recorded::{frames, metadata, tables};
use grainpipe_tests::tools::{succeed, tool};
use grainpipe_tests::tree::root;
use std::fs;
use stream::Table;
use tempfile::tempdir;

/// A cube of 20 mm, its centre at (1, 2, 3) mm.
const CUBE: &str =
    "ply\nformat ascii 1.0\nelement vertex 8\nproperty double x\nproperty double y\nproperty double z
element face 6\nproperty list uchar int vertex_indices\nend_header
-0.009 -0.008 -0.007\n0.011 -0.008 -0.007\n-0.009 0.012 -0.007\n0.011 0.012 -0.007
-0.009 -0.008 0.013\n0.011 -0.008 0.013\n-0.009 0.012 0.013\n0.011 0.012 0.013
4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";

const SCENE: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 0.4
[output]
every = 0.1
checkpoint = 0.2
[[material]]
name = "stone"
density = 2500
young = 1.5e8
poisson = 0.25
[[contact]]
between = ["*", "*"]
restitution = 0.3
sliding_friction = 0.5
[[clump]]
name = "cube"
material = "stone"
mesh = "cube.ply"
vertex_radius = 0.004
[[clump]]
name = "pair"
material = "stone"
spheres = [[0, 0, 0, 0.01], [0.012, 0, 0, 0.008]]
[[body]]
clump = "cube"
position = [0, 0, 0.1]
quaternion = [0.70710678, 0, 0, 0.70710678]
spin = [0, 0, 3]
[[particles]]
source = "pairs.csv"
clump = "pair"
[[fill]]
clump = "pair"
scale = [0.7, 1.1]
shape = "box:-0.1,-0.1,0.15,0.1,0.1,0.3"
count = 9
[[fill]]
material = "stone"
shape = "box:-0.1,-0.1,0.15,0.1,0.1,0.3"
diameter = [0.01, 0.015]
count = 20
[[insert]]
clump = "cube"
scale = [0.5, 0.8]
shape = "cylinder:0,0,0.4,0,0,0.45,0.05"
velocity = [0, 0, -1]
rate_count = 40
until = 0.3
[[wall]]
plane = "0,0,0,0,0,1"
material = "stone"
"#;

fn folder(scene: &str) -> tempfile::TempDir {
    let folder = tempdir().expect("a folder");
    let file = |name: &str, text: &str| fs::write(folder.path().join(name), text).expect("can be written");
    file("s.toml", scene);
    file("cube.ply", CUBE);
    file("pairs.csv", "x,y,z,qw,qz,scale,vz\n0.05,0,0.05,1,0,1,-1\n-0.05,0,0.05,1,1,1.5,0\n");
    folder
}

fn column(table: &Table, name: &str) -> Vec<f64> {
    table.get(name).unwrap_or_else(|| panic!("column {name}")).to_f64()
}

/// Bodies, their members and free spheres, in frames that hang together; a resumed run writes the same last frame.
#[test]
fn clumps_from_body_file_fill_and_faucet() {
    let folder = folder(SCENE);
    let run = folder.path().join("run.mcap");
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
    let (frames, bodies, clumps) = (frames(&run), tables(&run, "/bodies"), metadata(&run, "clumps"));
    assert_eq!((frames.len(), bodies.len(), clumps.len()), (5, 5, 2));
    assert!(clumps["0"].contains("\"cube\"") && clumps["0"].contains("\"volume\":"), "{clumps:?}");

    let (first, last) = (&bodies[0], &bodies[4]);
    // One [[body]], two of the file, nine of the fill; the faucet brings one each 25 ms.
    assert_eq!(column(first, "id").len(), 13, "the faucet's first is on its plane at t = 0");
    assert_eq!(column(last, "id").len(), 12 + 12);
    let mass = 2500.0 * 8e-6;
    let cube = column(first, "clump").iter().position(|&c| c == 0.0).expect("the [[body]]");
    assert!((column(first, "mass")[cube] / mass - 1.0).abs() < 1e-12);
    assert!(
        (column(first, "z")[cube] - 0.1).abs() < 1e-12
            && (column(first, "qz")[cube] - 0.5f64.sqrt()).abs() < 1e-12
    );
    assert!((column(first, "wz")[cube] - 3.0).abs() < 1e-12);

    let members: f64 = column(last, "members").iter().sum();
    let (id, body) = (column(&frames[4], "id"), column(&frames[4], "body"));
    assert_eq!(id.len() as f64, members + 20.0, "twenty spheres");
    assert_eq!(
        id.iter().zip(&body).filter(|(i, b)| i == b).count(),
        24 + 20,
        "a body bears the id of its first sphere"
    );
    // Members keep their distance from the centre.
    let (x, z) = (column(&frames[4], "z"), column(last, "z"));
    let ids = column(last, "id");
    for (k, b) in body.iter().enumerate().filter(|(k, b)| id[*k] != **b) {
        let at = ids.iter().position(|i| i == b).expect("its body");
        assert!((x[k] - z[at]).abs() < 0.03, "member {} of {b}", id[k]);
    }
    // Nothing has sunk into the floor.
    assert!(x.iter().zip(column(&frames[4], "radius")).all(|(z, r)| *z > 0.8 * r));

    succeed(folder.path(), "dem-run", &["s.toml", "--until", "0.2", "-o", "half.mcap"]);
    succeed(folder.path(), "dem-run", &["s.toml", "--resume", "half.mcap", "-o", "rest.mcap"]);
    for topic in ["/particles", "/bodies"] {
        let (whole, rest) = (tables(&run, topic), tables(&folder.path().join("rest.mcap"), topic));
        assert_eq!(whole.last(), rest.last(), "{topic} of the resumed run");
    }
    let done = succeed(folder.path(), "dem-run", &["s.toml", "--explain"]);
    let text = String::from_utf8_lossy(&done.stdout).into_owned();
    assert!(text.contains("clump.0 'cube' of 8, clump.1 'pair' of 2") && text.contains("B a body"), "{text}");
}

/// A scan of 3740 faces: spheres on a tenth of its vertices, the mass and the inertia of all of it.
#[test]
fn a_scanned_stone_becomes_a_clump_of_few_spheres_and_keeps_its_moments() {
    let stone = root().join("sample-data/stones/quarry.ply");
    let scene = |faces: &str| {
        format!(
            "[time]\nuntil = 1e-4\n[output]\nevery = 1e-4\n[[material]]\nname = \"stone\"\ndensity = 2500\nyoung = 5e7\npoisson = 0.25\n\
             [[contact]]\nbetween = [\"*\", \"*\"]\nrestitution = 0.3\n[[clump]]\nname = \"stone\"\nmaterial = \"stone\"\nmesh = \"{}\"\n\
             vertex_radius = 0.001\n{faces}\n[[body]]\nclump = \"stone\"\nposition = [0, 0, 1]\n",
            stone.display()
        )
    };
    let record = |faces: &str| {
        let folder = folder(&scene(faces));
        succeed(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
        let text = metadata(&folder.path().join("run.mcap"), "clumps")["0"].clone();
        serde_json::from_str::<serde_json::Value>(&text).expect("a record")
    };
    let (whole, few) = (record(""), record("faces = 100"));
    assert_eq!(few["spheres"].as_array().expect("a list").len(), 52);
    assert!(whole["spheres"].as_array().expect("a list").len() > 1800);
    for key in ["volume", "centre", "inertia"] {
        assert_eq!(whole[key], few[key], "{key}");
    }
    for (faces, why) in [("faces = 3", "so few"), ("faces = 9000", "the mesh has 3740 faces")] {
        let folder = folder(&scene(faces));
        let refused = tool(folder.path(), "dem-run", &["s.toml", "--check"]);
        assert!(
            refused.code == 1 && refused.stderr.contains("clump.0.faces") && refused.stderr.contains(why),
            "{}",
            refused.stderr
        );
    }
}

#[test]
fn wrong_clumps_say_where_what_and_what_to_do() {
    let cases: &[(&str, &str, &[&str])] = &[
        ("[[clump]]", "[[clumps]]", &["did you mean 'clump'?"]),
        ("vertex_radius", "vertexradius", &["did you mean 'vertex_radius'?"]),
        ("vertex_radius = 0.004", "", &["clump.0", "vertex_radius goes with mesh"]),
        ("vertex_radius = 0.004", "vertex_radius = -1", &["clump.0.vertex_radius = -1 m"]),
        ("name = \"pair\"", "name = \"cube\"", &["clump.1.name", "differently"]),
        ("[0.012, 0, 0, 0.008]", "[0.03, 0, 0, 0.008]", &["clump.1.spheres", "2 parts that do not overlap"]),
        ("[0.012, 0, 0, 0.008]", "[0.012, 0, 0, -1]", &["clump.1.spheres.1 = -1 m"]),
        (
            "clump = \"cube\"\nposition",
            "clump = \"cub\"\nposition",
            &["body.0.clump", "did you mean 'cube'?"],
        ),
        (
            "quaternion = [0.70710678, 0, 0, 0.70710678]",
            "quaternion = [0, 0, 0, 0]",
            &["body.0.quaternion", "[1, 0, 0, 0]"],
        ),
        ("scale = [0.7, 1.1]", "diameter = 0.01", &["fill.0.diameter", "a clump has its own"]),
        ("diameter = [0.01, 0.015]", "", &["fill.1", "diameter is missing"]),
        ("diameter = [0.01, 0.015]", "diameter = 0.01\nscale = 2", &["fill.1.scale", "only clumps"]),
        ("count = 9", "count = 900", &["fill.0.shape", "bounding spheres"]),
        ("0.45,0.05\"", "0.41,0.05\"", &["insert.0.shape", "thick"]),
        (
            "[[wall]]",
            "[[outlet]]\nplane = \"0,0,-1,0,0,-1\"\ntest = \"lowest\"\n[[wall]]",
            &["only centres are tested", "the scene has '"],
        ),
    ];
    for (from, to, parts) in cases {
        assert!(SCENE.contains(from), "{from}");
        let folder = folder(&SCENE.replacen(from, to, 1));
        let done = tool(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
        assert_eq!(done.code, 1, "{to}: {}", done.stderr);
        for part in *parts {
            assert!(done.stderr.contains(part), "{to}: wanted '{part}' in: {}", done.stderr);
        }
    }
    let folder = folder(SCENE);
    fs::write(folder.path().join("cube.ply"), CUBE.replace("face 6", "face 5").replace("4 1 3 7 5\n", ""))
        .expect("can be written");
    let open = tool(folder.path(), "dem-run", &["s.toml", "--check"]);
    assert!(open.stderr.contains("clump.0.mesh") && open.stderr.contains("not closed"), "{}", open.stderr);
}

/// Pairs and spheres that have come to rest in a box.
const HEAP: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 0.5
dt = 5e-6
[output]
every = 0.5
[[material]]
name = "stone"
density = 2500
young = 5e6
poisson = 0.25
[[contact]]
between = ["*", "*"]
restitution = 0.3
sliding_friction = 0.5
rolling_resistance = 0.1
[[clump]]
name = "pair"
material = "stone"
spheres = [[0, 0, 0, 0.004], [0.005, 0, 0, 0.003]]
[[fill]]
clump = "pair"
scale = [0.8, 1.2]
shape = "box:0,0,0,0.04,0.04,0.1"
count = 24
[[fill]]
material = "stone"
shape = "box:0,0,0,0.04,0.04,0.1"
diameter = 0.006
count = 12
[[wall]]
name = "box"
box = [0, 0, 0, 0.04, 0.04, 0.2]
material = "stone"
"#;

/// The same with the grains of heap.mcap instead of fills.
fn from_run(more: &str) -> String {
    let (before, rest) = HEAP.split_once("[[fill]]").expect("fills");
    let (_, walls) = rest.split_once("[[wall]]").expect("a wall");
    let scene = format!("{before}[[particles]]\nsource = \"heap.mcap\"\n{more}[[wall]]{walls}");
    scene.replace("until = 0.5", "until = 0.1").replace("every = 0.5", "every = 0.1")
}

/// A scene that takes the clumps of a run begins with the run's last frame and goes on as the run itself would have: springs of friction are kept.
#[test]
fn clumps_of_a_run_go_on_as_they_lie() {
    let folder = folder(HEAP);
    let file = |name: &str| folder.path().join(name);
    succeed(folder.path(), "dem-run", &["s.toml", "-q", "-o", "heap.mcap"]);
    fs::write(file("next.toml"), from_run("")).expect("can be written");
    let done = succeed(folder.path(), "dem-run", &["next.toml", "-o", "next.mcap"]);
    assert!(!done.stderr.contains("warning"), "{}", done.stderr);
    for topic in ["/particles", "/bodies"] {
        let (left, taken) = (tables(&file("heap.mcap"), topic), tables(&file("next.mcap"), topic));
        let (left, taken) = (left.last().expect("a frame"), taken.first().expect("a frame"));
        assert_eq!(left.rows(), taken.rows(), "{topic}");
        for name in ["id", "x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz"] {
            assert!(apart(left, taken, name) < 1e-14, "{topic} {name}");
        }
    }
    succeed(
        folder.path(),
        "dem-run",
        &["s.toml", "--until", "0.6", "--resume", "heap.mcap", "-q", "-o", "on.mcap"],
    );
    let (on, next) = (tables(&file("on.mcap"), "/bodies"), tables(&file("next.mcap"), "/bodies"));
    let (on, next) = (on.last().expect("a frame"), next.last().expect("a frame"));
    let most = ["x", "y", "z"].map(|name| apart(on, next, name)).into_iter().fold(0.0, f64::max);
    assert!(most < 1e-10, "{most} m apart");
}

/// Largest difference in a column.
fn apart(a: &Table, b: &Table, name: &str) -> f64 {
    column(a, name).iter().zip(column(b, name)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn clumps_of_a_run_are_refused_where_they_would_be_others() {
    let folder = folder(&HEAP.replace("until = 0.5", "until = 0.01"));
    succeed(folder.path(), "dem-run", &["s.toml", "-q", "-o", "heap.mcap"]);
    let refused = |scene: &str, parts: &[&str]| {
        fs::write(folder.path().join("next.toml"), scene).expect("can be written");
        let done = tool(folder.path(), "dem-run", &["next.toml", "--check"]);
        assert_eq!(done.code, 1, "{}", done.stderr);
        for part in parts {
            assert!(done.stderr.contains(part), "wanted '{part}' in: {}", done.stderr);
        }
    };
    refused(&from_run("material = \"stone\"\n"), &["particles.0.material", "take it out"]);
    refused(&from_run("fixed = true\n"), &["particles.0.fixed", "cannot be fixed"]);
    refused(
        &from_run("").replace("0.005, 0, 0, 0.003", "0.004, 0, 0, 0.003"),
        &["'pair' has other spheres", "[[clump]]"],
    );
    refused(&from_run("").replace("name = \"pair\"", "name = \"twin\""), &["heap.mcap", "pair"]);
    let split = ["next.toml", "--at", "0,0,0.05,0,0,-1", "--keep", "upstream"];
    fs::write(folder.path().join("next.toml"), from_run("")).expect("can be written");
    let done = tool(folder.path(), "stage-split", &split);
    assert!(done.code == 1 && done.stderr.contains("only dem-run places these"), "{}", done.stderr);
}

/// Six cubes fall through a plane: each is one grain with the mass of a cube, not with that of its spheres.
#[test]
fn a_clump_is_measured_as_one_grain_with_its_own_mass() {
    let (head, _) = SCENE.split_once("[[clump]]\nname = \"pair\"").expect("the pair");
    let fill = "[[fill]]\nclump = \"cube\"\nshape = \"box:-0.2,-0.2,0.1,0.2,0.2,0.3\"\ncount = 6\n";
    let folder = folder(&format!("{head}{fill}"));
    let path = folder.path();
    succeed(path, "dem-run", &["s.toml", "-o", "run.mcap"]);
    let numbers = |options: &[&str]| {
        let words = [&["run.mcap", "--json", "-q"][..], options].concat();
        let report: serde_json::Value =
            serde_json::from_slice(&succeed(path, "dem-measure", &words).stdout).expect("JSON");
        move |key: &str| report["summary"][key]["value"].as_f64().unwrap_or_else(|| panic!("{key}: {report}"))
    };
    let cube = 0.02_f64.powi(3);
    let flow = numbers(&["--flow", "0,0,0,0,0,-1"]);
    assert_eq!(flow("forward"), 6.0);
    assert!((flow("mass") / (6.0 * 2500.0 * cube) - 1.0).abs() < 1e-6, "{} kg", flow("mass"));
    let room = "box:-0.3,-0.3,0,0.3,0.3,0.4";
    let porosity = numbers(&["--porosity", room, "--time", "0"]);
    let solid = porosity("solid_fraction") * 0.6 * 0.6 * 0.4;
    assert!((solid / (6.0 * cube) - 1.0).abs() < 1e-6, "{solid} m³");
    assert_eq!(porosity("grains"), 6.0);
    let contacts = numbers(&["--contacts", "--time", "0"]);
    assert_eq!(contacts("coordination"), 0.0, "spheres of one clump touch nothing");
}
