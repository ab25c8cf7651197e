//! Scenes that are refused, or read, as the page on scenes says: with place, value and a cure that works.

use scene::{Scene, SceneSetupError};
use std::path::Path;

const BASE: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 1
[[material]]
name = "sand"
density = 2600
young = 1e7
poisson = 0.25
[[contact]]
between = ["*", "*"]
restitution = 0.5
[[clump]]
name = "pair"
material = "sand"
spheres = [[0, 0, 0, 0.01], [0.01, 0, 0, 0.01]]
[[fill]]
material = "sand"
shape = "box:0,0,0,0.2,0.2,0.2"
diameter = 0.02
count = 5
[[wall]]
name = "floor"
material = "sand"
plane = "0,0,-0.01,0,0,1"
"#;

fn read(toml: &str, overrides: &[&str]) -> Result<Scene, String> {
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    Scene::new("s.toml", toml.to_owned(), &overrides, Path::new("nowhere")).map_err(|e| e.to_string())
}

/// The message for the scene with one part of it changed, from reading, planning or the engine.
fn message(from: &str, to: &str) -> String {
    assert!(BASE.contains(from), "{from}");
    let scene = match read(&BASE.replacen(from, to, 1), &[]) {
        Ok(scene) => scene,
        Err(message) => return message,
    };
    let setup = match scene.plan(Vec::new()) {
        Ok(plan) => plan.setup,
        Err(error) => return error.to_string(),
    };
    let error = dem::Simulation::new(setup).err().map(SceneSetupError::from);
    error.map_or(String::new(), |error| format!("{}: {error}", scene.place_of(&error)))
}

#[track_caller]
fn refused(from: &str, to: &str, parts: &[&str]) {
    let message = message(from, to);
    parts.iter().for_each(|part| assert!(message.contains(part), "'{part}' is not in: {message}"));
}

#[track_caller]
fn accepted(from: &str, to: &str) {
    assert_eq!(message(from, to), "", "{to}");
}

const RESTITUTION: &str = "restitution = 0.5";
const COUNT: &str = "count = 5";
const FLOOR: &str = "plane = \"0,0,-0.01,0,0,1\"";

#[test]
fn keys_that_nothing_uses_are_refused_and_their_cures_work() {
    let linear = "restitution = 0.5\nlaw = \"hooke\"\nstiffness = 1e4\n";
    for key in ["tangential_ratio = 0.4", "tangential_stiffness = 4e3"] {
        let name = key.split(' ').next().unwrap();
        let wanted = [&format!("s.toml:14:{}", name.len() + 4), name, "add sliding_friction = 0.5, or take"];
        refused(RESTITUTION, &format!("{linear}{key}"), &wanted.map(|text: &str| text));
        accepted(RESTITUTION, &format!("{linear}{key}\nsliding_friction = 0.5"));
        // A sweep may begin without friction.
        accepted(RESTITUTION, &format!("{linear}{key}\nsliding_friction = 0"));
    }
    let clump = "clump = \"pair\"\nshape = \"box:0,0,0,0.2,0.2,0.2\"\ncount = 3";
    let grains = "material = \"sand\"\nshape = \"box:0,0,0,0.2,0.2,0.2\"\ndiameter = 0.02\ncount = 5";
    refused(
        grains,
        &format!("{clump}\nby = \"number\""),
        &["s.toml:20:6: fill.0.by", "only shares of sizes"],
    );
    accepted(grains, clump);
    let outlet = format!("{FLOOR}\n[[outlet]]\nplane = \"0,0,0.05,0,0,-1\"\nsamples = 1e-3");
    refused(FLOOR, &outlet, &["outlet.0.samples = 0.001 s", "\"constant\" records none", "\"recorded\""]);
    accepted(FLOOR, &format!("{outlet}\nmotion = \"recorded\""));
}

#[test]
fn walls_and_faces_have_names_of_their_own() {
    let more = |wall: &str| format!("{FLOOR}\n[[wall]]\nmaterial = \"sand\"\n{wall}\n");
    let lid = "plane = \"0,0,3,0,0,-1\"";
    let parts = ["s.toml:25:8: wall.1.name = \"floor\"", "is a name of wall.0 (s.toml:22:8), too"];
    let first = BASE.replace("name = \"floor\"\n", "");
    refused(FLOOR, &more(&format!("name = \"floor\"\n{lid}")), &["wall.1.name = \"floor\"", parts[1]]);
    accepted(FLOOR, &more(&format!("name = \"lid\"\n{lid}")));
    let cup = "box = [-1, -1, -1, 2, 2, 2]\nfaces = [\"x-\", \"z+\"]";
    let face = format!("name = \"cup z+\"\n{lid}\n[[wall]]\nmaterial = \"sand\"\nname = \"cup\"\n{cup}");
    refused(
        FLOOR,
        &more(&face),
        &["wall.2.name = \"cup\"", "gives a face the name \"cup z+\", which wall.1"],
    );
    refused(
        FLOOR,
        &more("name = \"again\"\nplane = \"3,4,-0.01,0,0,2\""),
        &["s.toml:25:1: wall 'again': is the same surface as wall 'floor'", "take one of them out"],
    );
    // The name of a wall without one is its place in the list.
    let named = first.replace(FLOOR, &more(&format!("name = \"wall.0\"\n{lid}")));
    assert!(read(&named, &[]).unwrap_err().contains("is a name of wall.0"));
}

#[test]
fn a_motion_that_began_before_the_run_prints_a_warning() {
    let moved = |from: &str| {
        let toml = BASE.replace(
            FLOOR,
            &format!("{FLOOR}\nmotion = {{ translate = [0, 0, -1], from = {from}, until = 0.1 }}"),
        );
        read(&toml, &[]).unwrap().plan(Vec::new()).unwrap().warnings.join("\n")
    };
    assert!(
        moved("-0.5").contains("wall.0.motion.from = -0.5 s: the motion began before the run"),
        "{}",
        moved("-0.5")
    );
    assert!(!moved("0").contains("motion.from"));
}

#[test]
fn whole_numbers_may_be_written_as_any_number() {
    let seed = |seed: &str| {
        read(&BASE.replace(COUNT, &format!("count = 5e0\nseed = {seed}")), &[]).map(|s| s.keys.fill[0].seed)
    };
    assert_eq!(seed("1e2"), Ok(100));
    assert_eq!(seed("100.0"), Ok(100));
    assert_eq!(seed("18446744073709551615"), Ok(u64::MAX));
    for (text, shown) in [
        ("2.5", "number '2.5'"),
        ("-1", "number '-1'"),
        ("1e20", "number '1e20'"),
        ("nan", "number 'NaN'"),
        ("99999999999999999999999", "number '99999999999999999999999'"),
    ] {
        let message = seed(text).unwrap_err();
        let wanted = format!("{shown}, expected a whole number from 0 to 18446744073709551615");
        assert!(message.ends_with(&wanted), "{message}");
    }
    let first = |id: &str| read(&format!("first_id = {id}\n{BASE}"), &[]).map(|s| s.keys.first_id);
    assert_eq!(first("4e9"), Ok(4_000_000_000));
    assert!(
        first("4000000001")
            .unwrap_err()
            .contains("first_id = 4000000001: is outside the range; give 0 to 4e9")
    );
    // Whole numbers of any size are numbers.
    assert_eq!(
        read(&BASE.replace("young = 1e7", "young = 10000000000000000000"), &[]).unwrap().keys.material[0]
            .young,
        1e19
    );
}

#[test]
fn overrides_reach_lists_in_lists_and_are_named_as_they_were_given() {
    let scene = read(BASE, &["clump.0.spheres.1.3=0.02"]).unwrap();
    assert_eq!(scene.keys.clump[0].spheres.as_ref().unwrap()[1][3], 0.02);
    let why = |set: &str| read(BASE, &[set]).unwrap_err();
    assert!(why("clump.0.spheres.1.4=0.02").ends_with("'spheres.1' has 4 entries, no 4"));
    assert!(why("clump.0.spheres.1.x=0.02").ends_with("'spheres.1' is not a table that could hold 'x'"));
    assert!(
        why("clump.0.spheres.1.3.0=0.02").ends_with("'spheres.1.3' is not a list that could hold entry 0")
    );
    assert!(why("--until=nan").starts_with("s.toml with --until=nan: time.until = NaN s"));
    assert!(why("time.until=-1").starts_with("s.toml with --set time.until=-1: time.until = -1 s"));
    assert_eq!(read(BASE, &["--until=0.5"]).unwrap().keys.time.until, Some(0.5));
}

#[test]
fn ranges_say_what_may_be_given() {
    refused(
        "density = 2600",
        "density = 1e31",
        &["material.0.density = 1e31 kg/m³", "give a number above 0, up to 1e30 kg/m³"],
    );
    let guard = |overlap: &str| format!("{FLOOR}\n[guards]\noverlap = {overlap}");
    refused(FLOOR, &guard("2"), &["s.toml:26:11: guards.overlap = 2", "give a number above 0, up to 1"]);
    accepted(FLOOR, &guard("1"));
    let rows = scene::keys::rows();
    let of = |key: &str| rows.iter().find(|row| row.0 == key).map(|row| row.1.range.clone()).unwrap();
    assert_eq!(of("contact.restitution"), "0 to 1 (above 0, up to 1 with \"walton_braun\")");
}

#[test]
fn an_angle_of_friction_and_a_deviation_of_zero_ask_for_nothing() {
    let bond = |key: &str| {
        let bond = "[[bond]]\nbetween = [\"sand\", \"sand\"]\ngap = 1\nclusters = \"any\"\nyoung = 1e7\npoisson = 0.2";
        format!("{FLOOR}\n{bond}\n{key}")
    };
    for key in ["friction_angle = 0", "deviation = 0"] {
        accepted(FLOOR, &bond(key));
    }
    refused(FLOOR, &bond("friction_angle = 0.5"), &["bond.0.friction_angle = 0.5 rad"]);
    refused(FLOOR, &bond("deviation = 0.5"), &["bond.0.deviation"]);
}

/// A cure names each law once, and is a scene that is read; units stand where TOML has no place for them.
#[test]
fn cures_of_contacts_are_said_once_and_work() {
    let across = "restitution = 0.5\nsliding_friction = 0.5\ntangential_ratio = 0.3";
    refused(
        RESTITUTION,
        across,
        &[
            "add law = \"hooke\" and stiffness = 1e5 (in N/m), or law = \"walton_braun\" and stiffness = 1e5 (in N/m), or take",
        ],
    );
    accepted(RESTITUTION, &format!("{across}\nlaw = \"hooke\"\nstiffness = 1e5"));
    accepted(RESTITUTION, &format!("{across}\nlaw = \"walton_braun\"\nstiffness = 1e5"));
    let speed = "restitution = 0.5\ncharacteristic_velocity = 1";
    refused(RESTITUTION, speed, &["or use law = \"hooke\" or law = \"walton_braun\""]);
    accepted(RESTITUTION, &format!("{speed}\nlaw = \"hooke\""));
}

#[test]
fn examples_are_of_the_very_key() {
    let wall = |key: &str| format!("{FLOOR}\n{key}");
    for (from, to, part) in [
        (FLOOR, wall("servo = 3"), "expected a table, such as { direction = [0, 0, -1], speed_limit = 0.1 }"),
        (FLOOR, wall("motion = { path = \"a\" }"), "expected a table, such as { source = \"path.csv\" }"),
        (FLOOR, wall("[domain]\nstrain = 3"), "expected a table, such as { x = { rate = 0.05 } }"),
        (
            FLOOR,
            wall("[domain]\nperiodic = 3"),
            "expected a list of \"x\", \"y\", \"z\", such as [\"x\", \"y\"]",
        ),
        (
            "gravity = [0, 0, -9.81]",
            "gravity = [1, 2, 3, 4, 5]".into(),
            "wrong number of values: 5, expected a list of 3 numbers [m/s²], such as [0, 0, -9.81]",
        ),
        (
            "gravity = [0, 0, -9.81]",
            "insert = 3".into(),
            "expected tables: write each below a line [[insert]]",
        ),
        ("[\"*\", \"*\"]", "\"sand\"".into(), "expected a list of text, such as [\"*\", \"*\"]"),
    ] {
        refused(from, &to, &[part]);
    }
}

#[test]
fn files_and_numbers_that_are_refused_later_have_their_place() {
    let grains =
        "[[fill]]\nmaterial = \"sand\"\nshape = \"box:0,0,0,0.2,0.2,0.2\"\ndiameter = 0.02\ncount = 5";
    for (from, to, part) in [
        (
            grains,
            "[[particles]]\nsource = \"no.csv\"".to_owned(),
            "s.toml:17:10: particles.0.source: nowhere/no.csv: cannot read the file",
        ),
        ("diameter = 0.02", "sizes = \"no.csv\"".to_owned(), "s.toml:19:9: fill.0.sizes: nowhere/no.csv"),
        (FLOOR, "mesh = \"no.stl\"".to_owned(), "s.toml:24:8: wall.0.mesh: nowhere/no.stl"),
        (
            FLOOR,
            format!("{FLOOR}\nmotion = {{ path = {{ source = \"no.csv\" }} }}"),
            "s.toml:25:30: wall.0.motion.path.source",
        ),
        (
            FLOOR,
            format!("{FLOOR}\n[domain]\nsource = \"no.mcap\"\nperiodic = [\"x\"]"),
            "s.toml:26:10: domain.source",
        ),
        (
            "until = 1",
            "until = 1\ndt = 0.1".to_owned(),
            "s.toml:4:6: time.dt: 1.0000e-1 s is above the critical step",
        ),
        (
            RESTITUTION,
            "restitution = 0.5\nlaw = \"jkr\"\nwork_of_adhesion = 1e9".to_owned(),
            "s.toml:13:20: contact",
        ),
        (
            FLOOR,
            format!("{FLOOR}\nservo = {{ direction = [0, 0, -1], force = 1, speed_limit = 1 }}"),
            "s.toml:25:23: wall.0.servo.direction = [0, 0, -1]: does not push to the side of the grains",
        ),
        (
            FLOOR,
            format!("{FLOOR}\nservo = {{ direction = [1e-300, 0, 0], force = 1, speed_limit = 1 }}"),
            "is too short to give a direction",
        ),
        (
            FLOOR,
            format!(
                "{FLOOR}\n[[bond]]\nbetween = [\"sand\", \"sand\"]\ngap = 1e-9\nyoung = 1e7\npoisson = 0.2"
            ),
            "s.toml:27:7: bond sand–sand",
        ),
    ] {
        refused(from, &to, &[part]);
    }
}

#[test]
fn what_was_read_in_part_is_refused() {
    let domain =
        |axes: &str| format!("{FLOOR}\n[domain]\nperiodic = {axes}\nlow = [-1, -1, -1]\nhigh = [1, 1, 1]");
    refused(
        FLOOR,
        &domain("[\"x\", \"x\", \"y\"]"),
        &["s.toml:26:18: domain.periodic.1 = \"x\": is in the list twice"],
    );
    accepted(FLOOR, &domain("[\"x\", \"y\"]"));
    refused(
        FLOOR,
        "mesh = \"a.stl\"\nunits = \"\"",
        &["wall.0.units = \"\": is no unit of length; write \"µm\", \"mm\""],
    );
    let body = |q: &str| {
        format!("{FLOOR}\n[[body]]\nclump = \"pair\"\nposition = [0.5, 0.5, 0.5]\nquaternion = {q}")
    };
    refused(
        FLOOR,
        &body("[2, 0, 0, 2]"),
        &["body.0.quaternion = [2, 0, 0, 2]: has the length 2.82843", "give [0.707107, 0, 0, 0.707107]"],
    );
    refused(FLOOR, &body("[0, 0, 0, 0]"), &["has the length 0", "[1, 0, 0, 0]"]);
    accepted(FLOOR, &body("[0.707107, 0, 0, 0.707107]"));
    accepted(FLOOR, &body("[0.707, 0.707, 0, 0]"));
    let spheres = "spheres = [[0, 0, 0, 0.01], [0.01, 0, 0, 0.01]]";
    let moments = |inertia: &str| {
        format!("{spheres}\nmoments = {{ volume = 1e-6, centre = [0, 0, 0], inertia = {inertia} }}")
    };
    refused(
        spheres,
        &moments("[1e-11, 1e-11, 1e-10, 0, 0, 0]"),
        &["the principal ones are 1e-11, 1e-11 and 1e-10 m⁵, and the last is not below the sum"],
    );
    refused(
        spheres,
        &moments("[0, 0, 0, 0, 0, 0]"),
        &["the principal ones are 0, 0 and 0 m⁵, and the first is not above 0"],
    );
}
