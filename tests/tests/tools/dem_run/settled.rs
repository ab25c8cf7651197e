//! A bed that one run has settled, in the next scene.

use super::*;

const HEAD: &str = r#"gravity = [1.5, 0, -9.81]
[time]
dt = 1e-5
[output]
every = 0.01
precision = "f64"
[[material]]
name = "glass"
density = 2500
young = 1e7
poisson = 0.2
[[contact]]
between = ["*", "*"]
restitution = 0.3
sliding_friction = 0.5
rolling_resistance = 0.1
[[wall]]
name = "box"
box = [0, 0, 0, 0.05, 0.05, 0.2]
material = "glass"
"#;

/// The largest speed in the second frame [m/s].
fn fastest(run: &Path) -> f64 {
    let table = &frames(run)[1].1;
    let velocities = record::Columns { name: "run", table }.vectors(["vx", "vy", "vz"]).unwrap();
    velocities.iter().map(|v| v.norm()).fold(0.0, f64::max)
}

/// Without their springs the grains of a slope start to slide, until new springs hold them.
#[test]
fn a_settled_bed_stays_at_rest_in_the_next_scene() {
    let fill = "[[fill]]\nmaterial = \"glass\"\nshape = \"box:0,0,0,0.05,0.05,0.08\"\ndiameter = [0.009, 0.011]\ncount = 80\n";
    let next = format!("{HEAD}[[particles]]\nsource = \"bed.mcap\"\n");
    let folder = folder(&[("bed.toml", format!("{HEAD}{fill}")), ("next.toml", next)]);
    succeed(folder.path(), "dem-run", &["bed.toml", "--until", "1", "-o", "bed.mcap"]);
    let run = |name: &str, set: &[&str]| {
        let options = [&["next.toml", "--until", "0.02", "-o", name], set].concat();
        succeed(folder.path(), "dem-run", &options);
        fastest(&folder.path().join(name))
    };
    let kept = run("kept.mcap", &[]);
    let again = run("again.mcap", &["--threads", "1"]);
    assert_eq!(kept, again);
    // Other materials: contacts begin without springs.
    let new = run("new.mcap", &["--set", "particles.0.material=glass"]);
    // A wall is found by its place, whatever its name.
    let renamed = run("renamed.mcap", &["--set", "wall.0.name=other"]);
    // The largest speed of 80 grains: 0.1 mm/s with springs, 8 mm/s without.
    assert!(kept < 3e-4 && new > 20.0 * kept && renamed == kept, "{kept} {renamed} {new}");
}
