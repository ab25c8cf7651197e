//! Scenes: what is refused and what is warned of, with place, value, unit and cure, and what `--explain` says.

mod doubtful;
mod mixtures;
mod refused;
mod units;

use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{succeed, tool};
use record::{MaterialRecord, POISSON};
use scene::Scene;
use std::fs;
use std::path::Path;
use tempfile::tempdir;
use wall::attributes::check_material;

const SCENE: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 0.01
[[material]]
name = "sinter"
density = 3300
young = 5e6
poisson = 0.25
[[material]]
name = "steel"
young = 2e8
poisson = 0.3
[[contact]]
between = ["sinter", "*"]
restitution = 0.5
sliding_friction = 0.5
[[fill]]
material = "sinter"
shape = "box:0,0,0,0.1,0.1,0.1"
diameter = [0.01, 0.02]
count = 5
[[wall]]
name = "floor"
plane = "0,0,-0.01,0,0,1"
material = "steel"
"#;

/// Materials and bonds of a scene, walls, streams and the engine take the same Poisson's ratios, with the same words.
#[test]
fn poissons_ratio_has_one_range() {
    let bond = "[[bond]]\nbetween = [\"sinter\", \"sinter\"]\ngap = 1e-4\nyoung = 1e7\npoisson = 0.25\n";
    let toml = format!("{SCENE}{bond}");
    let keys = [
        ("material.0.poisson", "name = \"sinter\"\ndensity = 3300\nyoung = 5e6\npoisson = 0.25"),
        ("bond.0.poisson", bond),
    ];
    for (ratio, fits) in
        [(-1.0, false), (-0.2, true), (0.0, true), (0.5, true), (0.51, false), (f64::NAN, false)]
    {
        for (key, text) in keys {
            let changed =
                text.replace("poisson = 0.25", &format!("poisson = {}", ratio.to_string().to_lowercase()));
            let scene = Scene::new("s.toml", toml.replace(text, &changed), &[], Path::new(""));
            let words = scene.map_err(|e| e.to_string()).err().unwrap_or_default();
            assert!(
                fits == words.is_empty() && (fits || words.contains(key) && words.contains(POISSON)),
                "{words}"
            );
        }
        let material = MaterialRecord { name: "m".into(), poisson: Some(ratio), ..MaterialRecord::default() };
        let words = check_material(&material, "here").map_err(|e| e.to_string()).err().unwrap_or_default();
        assert!(fits == words.is_empty() && (fits || words.contains(POISSON)), "{words}");
        let mut setup =
            Scene::new("s.toml", toml.clone(), &[], Path::new("")).unwrap().plan(Vec::new()).unwrap().setup;
        setup.bonds.clear();
        setup.materials[0].poisson = ratio;
        assert_eq!(dem::Simulation::new(setup).is_ok(), fits, "the engine, {ratio}");
    }
}

#[test]
fn overrides_change_one_key_and_wrong_ones_are_refused() {
    let folder = folder(&[("s.toml", SCENE)]);
    let check = |set: &str| tool(folder.path(), "dem-run", &["s.toml", "--check", "--set", set]);
    assert_eq!(check("contact.0.restitution=0.3").code, 0);
    assert_eq!(check("time.dt=1e-6").code, 0);
    assert_eq!(check("contact.0.law=hertz").code, 0);
    for (set, code, part) in [
        ("time.dt", 2, "'=' is missing"),
        ("=1", 2, "a part of the key is empty"),
        ("contact.4.restitution=1", 2, "'contact' has entries 0 to 0, no 4"),
        ("contact.0.restitutio=1", 1, "did you mean 'restitution'?"),
        ("fill.0.diameter.9=1", 2, "no 9"),
        (
            "material.0.young=1",
            1,
            "material 'sinter' has young = 1 Pa, which makes the step so long: give it in Pa (1 MPa is 1e6",
        ),
        (
            "contact.0.restitution=7",
            1,
            "s.toml with --set contact.0.restitution=7: contact.0.restitution = 7",
        ),
        ("time=3", 1, "s.toml with --set time=3: wrong kind of value: integer '3', expected a table"),
    ] {
        let done = check(set);
        assert!(done.code == code && done.stderr.contains(part), "{set}: {}", done.stderr);
    }
}

#[test]
fn explain_names_effects_their_bytes_and_the_limiting_pair() {
    let folder = folder(&[("s.toml", SCENE)]);
    let text =
        |arguments: &[&str]| String::from_utf8(succeed(folder.path(), "dem-run", arguments).stdout).unwrap();
    let with = text(&["s.toml", "--explain"]);
    for part in [
        "limited by     sinter",
        "24",
        "contact.0.sliding_friction = 0.5 (sinter–sinter, sinter–steel)",
        "gravity",
    ] {
        assert!(with.contains(part), "'{part}' in {with}");
    }
    let without = text(&["s.toml", "--explain", "--set", "contact.0.sliding_friction=0"]);
    assert!(
        without.lines().all(|l| !l.starts_with("sliding_friction")) && without.contains("hertz"),
        "{without}"
    );
    assert!(
        without.contains("dropped        contact.0.sliding_friction = 0 (sinter–sinter, sinter–steel)"),
        "{without}"
    );
}

/// [`SCENE`] with the particles of `p.csv` instead of the fill.
fn with_particles_of_a_file() -> String {
    let fill = "shape = \"box:0,0,0,0.1,0.1,0.1\"\ndiameter = [0.01, 0.02]\ncount = 5";
    SCENE.replace(fill, "source = \"p.csv\"").replace("[[fill]]", "[[particles]]")
}

#[test]
fn particles_come_from_csv_and_walls_name_their_own_material() {
    let folder = folder(&[("p.csv", "id,x,y,z,radius\n7,0,0,0.1,0.01\n9,0.05,0,0.1,0.01\n")]);
    fs::write(folder.path().join("s.toml"), with_particles_of_a_file()).unwrap();
    let done = succeed(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
    assert!(done.stderr.contains("2 particles"), "{}", done.stderr);
    fs::write(folder.path().join("p.csv"), "id,x,y,z,radius\n7,0,0,0.1,0.01\n7,0.05,0,0.1,0.01\n").unwrap();
    let done = tool(folder.path(), "dem-run", &["s.toml", "-o", "run2.mcap"]);
    assert!(done.code == 1 && done.stderr.contains("id 7 is used twice"), "{}", done.stderr);
}

/// Every effect of contact: its key reaches the engine, and `--explain` says what it takes.
#[test]
fn explain_names_every_effect_of_contact_with_its_bytes() {
    let folder = tempdir().unwrap();
    let cases: &[(&str, &[(&str, &str)])] = &[
        ("law = \"jkr\"\nwork_of_adhesion = 0.1", &[("jkr", "8"), ("sliding_friction", "24")]),
        ("cohesion = \"sjkr\"\ncohesion_energy_density = 1e3", &[("hertz", "0"), ("cohesion", "0")]),
        ("rolling_resistance = 0.1", &[("rolling_resistance", "24")]),
        ("rolling_resistance = 0.1\nrolling_model = \"constant\"", &[("constant rolling", "24")]),
        ("twisting_resistance = 0.1", &[("twisting_resistance", "8")]),
    ];
    for (keys, lines) in cases {
        let scene = SCENE.replacen("restitution = 0.5", &format!("restitution = 0.5\n{keys}"), 1);
        fs::write(folder.path().join("s.toml"), scene).unwrap();
        let done = succeed(folder.path(), "dem-run", &["s.toml", "--explain"]);
        let text = String::from_utf8(done.stdout).unwrap();
        for (effect, bytes) in *lines {
            let found = text.lines().any(|line| line.starts_with(&format!("{effect:22} {bytes:>10}")));
            assert!(found, "{keys}: {effect} with {bytes} bytes in {text}");
        }
        succeed(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
    }
    let table =
        SCENE.replacen("= 0.5\n[[fill]]", "= { static = 0.5, dynamic = 0.4, speed = 0.1 }\n[[fill]]", 1);
    fs::write(folder.path().join("s.toml"), table).unwrap();
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
}
