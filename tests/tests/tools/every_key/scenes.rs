//! Scenes that together hold every key, in each form of its value.

/// Materials, and a contact for all pairs.
const MATERIALS: &str = r#"
[[material]]
name = "sinter"
density = 3300
young = 2e6
poisson = 0.25
[[material]]
name = "steel"
density = 7800
young = 2e7
poisson = 0.3
"#;

const CONTACT: &str = r#"
[[contact]]
between = ["*", "*"]
law = "hertz"
restitution = 0.5
sliding_friction = 0.5
"#;

/// Single tables, fills, walls that move.
const PLAIN: &str = r#"
gravity = [0, 0, -9.81]
first_id = 100
precision = "f64"
[time]
until = 0.002
until_unbalanced = 1e-5
until_kinetic = 1e-9
dt = "auto"
safety = 0.4
shorten = 0.02
contacts = "averaged"
patch = "shared"
[output]
every = 0.001
checkpoint = 0.001
energy = true
contacts = true
wall_forces = true
wear = true
precision = "f64"
[domain]
periodic = ["x", "y"]
low = [0, 0, 0]
high = [0.1, 0.1, 0.3]
[local_damping]
factor = 0.7
[neighbours]
skin = 0.001
[guards]
overlap = 0.3
motion = 0.2
zones = "remove"
energy = 0.9
steps = 1e6
frames = 1000
[[fill]]
material = "sinter"
shape = "box:0.01,0.01,0.05,0.09,0.09,0.1"
diameter = 0.01
mass = 0.02
velocity = [0, 0, -0.1]
seed = 3
[[fill]]
material = "sinter"
shape = "sphere:0.05,0.05,0.15,0.03"
diameter = [0.008, 0.01]
count = 4
[[fill]]
material = "sinter"
shape = "cylinder:0.05,0.05,0.2,0.05,0.05,0.25,0.03"
diameter = 0.008
count = 4
[[wall]]
name = "floor"
plane = "0,0,0,0,0,1"
material = "steel"
motion = { translate = [0.1, 0, 0], vibrate = { amplitude = [0, 0, 0.0001], frequency = 50 }, from = 0.0005, until = 0.0015 }
[[wall]]
plane = "0,0,0.3,0,0,-1"
material = "steel"
servo = { direction = [0, 0, -1], force = 10, speed_limit = 0.1 }
[[wall]]
plane = "0,0,-0.01,0,0,1"
material = "steel"
spring = { direction = [0, 0, 1], stiffness = 1e4, damping = 2, mass = 0.5, speed_limit = 1 }
"#;

/// Meshes, boxes, insertion by mass and by number, sleep.
const WALLS: &str = r#"
gravity = [0, 0, -9.81]
precision = "mixed"
[time]
until = 0.002
dt = 1e-5
[output]
every = "step"
energy = false
contacts = false
wall_forces = false
wear = false
precision = "f32"
[domain]
periodic = ["z"]
low = [0, 0, 0]
high = [1, 1, 1]
[guards]
zones = false
energy = false
[sleep]
speed = 1e-3
time = 0.01
wake = 0.2
[[particles]]
source = "grains.csv"
material = "sinter"
units = "m"
[[particles]]
source = "grains-mm.csv"
material = "sinter"
scale = 0.001
[[insert]]
material = "sinter"
shape = "box:0.3,0.3,0.5,0.5,0.5,0.53"
diameter = 0.01
velocity = [0, 0, -1]
rate = 0.5
from = 0.0001
until = 0.0015
repeat = "2 ms"
times = 2
mass = 0.01
seed = 1
when_blocked = "skip"
[[insert]]
material = "sinter"
shape = "cylinder:0.7,0.7,0.5,0.7,0.7,0.53,0.1"
diameter = [0.008, 0.01]
velocity = [0, 0, -1]
rate_count = 2000
count = 2
until = 0.001
repeat = 0.002
when_blocked = "wait"
[[wall]]
box = [0, 0, -1, 1, 1, 2]
faces = ["x-", "x+", "y-", "y+"]
material = "steel"
[[wall]]
box = [0, 0, -1, 1, 1, 2]
faces = ["z-", "z+"]
material = "steel"
[[wall]]
mesh = "tetra.ply"
material = "steel"
motion = { rotate = { about = [0, 0, 1], through = [0.1, 0.1, 0], rpm = 10 } }
[[wall]]
mesh = "tetra.ply"
units = "cm"
material = "steel"
[[wall]]
mesh = "tetra.ply"
scale = 0.5
material = "steel"
place = [{ rotate = { about = [0, 0, 1], through = [0.1, 0, 0], angle = "20 deg" }, translate = [0, 0, 0.001] }, { rotate = { about = [0, 0, 1], angle = 0.1 } }]
[[wall]]
source = "walls.mcap"
units = "m"
[[wall]]
mesh = "tetra.ply"
material = "steel"
motion = [
    { swing = { about = [0, 1, 0], through = [0.1, 0, 0], amplitude = "15 deg", frequency = 2 }, ramp = 0.0005 },
    { swing = { about = [1, 0, 0], through = [0.1, 0, 0], amplitude = 0.1, frequency = 2 } },
    { path = { source = "path.csv", about = [0, 0, 1], through = [0, 0, 0] }, from = 0.0005, until = 0.001, repeat = 0.001 },
]
[[wall]]
solid = "cylinder:0.8,0.2,0.1,0.8,0.2,0.2,0.05"
material = "steel"
surface_rotation = { about = [0, 0, 1], through = [0.8, 0.2, 0.1], rpm = 30 }
[[wall]]
solid = ["box", 0.6, 0.1, 0.1, 0.65, 0.15, 0.11]
material = "steel"
surface_velocity = [0.5, 0, 0]
[[wall]]
box = [0, 0, -1, 1, 1, 2]
faces = ["y-"]
material = "steel"
servo = { direction = [0, 1, 0], stress = 100, area = 0.5, speed_limit = 0.1 }
[[wall]]
box = [0, 0, -1, 1, 1, 2]
faces = ["x-"]
material = "steel"
servo = { direction = [1, 0, 0], path = { source = "load.csv" }, area_between = [["wall.0 y-", "wall.0 y+"], "1 m"], speed_limit = 0.1 }
"#;

/// Clumps of spheres and of a mesh, placed, filled, inserted and read.
const CLUMPS: &str = r#"
gravity = [0, 0, -9.81]
precision = "f32"
[time]
until = 0.002
accuracy = "1%"
[drag]
law = "schiller-naumann"
viscosity = 1e-3
density = 1000
velocity = [0, 0, 0.1]
buoyancy = true
[[clump]]
name = "pair"
material = "sinter"
spheres = [[0, 0, 0, 0.005], [0.006, 0, 0, 0.005]]
mass = "union"
scale = 1.2
[[clump]]
name = "given"
material = "sinter"
spheres = [[0, 0, 0, 0.005], [0.006, 0, 0, 0.005]]
moments = { volume = 1e-6, centre = [0.003, 0, 0], inertia = [2e-11, 3e-11, 3e-11, 0, 0, 0] }
[[body]]
clump = "given"
position = [0.7, 0.5, 0.5]
[[clump]]
name = "twin"
material = "sinter"
spheres = [[0, 0, 0, 0.005], [0.006, 0, 0, 0.005]]
mass = "sum"
[[clump]]
name = "block"
material = "sinter"
mesh = "octa.ply"
vertex_radius = 0.05
faces = 6
scale = 0.06
[[body]]
clump = "block"
position = [0.5, 0.5, 0.5]
quaternion = [0.6, 0.8, 0, 0]
velocity = [0, 0, 1]
spin = [1, 0, 0]
scale = 0.8
[[fill]]
clump = "pair"
scale = [0.8, 1.2]
shape = "box:0,0,0,0.2,0.2,0.2"
count = 5
[[fill]]
clump = "twin"
scale = 0.9
shape = "box:0.3,0,0,0.5,0.2,0.2"
count = 5
[[particles]]
source = "kinds.csv"
materials = ["sinter", "steel"]
[[particles]]
source = "clumps.csv"
clump = "pair"
[[insert]]
clump = "twin"
scale = 1.1
shape = "box:0.3,0.3,0.5,0.5,0.5,0.54"
velocity = [0, 0, -1]
rate = 0.1
when_blocked = "stop"
[[insert]]
clump = "twin"
scale = [0.9, 1.1]
shape = "box:0.6,0.3,0.5,0.8,0.5,0.54"
velocity = [0, 0, -1]
rate = 0.1
"#;

/// Sizes with shares, and grains that stay.
const SIZES: &str = r#"
[time]
until = 0.002
[[fill]]
material = "sinter"
shape = "box:0,0,0,0.1,0.1,0.1"
sizes = [["8 mm", 0.5], [[0.004, 0.006], 0.5]]
by = "number"
count = 20
[[fill]]
material = "sinter"
shape = "box:0.2,0,0,0.3,0.1,0.1"
sizes = "sieve.csv"
by = "mass"
count = 20
[[fill]]
material = "sinter"
shape = "box:0.4,0,0,0.5,0.1,0.1"
sizes = { law = "log-normal", median = "8 mm", deviation = 0.2, from = "6 mm", to = "12 mm" }
count = 20
[[particles]]
source = "grains.csv"
material = "sinter"
fixed = true
[[particles]]
source = "a.csv"
material = "steel"
fixed = false
[[insert]]
shape = "box:0.6,0,0.5,0.7,0.1,0.53"
sizes = [[0.01, 1, "sinter"], [0.008, 2, "steel"]]
by = "number"
velocity = [0, 0, -1]
rate_count = 2000
[[insert]]
material = "sinter"
shape = "box:0.6,0,0.5,0.7,0.1,0.53"
sizes = "sieve.csv"
by = "mass"
velocity = [0, 0, -1]
rate = 0.5
[[insert]]
material = "sinter"
shape = "box:0.8,0,0.5,0.9,0.1,0.53"
sizes = { file = "sieve.csv", units = "m" }
velocity = [0, 0, -1]
rate = 0.5
"#;

/// Grains beside the only wall.
const OUTSIDE: &str = r#"
gravity = [0, 0, -9.81]
[time]
until = 0.002
[domain]
outside = "{outside}"
[[wall]]
name = "plate"
source = "walls.mcap"
[[particles]]
source = "grains.csv"
material = "sinter"
[[remove]]
shape = "box:-2,-2,-2,2,2,-1"
"#;

/// Every law between two materials, and bonds.
const LAWS: &str = r#"
[time]
until = 0.002
safety = 0.3
contacts = "sampled"
patch = "plain"
[guards]
zones = true
[drag]
law = "stokes"
viscosity = 1.8e-5
buoyancy = false
[[contact]]
between = ["a", "a"]
law = "hooke"
stiffness = 1e4
tangential_ratio = 0.3
restitution = 0.5
sliding_friction = 0.5
rolling_resistance = 0.1
rolling_model = "spring"
twisting_resistance = 0.1
[[contact]]
between = ["a", "b"]
law = "jkr"
work_of_adhesion = 0.01
restitution = 0.5
[[contact]]
between = ["b", "b"]
law = "walton_braun"
stiffness = 1e4
tangential_stiffness = 5e3
restitution = 0.5
sliding_friction = { static = 0.5, dynamic = 0.3, speed = 0.1 }
rolling_resistance = 0.1
rolling_model = "constant"
[[contact]]
between = ["a", "c"]
cohesion = "sjkr"
cohesion_energy_density = 1000
restitution = 0.5
[[contact]]
between = ["*", "*"]
law = "hooke"
characteristic_velocity = 1
restitution = 0.5
[[contact]]
between = ["c", "c"]
law = "hooke"
contact_modulus = 1e6
normal_damping = 0.5
sliding_friction = 0.5
tangential_damping = 0.3
[[contact]]
between = ["b", "c"]
law = "hooke"
effective_modulus = 1e6
restitution = 0.5
[[bond]]
between = ["c", "c"]
kind = "beam"
clusters = "same"
gap = 1e-3
young = 1e6
poisson = 0.25
radius_ratio = 0.8
tensile_strength = 1e5
shear_strength = 1e5
damping = 0.1
[[bond]]
between = ["a", "a"]
kind = "parallel"
clusters = "any"
gap = 1e-3
modulus = 2e6
stiffness_ratio = 2
moments = 0.5
tensile_strength = 1e5
strength_ratio = 0.5
friction_angle = 0.5
deviation = 0.1
seed = 3
replaces_contact = true
[[bond]]
between = ["a", "b"]
kind = "parallel"
clusters = "any"
gap = 1e-3
normal_stiffness_per_area = 1e8
shear_stiffness_per_area = 5e7
weibull_modulus = 4
replaces_contact = false
reference_radius = 4e-3
tensile_strength = 1e5
[[bond]]
between = ["b", "b"]
kind = "contact"
clusters = "different"
gap = 1e-3
at = 0.001
normal_stiffness = 1e4
shear_stiffness = 5e3
tensile_force = 10
shear_force = 5
[[particles]]
source = "a.csv"
material = "a"
cluster = 1
[[particles]]
source = "b.csv"
material = "b"
[[particles]]
source = "c.csv"
material = "c"
[[fill]]
material = "b"
shape = "box:0.2,0,0,0.23,0.03,0.01"
diameter = 0.01
lattice = "cubic"
cluster = 3
[[fill]]
material = "b"
shape = "mesh:tetra.ply"
diameter = 0.008
lattice = "hexagonal"
"#;

fn three() -> String {
    let one = |name| format!("[[material]]\nname = \"{name}\"\ndensity = 2000\nyoung = 1e6\npoisson = 0.3\n");
    ["a", "b", "c"].map(one).concat()
}

/// A domain, strained along x as `x` says.
fn strained(domain: &str, x: &str) -> String {
    format!(
        "[time]\nuntil = 0.002\n[domain]\nperiodic = [\"x\", \"y\", \"z\"]\n{domain}[domain.strain]\nx = {{ {x} }}\ny = {{ rate = 0.1 }}\n\
         z = {{ rate = 0.1 }}\n{MATERIALS}{CONTACT}[[particles]]\nsource = \"grains.csv\"\nmaterial = \"sinter\"\n"
    )
}

/// A stage upstream, by the motion in its zone, the length of the zone and the test.
fn upstream(motion: &str, length: &str, test: &str) -> String {
    let samples = if motion == "recorded" { "samples = 1e-4\n" } else { "" };
    format!(
        "[time]\nuntil = 0.02\naccuracy = 0.01\n{MATERIALS}{CONTACT}[[particles]]\nsource = \"grains.csv\"\nmaterial = \"sinter\"\n\
         [[outlet]]\nplane = \"0,0,0.09,0,0,-1\"\nlength = {length}\nmotion = \"{motion}\"\ntest = \"{test}\"\n{samples}\
         plant = \"a b c\"\n"
    )
}

/// The stage downstream of it.
fn downstream(motion: &str, length: &str, test: &str) -> String {
    format!(
        "[time]\nuntil = 0.02\n{MATERIALS}{CONTACT}[[inlet]]\nsource = \"{motion}.mcap\"\nplane = \"0,0,0.09,0,0,-1\"\n\
         length = {length}\nmotion = \"{motion}\"\ntest = \"{test}\"\nplant = \"a b c\"\n"
    )
}

/// How the stages are cut: motion, length, test.
pub const CUTS: [(&str, &str, &str); 3] =
    [("constant", "\"auto\"", "centre"), ("ballistic", "0.03", "lowest"), ("recorded", "\"auto\"", "centre")];

/// All scenes, in an order in which they can be run.
pub fn scenes() -> Vec<(String, String)> {
    let of = |text: &str| [text, MATERIALS, CONTACT].concat();
    let mut all = vec![
        ("plain".to_owned(), of(PLAIN)),
        ("walls".to_owned(), of(WALLS)),
        ("clumps".to_owned(), of(CLUMPS)),
        ("sizes".to_owned(), of(SIZES)),
        ("laws".to_owned(), [LAWS, &three()].concat()),
    ];
    let corners = "low = [0.1, 0.1, 0]\nhigh = [0.6, 0.6, 0.6]\n";
    all.push(("strained".to_owned(), strained(corners, "stress = 1000, rate_limit = 1")));
    all.push(("strained-path".to_owned(), strained(corners, "path = { source = \"strain.csv\" }")));
    all.push(("strained-on".to_owned(), strained("source = \"strained.mcap\"\n", "rate = 0.5")));
    for outside in ["keep", "remove"] {
        all.push((format!("outside-{outside}"), of(&OUTSIDE.replace("{outside}", outside))));
    }
    for (motion, length, test) in CUTS {
        all.push((format!("up-{motion}"), upstream(motion, length, test)));
        all.push((format!("down-{motion}"), downstream(motion, length, test)));
    }
    all
}

/// A cloud of which a wall is made.
pub const FLAT: &str = "0.3 0.3 0.1\n0.31 0.3 0.1\n0.3 0.31 0.1\n0.31 0.31 0.1\n";

/// Command lines that make the other files that the scenes read.
pub fn before() -> Vec<String> {
    let mut all = vec!["wallgen flat.xyz --radius 0.005 --material steel -q -o walls.mcap".to_owned()];
    all.push("dem-run strained.toml -q -o strained.mcap".to_owned());
    for (motion, ..) in CUTS {
        all.push(format!("dem-run up-{motion}.toml -q -o up.mcap"));
        all.push(format!("stage-replay up.mcap -q -o {motion}.mcap"));
    }
    all
}

/// Files that the scenes read.
pub const FILES: [(&str, &str); 13] = [
    ("strain.csv", "t,strain\n0,0\n0.001,0.002\n"),
    ("sieve.csv", "diameter,passing\n0.006,0\n0.008,30\n0.01,100\n"),
    ("grains-mm.csv", "x,y,z,radius\n400,200,300,5\n"),
    ("load.csv", "t,stress\n0,100\n0.001,150\n"),
    ("path.csv", "t,x,y,z,angle\n0,1,0,0,0.1\n0.001,1.0001,0,0,0.1001\n0.002,1,0,0,0.1\n"),
    ("grains.csv", "x,y,z,radius,vz\n0.2,0.2,0.1,0.005,-1\n0.2,0.25,0.12,0.005,-1\n0.25,0.2,0.15,0.004,-1\n"),
    ("kinds.csv", "x,y,z,radius,material,class\n0.9,0.1,0.9,0.005,1,2\n0.9,0.2,0.9,0.005,0,0\n"),
    ("clumps.csv", "x,y,z,qw,qx,qy,qz\n0.9,0.9,0.9,1,0,0,0\n"),
    ("a.csv", "x,y,z,radius\n0,0,0,0.005\n0.00999,0,0,0.005\n"),
    ("b.csv", "x,y,z,radius,cluster\n0,0.0099999,0,0.005,1\n0.00999,0.0199999,0,0.005,2\n"),
    ("c.csv", "x,y,z,radius\n0.1,0,0,0.005\n0.1101,0,0,0.005\n0.1,0.0101,0,0.005\n"),
    (
        "octa.ply",
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
         element face 8\nproperty list uchar int vertex_indices\nend_header\n0.1 0 0\n-0.1 0 0\n0 0.1 0\n0 -0.1 0\n0 0 0.1\n0 0 -0.1\n\
         3 0 2 4\n3 2 1 4\n3 1 3 4\n3 3 0 4\n3 2 0 5\n3 1 2 5\n3 3 1 5\n3 0 3 5\n",
    ),
    (
        "tetra.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
         element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n0.1 0 0\n0 0.1 0\n0 0 0.1\n\
         3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n",
    ),
];
