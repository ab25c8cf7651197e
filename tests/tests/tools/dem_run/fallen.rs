//! Grains that fall past all walls are counted, or taken out.

use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{succeed, tool};

/// Grains over a plate that turns a little, some of them beside it.
const PLATE: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 0.25
[output]
every = 0.1
[[material]]
name = "sand"
density = 2650
young = 1e6
poisson = 0.25
[[contact]]
between = ["*", "*"]
restitution = 0.3
sliding_friction = 0.5
[[fill]]
material = "sand"
shape = "box:0.03,0.03,0.01,0.07,0.07,0.03"
diameter = 0.008
count = 20
[[fill]]
material = "sand"
shape = "box:0.2,0.02,0.01,0.26,0.08,0.03"
diameter = 0.008
count = 12
[[wall]]
name = "plate"
solid = "box:0,0,-0.01,0.1,0.1,0"
material = "sand"
motion = { rotate = { about = [0, 0, 1], through = [0.05, 0.05, 0], rpm = 1 } }
"#;

fn removing(scene: &str) -> String {
    scene.replace("[time]", "[domain]\noutside = \"remove\"\n[time]")
}

fn report(folder: &std::path::Path) -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(folder.join("r.json")).unwrap()).unwrap()
}

#[test]
fn grains_that_fall_past_all_walls_are_counted_or_removed() {
    let folder = folder(&[
        ("keep.toml", PLATE),
        ("remove.toml", &PLATE.replace("[time]", "[domain]\noutside = \"remove\"\n[time]")),
    ]);
    let path = folder.path();
    let kept = tool(path, "dem-run", &["keep.toml", "-o", "keep.mcap", "--report", "r.json"]);
    assert!(
        kept.code == 0 && kept.stderr.contains("12 of 32 particles have fallen past all walls"),
        "{}",
        kept.stderr
    );
    assert_eq!(report(path)["fallen"], serde_json::json!({ "particles": 12, "of": 32 }));
    succeed(path, "dem-run", &["remove.toml", "-q", "-o", "remove.mcap", "--report", "r.json"]);
    let removed = report(path);
    assert_eq!(
        (&removed["particles"], &removed["crossings"], &removed["fallen"]),
        (&20.into(), &12.into(), &serde_json::Value::Null)
    );
}

/// Where nothing can fall past the walls, the key changes nothing, and is refused.
#[test]
fn removal_without_a_way_out_is_refused() {
    let plane = "[[wall]]\nname = \"floor\"\nplane = \"0,0,-0.1,0,0,1\"\nmaterial = \"sand\"\n";
    let servo = "[[wall]]\nname = \"lid\"\nplane = \"0,0,1,0,0,-1\"\nmaterial = \"sand\"\n\
                 servo = { direction = [0, 0, -1], force = 1, speed_limit = 0.1 }\n";
    for (text, why) in [
        ([&removing(PLATE), plane].concat(), "unbounded plane below"),
        ([&removing(PLATE), servo].concat(), "servo"),
        (removing(PLATE).replace("gravity = [0, 0, -9.81]", ""), "without gravity"),
    ] {
        let folder = folder(&[("s.toml", &text)]);
        let refused = tool(folder.path(), "dem-run", &["s.toml", "--check"]);
        assert!(
            refused.code == 1 && refused.stderr.contains("domain.outside") && refused.stderr.contains(why),
            "{}",
            refused.stderr
        );
    }
    let folder = folder(&[("s.toml", &[PLATE, plane].concat())]);
    let held = tool(folder.path(), "dem-run", &["s.toml", "-o", "s.mcap"]);
    assert!(held.code == 0 && !held.stderr.contains("fallen"), "{}", held.stderr);
}
