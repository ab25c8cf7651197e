//! Scenes that cannot be run, by what is wrong in them.

use super::SCENE;
use grainpipe_tests::tools::tool;
use std::fs;
use tempfile::tempdir;

/// [`SCENE`] with a text replaced by another.
struct Change {
    from: &'static str,
    to: &'static str,
    /// What stderr must say.
    parts: &'static [&'static str],
}

const fn wrong(from: &'static str, to: &'static str, parts: &'static [&'static str]) -> Change {
    Change { from, to, parts }
}

const KEYS_TIME_AND_GRAVITY: &[Change] = &[
    wrong("poisson = 0.25", "poison = 0.25", &["s.toml:8:1", "'poison'", "did you mean 'poisson'?"]),
    wrong("[[fill]]", "[[fil]]", &["s.toml:17:3", "did you mean 'fill'?"]),
    wrong("gravity = [0, 0, -9.81]", "gravity = -9.81", &["s.toml:1:11"]),
    wrong(
        "until = 0.01",
        "until = 0.01\ndt = 1e-6\nsafety = 0.1",
        &["time.safety = 0.1", "dt = 0.000001 s sets the step"],
    ),
    wrong("[time]", "[time]\ndt = 1", &["above the critical step", "sinter"]),
    wrong("until = 0.01", "", &["time.until", "--until"]),
    wrong("until = 0.01", "until = 0.01\nsteps = 4", &["unknown key 'steps'"]),
    wrong("[[fill]]", "[sleep]\nspeed = 1e-3\nwake = 1\n[[fill]]", &["sleep.wake = 1", "free fall", "0.1"]),
];

const MATERIALS_AND_FILLS: &[Change] = &[
    wrong("density = 3300", "density = -1", &["material.0.density = -1 kg/m³", "positive"]),
    wrong("density = 3300\n", "", &["fill.0.material", "density is missing", "kg/m³"]),
    wrong("[0.01, 0.02]", "[0.02, 0.01]", &["fill.0.diameter = [0.02, 0.01] m", "[smallest, largest]"]),
    wrong("[0.01, 0.02]", "[10, 200]", &["5 mm is 0.005"]),
    wrong("count = 5", "count = 5\nmass = 1", &["fill.0", "mass and count", "only one"]),
    wrong("count = 5", "count = 500", &["fit without touching", "kg"]),
    wrong("box:0,0,0,0.1,0.1,0.1", "ball:0", &["fill.0.shape", "sphere:x,y,z,r"]),
    wrong(
        "[[wall]]",
        "[[insert]]\nmaterial = \"sinter\"\nshape = \"box:0,0,-0.2,0.1,0.1,-0.1\"\ndiameter = 0.01\nrate_count = 10\nvelocity = [0,0,-1]\n[[wall]]",
        &["insert.0.shape", "0.19 m behind wall 'floor'", "normal"],
    ),
];

const PAIRS_OF_CONTACTS_AND_BONDS: &[Change] = &[
    wrong(
        "sliding_friction = 0.5",
        "sliding_friction = \"0.5\"",
        &["write it without quotes, or add a unit"],
    ),
    wrong(
        "[[fill]]",
        "[[clump]]\nname = \"c\"\nmaterial = \"sinter\"\nmesh = \"c.ply\"\nvertex_radius = 0.001\nmass = \"sum\"\n[[fill]]",
        &["clump.0.mass = \"sum\"", "a mesh has its own volume"],
    ),
    wrong(
        "[[wall]]",
        "[[wall]]\nname = \"floor\"\nplane = \"0,0,-0.02,0,0,1\"\nmaterial = \"steel\"\n[[wall]]\nname = \"lid\"\n\
         plane = \"0,0,0.12,0,0,-1\"\nmaterial = \"steel\"\nservo = { direction = [0, 0, -1], stress = 1000, \
         area_between = [[\"floor\", \"lid\"], 0.1], speed_limit = 1 }\n[[wall]]",
        &["wall.2.name = \"floor\"", "is a name of wall.0 (s.toml:23:8), too"],
    ),
    wrong(
        "\"sinter\", \"*\"",
        "\"sinter\", \"*\", \"stele\"",
        &["s.toml:14:11", "wrong number of values: 3", "2 names"],
    ),
    wrong(
        "plane = \"0,0,-0.01,0,0,1\"",
        "box = [0,0,0,1,1,1]\nfaces = []",
        &["wall.0.faces = []", "nothing of the box"],
    ),
    wrong("\"sinter\", \"*\"", "\"sintr\", \"*\"", &["contact.0.between.0", "did you mean 'sinter'?"]),
    wrong(
        "\"sinter\", \"*\"",
        "\"sinter\", \"sinter\"",
        &["no law between 'sinter' and 'steel'", "[[contact]]"],
    ),
    wrong(
        "[[wall]]",
        "[[contact]]\nbetween = [\"*\", \"steel\"]\nrestitution = 0.1\n[[wall]]",
        &["sinter and steel"],
    ),
    wrong(
        "[[wall]]",
        "[[bond]]\nstrength = 1\n[[wall]]",
        &["unknown key 'strength'", "did you mean 'shear_strength'"],
    ),
];

/// Bonds that cannot be made, behind their materials and their gap.
const BONDS: &[(&str, &[&str])] = &[
    (
        r#"kind = "glue"
young = 1e8
poisson = 0.2"#,
        &["glue", "contact"],
    ),
    (r#"young = 1e8"#, &["bond.0", "poisson is missing"]),
    (
        r#"young = 1e8
poisson = 0.2
modulus = 1e8"#,
        &["bond.0.modulus", "kind = \"parallel\" or \"contact\""],
    ),
    (
        r#"kind = "parallel"
modulus = 1e8"#,
        &["bond.0", "stiffness_ratio is missing"],
    ),
    (
        r#"kind = "parallel"
modulus = 1e8
stiffness_ratio = 2
shear_stiffness_per_area = 1e8"#,
        &["bond.0.shear_stiffness_per_area", "say it already"],
    ),
    (
        r#"kind = "contact"
normal_stiffness = 1e4
shear_stiffness = 1e4
stiffness_ratio = 1"#,
        &["bond.0.stiffness_ratio", "goes with 'modulus'"],
    ),
    (
        r#"kind = "contact"
modulus = 1e8
stiffness_ratio = 2
radius_ratio = 0.5"#,
        &["bond.0.radius_ratio"],
    ),
    (
        r#"young = 1e8
poisson = 0.2
tensile_force = 5"#,
        &["bond.0.tensile_force", "kind = \"contact\""],
    ),
    (
        r#"kind = "contact"
modulus = 1e8
stiffness_ratio = 2
tensile_force = 5
shear_strength = 1e5"#,
        &["bond.0.tensile_force", "not both"],
    ),
    (
        r#"young = 1e8
poisson = 0.2
deviation = 0.2"#,
        &["bond.0.deviation", "have no strength"],
    ),
    (
        r#"young = 1e8
poisson = 0.2
tensile_strength = 1e5
deviation = 0.2
weibull_modulus = 3"#,
        &["bond.0.deviation", "weibull_modulus"],
    ),
    (
        r#"young = 1e8
poisson = 0.2
tensile_strength = 1e5
seed = 3"#,
        &["bond.0.seed", "nothing is drawn"],
    ),
    (
        r#"young = 1e8
poisson = 0.2
tensile_strength = 1e5
reference_radius = 0.01"#,
        &["bond.0.reference_radius"],
    ),
    (
        r#"young = 1e8
poisson = 0.2
tensile_strength = 1e5
friction_angle = 0.5"#,
        &["bond.0.friction_angle", "no shear strength"],
    ),
    (
        r#"young = 1e8
poisson = 0.2
tensile_strength = 1e5
shear_strength = 1e5
strength_ratio = 2"#,
        &["strength_ratio", "only one"],
    ),
    (
        r#"young = 1e8
poisson = 0.2
at = -1"#,
        &["bond.0.at = -1 s"],
    ),
    (
        r#"young = 1e8
poisson = 0.2
clusters = "different""#,
        &["of two clusters", "within a gap of"],
    ),
];

const NORMAL_LAWS: &[Change] = &[
    wrong(
        "restitution = 0.5",
        "restitution = 1.5",
        &["s.toml:15:15", "contact.0.restitution = 1.5", "0 to 1"],
    ),
    wrong("restitution = 0.5", "restitution = 0.5\nlaw = \"hook\"", &["did you mean 'hooke'?"]),
    wrong(
        "restitution = 0.5",
        "restitution = 0.5\nlaw = \"hooke\"",
        &["stiffness or characteristic_velocity or contact_modulus or effective_modulus is missing"],
    ),
    wrong(
        "restitution = 0.5",
        "restitution = 0.5\nlaw = \"hooke\"\nstiffness = 1e5\nnormal_damping = 1",
        &["contact.0.normal_damping", "both say what the dashpot is"],
    ),
    wrong(
        "restitution = 0.5",
        "restitution = 0.5\nlaw = \"hooke\"\nstiffness = 1e5\ncontact_modulus = 1e6",
        &["stiffness and contact_modulus", "only one of them"],
    ),
    wrong(
        "restitution = 0.5",
        "restitution = 0.5\nlaw = \"hooke\"\ncontact_modulus = 1e6\ntangential_stiffness = 1e5",
        &["contact.0.tangential_stiffness", "give tangential_ratio"],
    ),
    wrong(
        "restitution = 0.5",
        "restitution = 0.5\ncontact_modulus = 1e6",
        &["contact.0.contact_modulus", "law = \"hooke\""],
    ),
    wrong("restitution = 0.5", "normal_damping = 1", &["contact.0.normal_damping", "law = \"hooke\""]),
    wrong("restitution = 0.5", "restitution = 0.5\nstiffness = 1e5", &["contact.0.stiffness", "hertz"]),
    wrong("restitution = 0.5", "restitution = 0.5\nlaw = \"jkr\"", &["work_of_adhesion", "J/m²"]),
    wrong(
        "restitution = 0.5",
        "restitution = 0.5\nwork_of_adhesion = 0.1",
        &["contact.0.work_of_adhesion", "add law = \"jkr\""],
    ),
];

const COHESION: &[Change] = &[
    wrong("restitution = 0.5", "restitution = 0.5\ncohesion = \"sjk\"", &["did you mean 'sjkr'?"]),
    wrong(
        "restitution = 0.5",
        "restitution = 0.5\ncohesion = \"sjkr\"",
        &["contact.0.cohesion", "add cohesion_energy_density", "J/m³"],
    ),
    wrong(
        "restitution = 0.5",
        "restitution = 0.5\ncohesion_energy_density = 1e3",
        &["contact.0.cohesion_energy_density", "add cohesion = \"sjkr\""],
    ),
    wrong(
        "restitution = 0.5",
        "restitution = 0.5\ncohesion = \"sjkr\"\ncohesion_energy_density = 1e7",
        &["cohesion_energy_density: 10000000 J/m³", "guards.overlap"],
    ),
    wrong(
        "restitution = 0.5",
        "restitution = 0.5\nlaw = \"jkr\"\nwork_of_adhesion = 1\ncohesion = \"sjkr\"\ncohesion_energy_density = 1",
        &["contact.0.cohesion", "adheres by itself"],
    ),
];

const FRICTION: &[Change] = &[
    wrong(
        "sliding_friction = 0.5",
        "sliding_friction = { static = 0.2, dynamic = 0.5, speed = 1 }",
        &["contact.0.sliding_friction.dynamic = 0.5", "static = 0.2", "swap them"],
    ),
    wrong(
        "sliding_friction = 0.5",
        "sliding_friction = { static = 0.5, dinamic = 0.4, speed = 1 }",
        &["s.toml:16", "did you mean 'dynamic'?"],
    ),
    wrong(
        "sliding_friction = 0.5",
        "sliding_friction = { static = 0.5, dynamic = 0.4, speed = 0 }",
        &["contact.0.sliding_friction.speed = 0 m/s"],
    ),
    wrong("sliding_friction = 0.5", "sliding_friction = \"rough\"", &["a number, such as 0.5, or {"]),
    wrong(
        "sliding_friction = 0.5",
        "rolling_resistance = 0.1",
        &["s.toml:16:22: contact.0.rolling_resistance = 0.1", "add sliding_friction"],
    ),
    wrong(
        "sliding_friction = 0.5",
        "sliding_friction = 0\ntwisting_resistance = 0.2",
        &["contact.0.twisting_resistance = 0.2", "take twisting_resistance out"],
    ),
    wrong(
        "[[fill]]",
        "[[contact]]\nbetween = [\"sinter\", \"sinter\"]\nrestitution = 0.5\nrolling_resistance = 0.1\n[[fill]]",
        &["contact.1.rolling_resistance = 0.1", "add sliding_friction"],
    ),
    wrong("restitution = 0.5", "restitution = 0.5\nrolling_model = \"spring\"", &["add rolling_resistance"]),
    wrong("restitution = 0.5", "restitution = 0.5\nrolling_model = \"sprung\"", &["did you mean 'spring'?"]),
    wrong("restitution = 0.5", "restitution = 0.5\ntwisting_resistence = 1", &["'twisting_resistance'"]),
];

const WALLS: &[Change] = &[
    wrong(
        "[[wall]]",
        "[[wall]]\nname = \"again\"\nplane = \"3,4,-0.01,0,0,2\"\nmaterial = \"sinter\"\n[[wall]]",
        &["s.toml:26:1: wall 'floor': is the same surface as wall 'again'", "take one of them out"],
    ),
    wrong(
        "plane = \"0,0,-0.01,0,0,1\"",
        "box = [0, 0, -0.01, 1, 1, 1]\nfaces = [\"x-\", \"z-\", \"x-\"]",
        &["wall.0.faces.2 = \"x-\"", "is in the list twice"],
    ),
    wrong("material = \"steel\"\n", "", &["wall.0", "material is missing"]),
    wrong("plane = \"0,0,-0.01,0,0,1\"", "mesh = \"no.ply\"", &["no.ply: cannot read the file"]),
    wrong("plane = \"0,0,-0.01,0,0,1\"", "source = \"no.mcap\"", &["no.mcap: cannot read the file"]),
    wrong("plane = \"0,0,-0.01,0,0,1\"\n", "", &["waits for walls of the command line"]),
    wrong("0,0,-0.01,0,0,1", "0,0,-0.01,0,0,0", &["wall.0.plane", "no length"]),
    wrong(
        "name = \"floor\"",
        "motion = {}",
        &["s.toml:23:10: wall.0.motion", "add rotate, swing, translate, vibrate or path"],
    ),
    wrong(
        "name = \"floor\"",
        "motion = { rotate = { about = [0,0,0], through = [0,0,0], rpm = 1 } }",
        &["no direction"],
    ),
    wrong(
        "name = \"floor\"",
        "motion = { translate = [0,0,1], from = 2, until = 1 }",
        &["wall.0.motion.until = 1 s", "not after"],
    ),
    wrong(
        "name = \"floor\"",
        "servo = { direction = [0,0,1], force = -10, speed_limit = 1 }",
        &["wall.0.servo.force = -10 N", "turn the direction round"],
    ),
    wrong(
        "name = \"floor\"",
        "servo = { direction = [0,0,1], stress = 10, speed_limit = 1 }",
        &["wall.0.servo.area", "stress and area"],
    ),
    wrong(
        "name = \"floor\"",
        "servo = { direction = [0,0,1], force = 10, stress = 1, area = 1, speed_limit = 1 }",
        &["force and stress", "only one"],
    ),
    wrong(
        "name = \"floor\"",
        "spring = { direction = [0,0,1], stiffness = 10, mass = 0, speed_limit = 1 }",
        &["wall.0.spring.mass = 0 kg", "above 0"],
    ),
    wrong(
        "name = \"floor\"",
        "spring = { direction = [0,0,1], stiffness = 1e3, mass = 1, speed_limit = 1 }\nservo = { direction = [0,0,1], force = 10, speed_limit = 1 }",
        &["wall.0.spring", "take one of them out"],
    ),
    wrong(
        "name = \"floor\"",
        "servo = { direction = [0,0,1], force = 10, area = 1, speed_limit = 1 }",
        &["wall.0.servo.area", "a force needs no area"],
    ),
    wrong(
        "name = \"floor\"",
        "servo = { direction = [0,0,1], stress = 10, area = 1, area_between = [1, 1], speed_limit = 1 }",
        &["wall.0.servo.area", "take one of them out"],
    ),
    wrong(
        "name = \"floor\"",
        "servo = { direction = [0,0,1], stress = 10, area_between = [[\"left\", \"floor\"], 1], speed_limit = 1 }\nname = \"floor\"",
        &["wall.0.servo.area_between = \"left\"", "is no wall of this scene", "\"floor\""],
    ),
    wrong(
        "name = \"floor\"",
        "servo = { direction = [0,0,1], stress = 10, area_between = [\"floor\", 1], speed_limit = 1 }",
        &["the names of two walls"],
    ),
    wrong(
        "name = \"floor\"",
        "servo = { direction = [0,0,1], path = { source = \"no.csv\" }, speed_limit = 1 }",
        &["no.csv: cannot read the file"],
    ),
    wrong(
        "name = \"floor\"",
        "servo = { direction = [0,0,-1], force = 1, speed_limit = 1 }",
        &["wall.0.servo.direction = [0, 0, -1]", "to the side of the grains", "give [0, 0, 1]"],
    ),
];

const PLANES_AND_FLUIDS: &[Change] = &[
    wrong(
        "[[wall]]",
        "[[outlet]]\nplane = \"0,0,-1,0,0,-1\"\nlength = 0.01\n[[wall]]",
        &["outlet.0.length = 0.01 m", "largest diameter"],
    ),
    wrong(
        "[[wall]]",
        "[[inlet]]\nplane = \"0,0,-1,0,0,-1\"\n[[wall]]",
        &["waits for an inlet of the command line"],
    ),
    wrong(
        "[[fill]]",
        "[drag]\nlaw = \"schiller-naumann\"\nviscosity = 1e-3\n[[fill]]",
        &["drag.density", "1000 for water"],
    ),
    wrong("[[fill]]", "[drag]\nlaw = \"stoke\"\nviscosity = 1e-3\n[[fill]]", &["did you mean 'stokes'?"]),
];

/// The message for a changed scene.
fn refused(&Change { from, to, .. }: &Change) -> String {
    let folder = tempdir().unwrap();
    assert!(SCENE.contains(from), "{from}");
    fs::write(folder.path().join("s.toml"), SCENE.replacen(from, to, 1)).unwrap();
    let done = tool(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
    assert_eq!(done.code, 1, "{to}: {}", done.stderr);
    assert_eq!(done.stderr.lines().count(), 1, "{}", done.stderr);
    assert!(!folder.path().join("run.mcap").exists());
    done.stderr
}

#[test]
fn wrong_scenes_say_where_what_and_what_to_do() {
    let subjects = [
        KEYS_TIME_AND_GRAVITY,
        MATERIALS_AND_FILLS,
        PAIRS_OF_CONTACTS_AND_BONDS,
        NORMAL_LAWS,
        COHESION,
        FRICTION,
        WALLS,
        PLANES_AND_FLUIDS,
    ];
    for change in subjects.into_iter().flatten() {
        let message = refused(change);
        for part in change.parts {
            assert!(message.contains(part), "{}: wanted '{part}' in: {message}", change.to);
        }
    }
}

#[test]
fn bonds_that_cannot_be_made_are_refused() {
    let folder = tempdir().expect("a folder");
    let head = "[[bond]]\nbetween = [\"sinter\", \"sinter\"]\ngap = 1e-3\n";
    for (keys, parts) in BONDS {
        fs::write(folder.path().join("s.toml"), format!("{SCENE}\n{head}{keys}\n")).expect("written");
        let done = tool(folder.path(), "dem-run", &["s.toml", "--check"]);
        assert!(done.code != 0, "{keys}: {}", done.stderr);
        parts
            .iter()
            .for_each(|part| assert!(done.stderr.contains(part), "{keys}: '{part}': {}", done.stderr));
    }
}

/// Every pair of materials has a law: too many are refused before that takes all memory.
#[test]
fn too_many_materials() {
    let folder = tempdir().unwrap();
    let one = |k: u32| format!("[[material]]\nname = \"m{k}\"\nyoung = 1e7\npoisson = 0.2\n");
    let many: String = (0..1001).map(one).collect();
    let scene = format!("{many}[[contact]]\nbetween = [\"*\", \"*\"]\nrestitution = 0.5\n");
    fs::write(folder.path().join("s.toml"), scene).unwrap();
    let done = tool(folder.path(), "dem-run", &["s.toml", "--check"]);
    assert_eq!(done.code, 1, "{}", done.stderr);
    assert!(
        done.stderr.contains("material.1000.name = \"m1000\"") && done.stderr.contains("1001 materials"),
        "{}",
        done.stderr
    );
}
