//! Clumps that are inserted have the scales that the scene asks for.

use scene::Scene;
use std::path::Path;

const SCENE: &str = "[time]\nuntil = 1\n[[material]]\nname = \"a\"\ndensity = 2500\nyoung = 1e7\npoisson = 0.3\n\
    [[contact]]\nbetween = [\"a\", \"a\"]\nrestitution = 0.5\n\
    [[clump]]\nname = \"pair\"\nmaterial = \"a\"\nmass = \"sum\"\nspheres = [[-0.0015, 0, 0, 0.002254], [0.0015, 0.0002, 0, 0.002]]\n\
    [[insert]]\nclump = \"pair\"\nshape = \"box:0,0,0,0.1,0.1,0.02\"\nvelocity = [0, 0, -1]\nrate_count = 400\n";

/// A run refuses a clump whose scale is out of the range that was announced, by rounding, too.
#[test]
fn no_scale_is_rounded_out_of_its_range() {
    let first = |low: f64, high: f64| {
        let scene = format!("{SCENE}scale = [{low}, {high}]\n");
        let scene = Scene::new("drawn", scene, &[], Path::new("")).expect("sound");
        let mut plan = scene.plan(Vec::new()).expect("sound");
        let planned = plan.insertions[0].next_entry().expect("there is room").expect("it is due");
        (planned.entry.clump.expect("a clump").scale, 2.0 * planned.entry.particle.radius)
    };
    let (one, size) = first(1.0, 1.0);
    assert_eq!(one, 1.0);
    let mut rounded = 0;
    for k in 0..300 {
        let low = 0.5 + 0.003_17 * f64::from(k);
        let high = if k % 2 == 0 { low } else { low + 1e-3 };
        let (scale, _) = first(low, high);
        assert!((low..=high).contains(&scale), "{scale} of {low} to {high}");
        rounded += u32::from(low == high && low * size / size != low);
    }
    assert!(rounded >= 3, "{rounded}");
}
