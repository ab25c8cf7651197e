//! What `--check` foretells of a drop.

use super::*;

/// A drop of a metre, at a restitution and modulus, with one grain or one clump.
fn drop(restitution: f64, young: f64, more: &str) -> String {
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
[[wall]]
box = [0, 0, 0, 0.1, 0.1, 2]
material = "ore"
{more}"#
    )
}

const GRAIN: &str =
    "[[fill]]\nmaterial = \"ore\"\nshape = \"box:0.02,0.02,1,0.08,0.08,1.06\"\ndiameter = 0.02\ncount = 1\n";
const CLUMP: &str = "[[clump]]\nname = \"bar\"\nmaterial = \"ore\"\nspheres = [[0, 0, 0, 0.01], [0.012, 0, 0, 0.01], [0.024, 0, 0, 0.01]]\n\
                     [[body]]\nclump = \"bar\"\nposition = [0.04, 0.05, 1]\nquaternion = [0.7071067811865476, 0, 0.7071067811865476, 0]\n";

/// What is foretold comes true: with 0.75 of the modulus that it names the run is stopped, with all of it the run ends.
#[test]
fn a_drop_that_the_overlap_guard_would_stop_is_foretold_with_the_modulus_that_bears_it() {
    for (restitution, more) in [(0.1, GRAIN), (0.3, GRAIN), (0.6, GRAIN), (0.9, GRAIN), (0.5, CLUMP)] {
        let folder = with(&drop(restitution, 1e6, more));
        let done = succeed(folder.path(), "dem-run", &["s.toml", "--check"]);
        let named = done.stderr.split("young of ore ≥ ").nth(1).unwrap_or_else(|| panic!("{}", done.stderr));
        assert!(done.stderr.contains(" m onto wall 'wall.0 z-' and would overlap it by "), "{}", done.stderr);
        let young: f64 = named.split(' ').next().unwrap().parse().unwrap();
        let run = |young: f64| {
            let set = format!("material.0.young={young:e}");
            let done = tool(folder.path(), "dem-run", &["s.toml", "--set", &set, "-o", "run.mcap"]);
            (done.code, done.stderr.contains("would overlap it"), done.stderr)
        };
        // The modulus named keeps within 0.8 of the guard: (1/0.8)^2.5 = 1.75 times what just bears the drop.
        let (soft, just) = (run(young / 1.75 * 0.75), run(young));
        assert!((soft.0, soft.1) == (3, true), "e = {restitution}, {young}: {}", soft.2);
        assert!((just.0, just.1) == (0, false), "e = {restitution}, {young}: {}", just.2);
    }
}
