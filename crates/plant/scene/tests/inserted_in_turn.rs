//! Insertions through one place, one after the other, at different velocities.

use scene::Scene;
use std::path::Path;

const HEAD: &str = "[time]\nuntil = 2\n[[material]]\nname = \"a\"\ndensity = 2500\nyoung = 1e7\npoisson = 0.3\n\
    [[contact]]\nbetween = [\"a\", \"a\"]\nrestitution = 0.5\n";

/// Two insertions through a box 0.06 m high: at 1 m/s with these keys, and at 0.5 m/s from a time on; why they are refused.
fn refused(first: &str, from: f64) -> Option<String> {
    let insert = |speed: f64, keys: &str| {
        format!(
            "[[insert]]\nmaterial = \"a\"\ndiameter = 0.01\nshape = \"box:0,0,0,0.1,0.1,0.06\"\nvelocity = [0, 0, {speed}]\n{keys}\n"
        )
    };
    let scene =
        format!("{HEAD}{}{}", insert(-1.0, first), insert(-0.5, &format!("rate_count = 100\nfrom = {from}")));
    let scene = Scene::new("s.toml", scene, &[], Path::new("")).expect("sound");
    scene.plan(Vec::new()).err().map(|e| e.to_string())
}

/// The first ends by its time, its number or its mass (of grains of 1.3 g), and its last grain is out of the shape 0.06 s later.
#[test]
fn one_may_begin_when_the_other_has_ended_and_its_shape_is_empty() {
    for (first, empty) in [
        ("rate_count = 250\nuntil = 0.2", 0.26),
        ("rate_count = 250\ncount = 50", 0.26),
        ("rate = 0.327\nmass = 0.0654", 0.28),
        ("rate_count = 250\ncount = 25\nrepeat = 0.3\nuntil = 0.2\ntimes = 2", 0.46),
    ] {
        assert_eq!(refused(first, empty + 0.001), None, "{first}");
        let why = refused(first, empty - 0.05).unwrap_or_else(|| panic!("{first}: accepted"));
        assert!(why.contains("insert.1.velocity") && why.contains("insert.1.from = 0."), "{first}: {why}");
    }
    let why = refused("rate_count = 250", 1.0).expect("it never ends");
    assert!(why.contains("end insert.0 (until) before this one begins"), "{why}");
}
