//! Measures of a surface leave out grains that have fallen past all walls.

use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{succeed, tool};

/// A layer on a plate with a rim, and two grains beside it, which fall for 0.4 s.
const SCENE: &str = r#"
gravity = [0, 0, -9.81]
time.until = 0.4
[[material]]
name = "g"
density = 2500
young = 1e6
poisson = 0.3
[[contact]]
between = ["*", "*"]
restitution = 0.3
sliding_friction = 0.5
[[fill]]
material = "g"
shape = "box:0,0,0,0.1,0.1,0.04"
diameter = 0.012
count = 60
[[particles]]
source = "beside.csv"
material = "g"
[[wall]]
solid = "box:-0.01,-0.01,-0.01,0.11,0.11,0"
material = "g"
[[wall]]
solid = "box:0,0,0,0.1,0.1,0.2"
material = "g"
"#;

#[test]
fn grains_that_fell_past_all_walls_make_no_bed_higher() {
    let folder =
        folder(&[("s.toml", SCENE), ("beside.csv", "x,y,z,radius\n0.2,0,0,0.006\n0.25,0,0,0.006\n")]);
    let run = tool(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap"]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stderr.contains("2 of 62 particles have fallen past all walls"), "{}", run.stderr);
    let done = succeed(folder.path(), "dem-measure", &["run.mcap", "--bed-height"]);
    assert!(done.stderr.contains("2 of 62 grains have fallen past all walls"), "{}", done.stderr);
    let rows = String::from_utf8(done.stdout).expect("text");
    let height = rows.lines().nth(1).expect("a row").split(',').nth(1).expect("a number");
    let height: f64 = height.parse().expect("a number");
    assert!(height < 0.03, "{height} m");
    let within =
        succeed(folder.path(), "dem-measure", &["run.mcap", "--bed-height", "--within", "box:0,0,0,1,1,1"]);
    assert!(!within.stdout.is_empty());
}
