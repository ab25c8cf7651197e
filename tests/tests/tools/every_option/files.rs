//! Small inputs for the examples: clouds, a mesh, a prism, tables of regions, scenes.

use grainpipe_tests::lab::{ROCK, SAND, cube};
use grainpipe_tests::scenes::folder;
use tempfile::TempDir;

// This file is read by two tests.
#[path = "photographs.rs"]
mod photographs;

const TETRAHEDRON: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n\
                           property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n\
                           0 0 0\n0.3 0 0\n0 0.3 0\n0 0 0.3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

/// A slope below the grains.
const TILE: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                    element face 2\nproperty list uchar int vertex_indices\nend_header\n\
                    0 0 0.01\n0.1 0 0\n0.1 0.06 0\n0 0.06 0.01\n3 0 1 2\n3 0 2 3\n";

const SLOPE: &str = "[[wall]]\nname = \"slope\"\nmesh = \"tile.ply\"\nmaterial = \"sinter\"\n";

const PRISM: &str = r#"{"polygon": [[-1,-1,-1],[0.1,-1,-1],[0.1,1,-1],[-1,1,-1]], "extrusion": [0,0,2]}"#;

const REGIONS: &str = "[[region]]\nname = \"left\"\nshape = \"box:-1,-1,-1,0.1,1,1\"\naction = \"keep\"\n";

const ROUGHNESS: &str =
    "roughness = 0.001\n[[region]]\nname = \"worn\"\nshape = \"box:-1,-1,-1,0.1,1,1\"\nroughness = 0.002\n";

const HEAD: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 0.05
until_unbalanced = 1e-9
[output]
every = 0.002
energy = true
contacts = true
[[material]]
name = "sinter"
density = 3300
young = 2e6
poisson = 0.25
[[material]]
name = "coal"
density = 1400
young = 2e6
poisson = 0.25
[[contact]]
between = ["*", "*"]
restitution = 0.5
sliding_friction = 0.5
rolling_resistance = 0.1
"#;

const GRAINS: &str = r#"[[fill]]
material = "sinter"
shape = "box:0,0,0.02,0.06,0.06,0.08"
diameter = [0.008, 0.012]
count = 30
velocity = [0, 0, -1]
"#;

/// A wedge that leans on a wall, at 45°, and a grain of another material.
const HEAP: &str = "[[particles]]\nsource = \"heap.csv\"\nmaterial = \"sinter\"\n\
                    [[particles]]\nsource = \"one.csv\"\nmaterial = \"coal\"\n";

fn floor(height: f64) -> String {
    format!("[[wall]]\nname = \"floor\"\nplane = \"0,0,{height},0,0,1\"\nmaterial = \"sinter\"\n")
}

/// 400 points, 10 mm apart.
pub fn plate() -> impl Iterator<Item = (f64, f64)> {
    (0..400).map(|k| (0.01 * f64::from(k % 20), 0.01 * f64::from(k / 20)))
}

/// The head of a scene whose grains are bonded; the bonds break at once.
fn bonded() -> String {
    let bond = "[[bond]]\nbetween = [\"sinter\", \"sinter\"]\ngap = 1e-4\nyoung = 2e6\npoisson = 0.25\n\
                tensile_strength = 100\nshear_strength = 100\n";
    [&HEAD.replace("until = 0.05", "until = 0.004"), bond].concat()
}

/// Grains whose material has numbers in the table of materials, but for its modulus.
fn named() -> String {
    let head = HEAD.replace("name = \"coal\"\ndensity = 1400\n", "name = \"coal\"\n");
    [
        &head
            .replace("name = \"coal\"", "name = \"limestone\"")
            .replace("poisson = 0.25\n[[contact]]", "[[contact]]"),
        GRAINS,
    ]
    .concat()
}

/// The lattice in a domain that is strained.
fn strained() -> String {
    let head = HEAD.replace("until = 0.05", "until = 0.004").replace("gravity = [0, 0, -9.81]\n", "");
    let domain = "[domain]\nperiodic = [\"x\", \"y\", \"z\"]\nlow = [0, 0, 0]\nhigh = [0.1, 0.1, 0.1]\n\
                  strain = { z = { rate = 0.5 } }\n";
    [&head, domain, GRAINS].concat()
}

fn heap() -> String {
    let at = |i: i32| 0.01 * f64::from(i) + 0.005;
    let column = |i: i32, j: i32| (0..10 - i).map(move |k| format!("{},{},{},0.005\n", at(i), at(j), at(k)));
    let rows = (0..10).flat_map(|i| (0..8).flat_map(move |j| column(i, j)));
    ["x,y,z,radius\n".to_owned()].into_iter().chain(rows).collect()
}

/// Grains of 10 mm that fill a cube of 0.1 m.
fn lattice() -> String {
    let at = |k: usize| 0.01 * k as f64 + 0.005;
    let row = |k: usize| format!("{},{},{},0.005\n", at(k % 10), at(k / 10 % 10), at(k / 100));
    ["x,y,z,radius\n".to_owned()].into_iter().chain((0..1000).map(row)).collect()
}

/// A line whose slope is to be found, and its measured points.
const RECIPE: &str = r#"[settings]
trials = 12
[[parameter]]
name = "slope"
bounds = [1, 3]
[[test]]
name = "shear"
command = """awk 'BEGIN { print "u,tau"; for (k = 0; k < 9; k++) print k "," {slope} * k }'"""
x = "u"
y = "tau"
deviation = 0.1
"#;
const MEASURED: &str = "u,tau\n0,0\n1,2.1\n2,3.9\n3,6.1\n4,8\n5,9.9\n6,12.1\n";

/// Two grains that meet, in two steps.
const SPHERES: &str = r#"[time]
until = 2e-5
dt = 1e-5
[output]
every = 1e-5
[[material]]
name = "glass"
density = 2500
young = 1e6
poisson = 0.25
[[contact]]
between = ["glass", "glass"]
law = "hooke"
stiffness = 1e3
restitution = 0.6
[[particles]]
source = "two.csv"
material = "glass"
"#;

/// What LAMMPS would write of them.
fn dump() -> String {
    let frame = |step: u32| {
        format!(
            "ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS mm mm mm\n0 1\n0 1\n0 1\n\
             ITEM: ATOMS id x y z vx vy vz omegax omegay omegaz\n1 0 0 0 0 0 0 0 0 0\n2 0.01 0 0 -1 0 0 0 0 0\n"
        )
    };
    (0..3).map(frame).collect()
}

/// Whether LAMMPS and an MPI launcher are here; where they are not, this is counted as a skipped test.
pub fn lammps() -> bool {
    let found = |program: &str| std::process::Command::new(program).arg("-h").output().is_ok();
    let missing = ["lmp", "mpirun.openmpi"].into_iter().find(|program| !found(program));
    missing.iter().for_each(|program| grainpipe_tests::skip(program));
    missing.is_none()
}

/// A folder with all of them.
pub fn inputs() -> TempDir {
    let flat: String = plate().map(|(x, y)| format!("{x} {y} 0\n")).collect();
    let hole = |&(x, y): &(f64, f64)| (x - 0.1).hypot(y - 0.1) >= 0.03;
    let scan = (0..).zip(plate()).filter(|(_, at)| hole(at));
    let scan: String = scan.map(|(k, (x, y))| format!("{x} {y} {}\n", 0.002 * f64::from(k).sin())).collect();
    let plant = [&HEAD.replace("until_unbalanced = 1e-9\n", ""), GRAINS, &floor(-1.0)].concat();
    let outlet = "[[outlet]]\nplane = \"0,0,0.02,0,0,-1\"\nmotion = \"recorded\"\n";
    let made = folder(&[
        ("flat.xyz", flat),
        ("scan.xyz", scan),
        ("tetra.ply", TETRAHEDRON.to_owned()),
        ("prism.json", PRISM.to_owned()),
        ("regions.toml", REGIONS.to_owned()),
        ("rough.toml", ROUGHNESS.to_owned()),
        ("quarter.txt", "0 -1 0 0.1\n1 0 0 0\n0 0 1 0\n0 0 0 1\n".to_owned()),
        ("spheres.toml", SPHERES.to_owned()),
        ("two.csv", "x,y,z,radius,vx\n0,0,0,0.005,0\n0.01,0,0,0.005,-1\n".to_owned()),
        ("frames.dump", dump()),
        ("heap.csv", heap()),
        ("one.csv", "x,y,z,radius\n0.15,0.04,0.004,0.004\n".to_owned()),
        ("grains.csv", lattice()),
        ("library/rock_1_1.ply", TETRAHEDRON.replace("0.3", "0.06")),
        ("grading.csv", "from,to,share\n0.02,0.03,1\n".to_owned()),
        ("s.toml", [HEAD, GRAINS, &floor(0.0)].concat()),
        ("tile.ply", TILE.to_owned()),
        ("worn.toml", [&HEAD.replace("energy = true", "wear = true"), GRAINS, SLOPE].concat()),
        ("heap.toml", [&HEAD.replace("until = 0.05", "until = 0.004"), HEAP, &floor(0.0)].concat()),
        (
            "bonded.toml",
            [&bonded(), "[[particles]]\nsource = \"heap.csv\"\nmaterial = \"sinter\"\n", &floor(0.0)]
                .concat(),
        ),
        ("cell.toml", strained()),
        ("named.toml", named()),
        ("soil.toml", SAND.to_owned()),
        ("stone.toml", ROCK.to_owned()),
        ("stone.csv", cube()),
        ("recipe.toml", RECIPE.to_owned()),
        ("shear.csv", MEASURED.to_owned()),
        ("up.toml", [&plant, outlet].concat()),
        ("plant.toml", plant),
    ]);
    photographs::write(made.path());
    made
}
