//! Scenes that are wrong are refused with place, value, unit and cure, before anything is written.

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

/// The message for the scene with one text replaced by another.
fn refused(from: &str, to: &str) -> String {
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
    let cases: &[(&str, &str, &[&str])] = &[
        ("poisson = 0.25", "poison = 0.25", &["s.toml:8:1", "'poison'", "did you mean 'poisson'?"]),
        ("[[fill]]", "[[fil]]", &["s.toml:17:3", "did you mean 'fill'?"]),
        (
            "restitution = 0.5",
            "restitution = 1.5",
            &["s.toml:15:15", "contact.0.restitution = 1.5", "0 to 1"],
        ),
        ("density = 3300", "density = -1", &["material.0.density = -1 kg/m³", "positive"]),
        ("density = 3300\n", "", &["fill.0.material", "density is missing", "kg/m³"]),
        ("[0.01, 0.02]", "[0.02, 0.01]", &["fill.0.diameter = [0.02, 0.01] m", "[smallest, largest]"]),
        ("[0.01, 0.02]", "[10, 200]", &["5 mm is 0.005"]),
        ("count = 5", "count = 5\nmass = 1", &["fill.0", "mass and count", "only one"]),
        ("count = 5", "count = 500", &["fit without touching", "kg"]),
        ("box:0,0,0,0.1,0.1,0.1", "ball:0", &["fill.0.shape", "sphere:x,y,z,r"]),
        ("\"sinter\", \"*\"", "\"sintr\", \"*\"", &["contact.0.between.0", "did you mean 'sinter'?"]),
        (
            "\"sinter\", \"*\"",
            "\"sinter\", \"sinter\"",
            &["no law between 'sinter' and 'steel'", "[[contact]]"],
        ),
        ("material = \"steel\"\n", "", &["wall.0", "material is missing"]),
        ("plane = \"0,0,-0.01,0,0,1\"", "mesh = \"no.ply\"", &["no.ply: cannot read the file"]),
        ("plane = \"0,0,-0.01,0,0,1\"", "source = \"no.mcap\"", &["no.mcap: cannot read the file"]),
        ("plane = \"0,0,-0.01,0,0,1\"\n", "", &["waits for walls of the command line"]),
        ("0,0,-0.01,0,0,1", "0,0,-0.01,0,0,0", &["wall.0.plane", "no length"]),
        (
            "until = 0.01",
            "until = 0.01\ndt = 1e-6\nsafety = 0.1",
            &["time.safety = 0.1", "dt = 0.000001 s sets the step"],
        ),
        (
            "name = \"floor\"",
            "motion = {}",
            &["s.toml:23:10: wall.0.motion", "add rotate, translate or vibrate"],
        ),
        (
            "name = \"floor\"",
            "servo = { direction = [0,0,1], force = -10, speed_limit = 1 }",
            &["wall.0.servo.force = -10 N", "turn the direction round"],
        ),
        (
            "sliding_friction = 0.5",
            "sliding_friction = { static = 0.2, dynamic = 0.5, speed = 1 }",
            &["contact.0.sliding_friction.dynamic = 0.5", "static = 0.2", "swap them"],
        ),
        (
            "sliding_friction = 0.5",
            "rolling_resistance = 0.1",
            &["s.toml:16:22: contact.0.rolling_resistance = 0.1", "add sliding_friction"],
        ),
        (
            "sliding_friction = 0.5",
            "sliding_friction = 0\ntwisting_resistance = 0.2",
            &["contact.0.twisting_resistance = 0.2", "take twisting_resistance out"],
        ),
        (
            "[[fill]]",
            "[[contact]]\nbetween = [\"sinter\", \"sinter\"]\nrestitution = 0.5\nrolling_resistance = 0.1\n[[fill]]",
            &["contact.1.rolling_resistance = 0.1", "add sliding_friction"],
        ),
        ("[[fill]]", "[sleep]\nspeed = 1e-3\nwake = 1\n[[fill]]", &["sleep.wake = 1", "free fall", "0.1"]),
        ("[time]", "[time]\ndt = 1", &["above the critical step", "sinter"]),
        ("until = 0.01", "", &["time.until", "--until"]),
        ("until = 0.01", "until = 0.01\nsteps = 4", &["unknown key 'steps'"]),
        (
            "[[wall]]",
            "[[bond]]\nstrength = 1\n[[wall]]",
            &["unknown key 'strength'", "did you mean 'shear_strength'"],
        ),
        ("restitution = 0.5", "restitution = 0.5\ncohesion = \"sjk\"", &["did you mean 'sjkr'?"]),
        (
            "restitution = 0.5",
            "restitution = 0.5\ncohesion = \"sjkr\"",
            &["contact.0.cohesion", "add cohesion_energy_density", "J/m³"],
        ),
        (
            "restitution = 0.5",
            "restitution = 0.5\ncohesion_energy_density = 1e3",
            &["contact.0.cohesion_energy_density", "add cohesion = \"sjkr\""],
        ),
        (
            "restitution = 0.5",
            "restitution = 0.5\ncohesion = \"sjkr\"\ncohesion_energy_density = 1e7",
            &["cohesion_energy_density: 10000000 J/m³", "guards.overlap"],
        ),
        ("restitution = 0.5", "restitution = 0.5\nlaw = \"jkr\"", &["work_of_adhesion", "J/m²"]),
        (
            "restitution = 0.5",
            "restitution = 0.5\nwork_of_adhesion = 0.1",
            &["contact.0.work_of_adhesion", "add law = \"jkr\""],
        ),
        (
            "restitution = 0.5",
            "restitution = 0.5\nlaw = \"jkr\"\nwork_of_adhesion = 1\ncohesion = \"sjkr\"\ncohesion_energy_density = 1",
            &["contact.0.cohesion", "adheres by itself"],
        ),
        (
            "sliding_friction = 0.5",
            "sliding_friction = { static = 0.5, dinamic = 0.4, speed = 1 }",
            &["s.toml:16", "did you mean 'dynamic'?"],
        ),
        (
            "sliding_friction = 0.5",
            "sliding_friction = { static = 0.5, dynamic = 0.4, speed = 0 }",
            &["contact.0.sliding_friction.speed = 0 m/s"],
        ),
        ("sliding_friction = 0.5", "sliding_friction = \"rough\"", &["a number, such as 0.5, or {"]),
        ("restitution = 0.5", "restitution = 0.5\nrolling_model = \"spring\"", &["add rolling_resistance"]),
        ("restitution = 0.5", "restitution = 0.5\nrolling_model = \"sprung\"", &["did you mean 'spring'?"]),
        ("restitution = 0.5", "restitution = 0.5\ntwisting_resistence = 1", &["'twisting_resistance'"]),
        ("restitution = 0.5", "restitution = 0.5\nlaw = \"hook\"", &["did you mean 'hooke'?"]),
        (
            "restitution = 0.5",
            "restitution = 0.5\nlaw = \"hooke\"",
            &["stiffness or characteristic_velocity is missing"],
        ),
        ("restitution = 0.5", "restitution = 0.5\nstiffness = 1e5", &["contact.0.stiffness", "hertz"]),
        ("gravity = [0, 0, -9.81]", "gravity = -9.81", &["s.toml:1:11"]),
        (
            "[[wall]]",
            "[[outlet]]\nplane = \"0,0,-1,0,0,-1\"\nlength = 0.01\n[[wall]]",
            &["outlet.0.length = 0.01 m", "largest diameter"],
        ),
        (
            "[[wall]]",
            "[[inlet]]\nplane = \"0,0,-1,0,0,-1\"\n[[wall]]",
            &["waits for an inlet of the command line"],
        ),
        (
            "name = \"floor\"",
            "motion = { rotate = { about = [0,0,0], through = [0,0,0], rpm = 1 } }",
            &["no direction"],
        ),
        (
            "[[wall]]",
            "[[contact]]\nbetween = [\"*\", \"steel\"]\nrestitution = 0.1\n[[wall]]",
            &["contradiction", "sinter and steel"],
        ),
        (
            "[[fill]]",
            "[drag]\nlaw = \"schiller-naumann\"\nviscosity = 1e-3\n[[fill]]",
            &["drag.density", "1000 for water"],
        ),
        ("[[fill]]", "[drag]\nlaw = \"stoke\"\nviscosity = 1e-3\n[[fill]]", &["did you mean 'stokes'?"]),
        (
            "name = \"floor\"",
            "servo = { direction = [0,0,1], stress = 10, speed_limit = 1 }",
            &["wall.0.servo.area", "stress and area"],
        ),
        (
            "name = \"floor\"",
            "servo = { direction = [0,0,1], force = 10, stress = 1, area = 1, speed_limit = 1 }",
            &["force and stress", "only one"],
        ),
        (
            "name = \"floor\"",
            "motion = { translate = [0,0,1], from = 2, until = 1 }",
            &["wall.0.motion.until = 1 s", "not after"],
        ),
        (
            "[[wall]]",
            "[[insert]]\nmaterial = \"sinter\"\nshape = \"box:0,0,-0.2,0.1,0.1,-0.1\"\ndiameter = 0.01\nrate_count = 10\nvelocity = [0,0,-1]\n[[wall]]",
            &["insert.0.shape", "0.19 m behind wall 'floor'", "normal"],
        ),
    ];
    for (from, to, parts) in cases {
        let message = refused(from, to);
        for part in parts.iter().filter(|p| **p != "contradiction") {
            assert!(message.contains(part), "{to}: wanted '{part}' in: {message}");
        }
    }
}

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
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("s.toml"), SCENE).unwrap();
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
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("s.toml"), SCENE).unwrap();
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

#[test]
fn particles_come_from_csv_and_walls_name_their_own_material() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("p.csv"), "id,x,y,z,radius\n7,0,0,0.1,0.01\n9,0.05,0,0.1,0.01\n").unwrap();
    let from_file = SCENE.replace(
        "shape = \"box:0,0,0,0.1,0.1,0.1\"\ndiameter = [0.01, 0.02]\ncount = 5",
        "source = \"p.csv\"",
    );
    fs::write(folder.path().join("s.toml"), from_file.replace("[[fill]]", "[[particles]]")).unwrap();
    let done = succeed(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
    assert!(done.stderr.contains("2 particles"), "{}", done.stderr);
    fs::write(folder.path().join("p.csv"), "id,x,y,z,radius\n7,0,0,0.1,0.01\n7,0.05,0,0.1,0.01\n").unwrap();
    let done = tool(folder.path(), "dem-run", &["s.toml", "-o", "run2.mcap"]);
    assert!(done.code == 1 && done.stderr.contains("id 7 is used twice"), "{}", done.stderr);
}

/// Everyday files of spreadsheets, and warnings of implausible files and numbers.
#[test]
fn doubtful_particles_and_materials_are_told() {
    let folder = tempdir().unwrap();
    let from_file = SCENE.replace(
        "shape = \"box:0,0,0,0.1,0.1,0.1\"\ndiameter = [0.01, 0.02]\ncount = 5",
        "source = \"p.csv\"",
    );
    let from_file = from_file.replace("[[fill]]", "[[particles]]");
    let check = |scene: &str, csv: &str| {
        fs::write(folder.path().join("s.toml"), scene).unwrap();
        fs::write(folder.path().join("p.csv"), csv).unwrap();
        let done = tool(folder.path(), "dem-run", &["s.toml", "--check"]);
        (done.code, done.stderr)
    };
    let one = "x,y,z,radius\n0,0,0.1,0.01\n";
    let told = |scene: &str, csv: &str, code: i32, parts: &[&str]| {
        let (found, said) = check(scene, csv);
        let all = parts.iter().all(|part| said.contains(part));
        assert!(found == code && all, "{csv}: {found}: wanted {parts:?} in: {said}");
        assert_eq!(said.contains("warning"), code == 0 && !parts.is_empty(), "{said}");
    };
    told(&from_file, one, 0, &[]);
    told(&from_file, &format!("\u{feff}{one}"), 0, &[]);
    let (code, said) = check(&from_file, "x,y,z,radius\n");
    assert!(code == 1 && said.contains("p.csv: holds no particle"), "{said}");
    told(&from_file, "X,Y,Z,Radius\n0,0,0.1,0.01\n", 1, &["'X' is there: did you mean 'x'?"]);
    told(&from_file, "x,y,z,radius,VX\n0,0,0.1,0.01,1\n", 0, &["'VX' is not used", "did you mean vx?"]);
    let contradicts = ["row 0: radius 0.01 m and diameter 0.01 m contradict each other"];
    told(&from_file, "x,y,z,radius,diameter\n0,0,0.1,0.01,0.01\n", 1, &contradicts);
    told(&from_file, "x,y,z,radius,diameter\n0,0,0.1,0.01,0.02\n", 0, &[]);
    let spin = "x,y,z,radius,wy\n0,0,0.1,0.01,50\n";
    told(&from_file, spin, 0, &[]);
    let smooth = from_file.replace("sliding_friction = 0.5\n", "");
    told(&smooth, spin, 0, &["p.csv: the spins", "not kept", "sliding_friction"]);
    let deep = "id,x,y,z,radius\n4,0,0,0.1,0.01\n9,0.0185,0,0.1,0.01\n";
    told(
        &from_file,
        deep,
        0,
        &["particles 4 and 9 overlap by 1.500e-3 m", "15.0 % of the smaller radius", "[[fill]]"],
    );
    told(&from_file, &deep.replace("0.0185", "0.01995"), 0, &[]);
    told(
        &from_file,
        "x,y,z,radius\n0,0,-0.001,0.01\n",
        0,
        &["particle 0 and wall 'floor' overlap by 1.000e-3 m"],
    );
    told(
        &from_file.replace("until = 0.01", "until = 1"),
        "x,y,z,radius\n0,0,30,10\n",
        0,
        &["particle 0: radius = 10 m", "metres", "10 mm are 0.01"],
    );
    for (from, to, parts) in [
        (
            "density = 3300",
            "density = 3.3",
            ["s.toml:6:11: material.0.density = 3.3 kg/m³", "if g/cm³ are meant, write 3300"],
        ),
        (
            "density = 3300",
            "density = 3.3e6",
            ["material.0.density = 3300000 kg/m³", "if g/m³ are meant, write 3300"],
        ),
        ("young = 2e8", "young = 2e13", ["material.1.young", "stiffer than diamond"]),
    ] {
        told(&from_file.replace(from, to), one, 0, &parts);
    }
}

/// Every effect of contact: its key reaches the engine, and `--explain` says what it takes.
#[test]
fn explain_names_every_effect_of_contact_with_its_bytes() {
    let folder = tempdir().unwrap();
    let cases: &[(&str, &[(&str, &str)])] = &[
        ("law = \"jkr\"\nwork_of_adhesion = 0.1", &[("jkr", "8"), ("sliding_friction", "24")]),
        ("cohesion = \"sjkr\"\ncohesion_energy_density = 1e3", &[("hertz", "0"), ("cohesion", "0")]),
        ("rolling_resistance = 0.1", &[("rolling_resistance", "24")]),
        ("rolling_resistance = 0.1\nrolling_model = \"constant\"", &[("constant rolling", "0")]),
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
