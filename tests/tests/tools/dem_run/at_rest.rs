//! Runs that end when their grains have come to rest, and what they say of servos.

use super::{checkpoints, frames, with};
use grainpipe_tests::recorded::json;
use grainpipe_tests::tools::{succeed, tool};

/// Thirty grains that fall into a box.
const BOX: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 3
until_unbalanced = 1e-4
[output]
every = 0.05
[local_damping]
[[material]]
name = "sand"
density = 2650
young = 1e7
poisson = 0.25
[[contact]]
between = ["*", "*"]
restitution = 0.3
sliding_friction = 0.5
[[fill]]
material = "sand"
shape = "box:0.001,0.001,0.001,0.029,0.029,0.06"
diameter = 0.008
count = 30
[[wall]]
box = [0, 0, 0, 0.03, 0.03, 0.1]
faces = ["x-", "x+", "y-", "y+", "z-"]
material = "sand"
"#;

/// The run ends at rest with a frame, a checkpoint and its reason; a resumed one at the same step with the same bytes.
#[test]
fn a_run_ends_when_its_grains_rest() {
    let folder = with(BOX);
    let at = |name: &str| folder.path().join(name);
    let done = succeed(folder.path(), "dem-run", &["s.toml", "-o", "all.mcap"]);
    assert!(
        done.stderr.contains("ended at rest: mean unbalanced over mean contact force is"),
        "{}",
        done.stderr
    );
    let (last, table) = frames(&at("all.mcap")).pop().expect("a frame");
    assert!(last < 2_900_000_000 && table.rows() == 30, "{last}");
    let settling = json(&at("all.mcap"), "/settling");
    let ratio = |k: usize| settling[k]["unbalanced"].as_f64();
    assert!(ratio(settling.len() - 1).is_some_and(|r| r <= 1e-4), "{settling:?}");
    assert!(json(&at("all.mcap"), "/log").iter().any(|m| m.to_string().contains("have come to rest")));
    // Resumed half-way, it ends at the same step in the same state.
    let half = format!("{}", last as f64 / 2e9);
    succeed(folder.path(), "dem-run", &["s.toml", "--until", &half, "-o", "half.mcap"]);
    succeed(folder.path(), "dem-run", &["s.toml", "--resume", "half.mcap", "-o", "rest.mcap"]);
    let (same, end) = frames(&at("rest.mcap")).pop().expect("a frame");
    assert!(same == last && end == table, "{same} instead of {last}");
    assert!(checkpoints(&at("rest.mcap")).last() == checkpoints(&at("all.mcap")).last(), "another state");
    // It is over.
    let again = tool(folder.path(), "dem-run", &["s.toml", "--resume", "all.mcap", "-o", "more.mcap"]);
    assert!(again.code == 1 && again.stderr.contains("have come to rest"), "{}", again.stderr);
}

/// Grains that float at rest are not settled before the lid has come and pressed on them.
#[test]
fn no_end_before_a_servo_presses() {
    let lid = "[[wall]]\nname = \"lid\"\nplane = [0, 0, 0.09, 0, 0, -1]\nmaterial = \"sand\"\n\
               servo = { direction = [0, 0, -1], force = 0.5, speed_limit = 0.3 }\n";
    let still = BOX.replace("-9.81", "0").replace("until_unbalanced = 1e-4", "until_unbalanced = 1e-2");
    let folder = with(&(still + lid));
    let done = succeed(folder.path(), "dem-run", &["s.toml", "-o", "all.mcap"]);
    assert!(
        done.stderr.contains("ended at rest") && !done.stderr.contains("did not reach"),
        "{}",
        done.stderr
    );
    let servo = &json(&folder.path().join("all.mcap"), "/wall_forces").pop().expect("it is there")["walls"]
        [5]["servo"];
    let (push, target) = (servo["push"].as_f64(), servo["target"].as_f64());
    assert!(push.zip(target).is_some_and(|(push, target)| (push / target - 1.0).abs() < 0.05), "{servo}");
}

/// By the kinetic energy, too; not while grains are in the air, nor where a stage or an endless insertion goes on.
#[test]
fn other_ends_at_rest() {
    let folder = with(&BOX.replace("until_unbalanced = 1e-4", "until_kinetic = \"1 nJ\""));
    let done = succeed(folder.path(), "dem-run", &["s.toml", "-o", "a.mcap"]);
    assert!(done.stderr.contains("ended at rest: kinetic energy is"), "{}", done.stderr);
    let (last, _) = frames(&folder.path().join("a.mcap")).pop().expect("a frame");
    assert!(last > 100_000_000, "they had to fall first: {last}");
    let insert = "[[insert]]\nmaterial = \"sand\"\nshape = \"box:0.01,0.01,0.07,0.02,0.02,0.09\"\ndiameter = 0.004\nvelocity = [0, 0, -1]\nrate_count = 10\n";
    let folder = with(&(BOX.to_owned() + insert));
    let done = tool(folder.path(), "dem-run", &["s.toml", "-o", "a.mcap"]);
    assert!(done.code == 1 && done.stderr.contains("insert.0 has no end"), "{}", done.stderr);
    let outlet = "[[outlet]]\nplane = \"0,0,0.09,0,0,1\"\n";
    let folder = with(&(BOX.to_owned() + outlet));
    let done = tool(folder.path(), "dem-run", &["s.toml", "-o", "a.mcap"]);
    assert!(done.code == 1 && done.stderr.contains("a stage of a cut runs to its until"), "{}", done.stderr);
}

/// The end of a run says how well its servos held; one that touches nothing is a warning.
#[test]
fn servos_report_at_the_end() {
    let lid = |z: f64| {
        format!(
            "{BOX}[[wall]]\nname = \"lid\"\nplane = \"0,0,{z},0,0,-1\"\nmaterial = \"sand\"\n\
             servo = {{ direction = [0, 0, -1], force = 2, speed_limit = 0.5 }}\n"
        )
        .replace("until = 3\nuntil_unbalanced = 1e-4", "until = 0.4")
    };
    let folder = with(&lid(0.08));
    let done = succeed(folder.path(), "dem-run", &["s.toml", "-o", "a.mcap"]);
    assert!(done.stderr.contains("servo of wall 'lid': force off by"), "{}", done.stderr);
    let forces = json(&folder.path().join("a.mcap"), "/wall_forces");
    let servo = &forces.last().expect("a frame")["walls"][5]["servo"];
    let number = |key: &str| servo[key].as_f64().unwrap_or(f64::NAN);
    assert!(number("target") == 2.0 && (number("push") - 2.0).abs() < 0.02, "{servo}");
    assert!(number("mean_deviation") < 0.01 && number("worst_deviation") > 0.0, "{servo}");
    let folder = with(&lid(0.99));
    let done = succeed(folder.path(), "dem-run", &["s.toml", "-o", "a.mcap"]);
    assert!(
        done.stderr.contains("servo of wall 'lid': touched no grain: start the wall nearer"),
        "{}",
        done.stderr
    );
}
