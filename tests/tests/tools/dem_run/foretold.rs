//! What `--check` foretells of a drop.

use super::*;

/// A drop onto walls, at a restitution and modulus, of one grain or one clump.
fn drop(restitution: f64, young: f64, walls: &str, more: &str) -> String {
    format!(
        r#"gravity = [0, 0, -9.81]
[time]
until = 0.5
[[material]]
name = "ore"
density = 3500
young = {young}
poisson = 0.25
[[contact]]
between = ["*", "*"]
restitution = {restitution}
{walls}
{more}"#
    )
}

const FLAT: &str = "[[wall]]\nname = \"floor\"\nplane = \"0,0,0,0,0,1\"\nmaterial = \"ore\"\n";
/// At 45°: two thirds of the speed are along the normal, about.
const ASLANT: &str = "[[wall]]\nname = \"slope\"\nplane = \"0.05,0.05,0,1,0,1\"\nmaterial = \"ore\"\n";
/// Two triangles, at 27°.
const SHEET: &str = "[[wall]]\nname = \"sheet\"\nmesh = \"sheet.obj\"\nmaterial = \"ore\"\n";
const TRIANGLES: &str = "v -1 -1 -0.5\nv 1 -1 0.5\nv 1 1 0.5\nv -1 1 -0.5\nf 1 2 3\nf 1 3 4\n";
const GRAIN: &str =
    "[[fill]]\nmaterial = \"ore\"\nshape = \"box:0.02,0.02,1,0.08,0.08,1.06\"\ndiameter = 0.02\ncount = 1\n";
const CLUMP: &str = "[[clump]]\nname = \"bar\"\nmaterial = \"ore\"\nspheres = [[0, 0, 0, 0.01], [0.012, 0, 0, 0.01], [0.024, 0, 0, 0.01]]\n\
                     [[body]]\nclump = \"bar\"\nposition = [0.04, 0.05, 1]\nquaternion = [0.7071067811865476, 0, 0.7071067811865476, 0]\n";

/// Larger than the way that it falls.
const LARGE: &str = "[[fill]]\nmaterial = \"ore\"\nshape = \"box:0.005,0.005,0.06,0.095,0.095,0.1401\"\ndiameter = 0.08\ncount = 1\n";

/// What is foretold comes true: with 0.75 of the modulus that it names the run is stopped, with all of it the run ends.
#[test]
fn a_drop_that_the_overlap_guard_would_stop_is_foretold_with_the_modulus_that_bears_it() {
    let cases = [
        (0.1, FLAT, GRAIN),
        (0.3, FLAT, GRAIN),
        (0.6, FLAT, GRAIN),
        (0.9, FLAT, GRAIN),
        (0.5, FLAT, CLUMP),
        (0.4, FLAT, LARGE),
        (0.4, ASLANT, GRAIN),
        (0.4, ASLANT, LARGE),
        (0.4, SHEET, GRAIN),
        (0.4, SHEET, LARGE),
    ];
    for (restitution, walls, more) in cases {
        let case = format!("e = {restitution}, {walls}{more}");
        // The softest that a run may begin with: the large grain falls 6 cm only.
        let softer = if more == LARGE { 1e4 } else { 1e6 };
        let folder = with(&drop(restitution, softer, walls, more));
        std::fs::write(folder.path().join("sheet.obj"), TRIANGLES).unwrap();
        let done = succeed(folder.path(), "dem-run", &["s.toml", "--check"]);
        let named =
            done.stderr.split("young of ore ≥ ").nth(1).unwrap_or_else(|| panic!("{case}: {}", done.stderr));
        let name = walls.split('"').nth(1).unwrap();
        let where_to = format!(" m onto wall '{name}' and would overlap it by ");
        assert!(done.stderr.contains(&where_to), "{case}: {}", done.stderr);
        let young: f64 = named.split(' ').next().unwrap().parse().unwrap();
        let run = |young: f64| {
            let set = format!("material.0.young={young:e}");
            let done = tool(folder.path(), "dem-run", &["s.toml", "--set", &set, "-o", "run.mcap"]);
            (done.code, done.stderr.contains("would overlap it"), done.stderr)
        };
        // The modulus named keeps within 0.8 of the guard: (1/0.8)^2.5 = 1.75 times what just bears the drop.
        let (soft, just) = (run(young / 1.75 * 0.75), run(young));
        assert!((soft.0, soft.1) == (3, true), "{case}, {young}: {}", soft.2);
        assert!((just.0, just.1) == (0, false), "{case}, {young}: {}", just.2);
    }
}

/// A grain that is removed on its way falls on nothing.
#[test]
fn no_impact_is_foretold_behind_an_outlet() {
    let outlet = |z: f64| {
        format!("{GRAIN}[[outlet]]\nplane = \"0,0,{z},0,0,-1\"\nlength = 0.05\nmotion = \"ballistic\"\n")
    };
    for (z, foretold) in [(0.5, false), (0.04, true)] {
        let folder = with(&drop(0.3, 1e6, FLAT, &outlet(z)));
        let done = succeed(folder.path(), "dem-run", &["s.toml", "--check"]);
        assert_eq!(done.stderr.contains("onto wall 'floor' and would overlap"), foretold, "{}", done.stderr);
    }
}
