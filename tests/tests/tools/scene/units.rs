//! Numbers with units, lists for planes and shapes, and drawings in millimetres.

use super::SCENE;
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{succeed, tool};
use scene::Scene;
use scene::keys::SceneKeys;
use std::fs;
use std::path::Path;
use tempfile::tempdir;

fn keys(toml: &str) -> SceneKeys {
    Scene::new("s.toml", toml.to_owned(), &[], Path::new("")).expect("sound").keys
}

fn refused(toml: &str) -> String {
    Scene::new("s.toml", toml.to_owned(), &[], Path::new("")).expect_err("refused").to_string()
}

#[test]
fn text_with_units_and_lists_are_the_same_scene_as_plain_numbers() {
    let written = SCENE
        .replace("[0, 0, -9.81]", "[0, 0, \"-9.81 m/s²\"]")
        .replace("until = 0.01", "until = \"10 ms\"")
        .replace("density = 3300", "density = \"3.3 g/cm³\"")
        .replace("young = 5e6", "young = \"5 MPa\"")
        .replace("diameter = [0.01, 0.02]", "diameter = [\"10 mm\", \"2 cm\"]")
        .replace("restitution = 0.5", "restitution = \"50 %\"")
        .replace("\"box:0,0,0,0.1,0.1,0.1\"", "{ box = [0, 0, 0, \"10 cm\", 0.1, \"100 mm\"] }")
        .replace("\"0,0,-0.01,0,0,1\"", "[0, 0, \"-10 mm\", 0, 0, 1]");
    assert_eq!(keys(&written), keys(SCENE));
    let listed = SCENE
        .replace("\"box:0,0,0,0.1,0.1,0.1\"", "[\"box\", 0, 0, 0, 0.1, 0.1, 0.1]")
        .replace("[0, 0, -9.81]", "\"0, 0, -9.81\"")
        .replace("\"0,0,-0.01,0,0,1\"", "\"0,0,-10 mm,0,0,1\"");
    assert_eq!(keys(&listed), keys(SCENE));
    let set =
        Scene::new("s.toml", SCENE.to_owned(), &["time.until=20 ms".into()], Path::new("")).expect("sound");
    assert_eq!(set.keys.time.until, Some(0.02));
}

#[test]
fn units_of_another_dimension_name_place_and_example() {
    let says = |from: &str, to: &str, parts: &[&str]| {
        let message = refused(&SCENE.replace(from, to));
        parts.iter().for_each(|part| assert!(message.contains(part), "'{part}' is not in {message}"));
    };
    says("until = 0.01", "until = \"8 kg\"", &["s.toml:3:9", "8 kg", "number [s]", "20 ms"]);
    says("until = 0.01", "until = \"0.01\"", &["s.toml:3:9", "without quotes in s"]);
    says("[0.01, 0.02]", "\"12 mn\"", &["unknown unit 'mn'", "8 mm"]);
    says("restitution = 0.5", "restitution = \"5 m\"", &["plain number", "40 %"]);
    says("\"0,0,-0.01,0,0,1\"", "[0, 0, 1]", &["px,py,pz,nx,ny,nz", "a point [m] and the normal"]);
}

#[test]
fn a_drawing_in_millimetres_is_the_drawing_in_metres() {
    let folder = tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let stl = |size: f64| {
        let facet = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| {
            let vertex = |v: [f64; 3]| format!("vertex {} {} {}\n", v[0] * size, v[1] * size, v[2] * size);
            format!(
                "facet normal 0 0 1\nouter loop\n{}{}{}endloop\nendfacet\n",
                vertex(a),
                vertex(b),
                vertex(c)
            )
        };
        let (p, q, r, s) = ([-0.1, -0.1, -0.01], [0.2, -0.1, -0.01], [0.2, 0.2, -0.01], [-0.1, 0.2, -0.01]);
        format!("solid plate\n{}{}endsolid plate\n", facet(p, q, r), facet(p, r, s))
    };
    fs::write(at("m.stl"), stl(1.0)).expect("written");
    fs::write(at("mm.stl"), stl(1000.0)).expect("written");
    let with = |wall: &str| SCENE.replace("plane = \"0,0,-0.01,0,0,1\"", wall);
    let run = |name: &str, wall: &str| {
        fs::write(at("s.toml"), with(wall)).expect("written");
        succeed(folder.path(), "dem-run", &["s.toml", "-o", name]);
        succeed(folder.path(), "dem-measure", &[name, "--profile"]).stdout
    };
    let metres = run("m.mcap", "mesh = \"m.stl\"");
    assert_eq!(run("units.mcap", "mesh = \"mm.stl\"\nunits = \"mm\""), metres);
    assert_eq!(run("scale.mcap", "mesh = \"mm.stl\"\nscale = 0.001"), metres);
    // Without a unit the plate is 424 m wide.
    fs::write(at("s.toml"), with("mesh = \"mm.stl\"")).expect("written");
    let done = succeed(folder.path(), "dem-run", &["s.toml", "--check"]);
    assert!(
        done.stderr.contains("'floor' is 424") && done.stderr.contains("units = \"mm\""),
        "{}",
        done.stderr
    );
    for (wall, parts) in [
        ("plane = \"0,0,0,0,0,1\"\nunits = \"mm\"", ["wall.0.units", "only the files of mesh and source"]),
        ("mesh = \"m.stl\"\nunits = \"mm\"\nscale = 2", ["wall.0.scale", "scale or units"]),
        ("mesh = \"m.stl\"\nunits = \"kg\"", ["wall.0.units", "\"mm\""]),
        ("mesh = \"m.stl\"\nscale = 0", ["wall.0.scale", "above 0"]),
    ] {
        fs::write(at("s.toml"), with(wall)).expect("written");
        let done = tool(folder.path(), "dem-run", &["s.toml", "--check"]);
        assert!(done.code != 0 && parts.iter().all(|p| done.stderr.contains(p)), "{wall}: {}", done.stderr);
    }
}

#[test]
fn gravity_in_millimetres_is_warned_of() {
    let folder = folder(&[("s.toml", SCENE.replace("-9.81", "-9810"))]);
    let done = succeed(folder.path(), "dem-run", &["s.toml", "--check"]);
    assert!(done.stderr.contains("gravity") && done.stderr.contains("mm/s²"), "{}", done.stderr);
}
