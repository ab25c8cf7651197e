//! Scenes in which two things meet that are right by themselves.

use super::with;
use grainpipe_tests::recorded::json;
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{Done, succeed, tool};
use std::path::Path;

/// Material and contact of all scenes here; `{law}` is what the contact has besides.
fn head(law: &str) -> String {
    format!(
        "[[material]]\nname = \"g\"\ndensity = 2500\nyoung = 1e7\npoisson = 0.25\n[[contact]]\nbetween = [\"*\", \"*\"]\n{law}\n"
    )
}

fn run(folder: &Path, more: &[&str]) -> Done {
    tool(folder, "dem-run", &[&["s.toml", "-o", "run.mcap"], more].concat())
}

/// Grains that were inserted fly back to where others come in: none of them came by a cut, so none is taken out as one that went back through it.
#[test]
fn inserted_grains_are_none_that_came_back_through_a_cut() {
    let scene = "time.until = 0.3\nguards.zones = \"remove\"\n".to_owned()
        + &head("restitution = 0.9")
        + "[[insert]]\nmaterial = \"g\"\ndiameter = 0.006\nshape = \"box:0,0,0,0.02,0.02,0.02\"\nvelocity = [0, 0, -1]\nrate_count = 100\n\
           [[wall]]\nplane = \"0,0,-0.01,0,0,1\"\nmaterial = \"g\"\n";
    let done = run(with(&scene).path(), &[]);
    assert!(done.code == 0 || done.code == 3, "{}: {}", done.code, done.stderr);
    assert!(!done.stderr.contains("panicked"), "{}", done.stderr);
}

/// Two grains adhere in the zone of an outlet, where nothing is booked, and one of them is removed at its end.
#[test]
fn what_adheres_at_an_exclusion_plane_makes_no_energy() {
    for motion in ["constant", "ballistic", "recorded"] {
        let scene = "time.until = 0.1\noutput.energy = true\noutput.every = 0.01\n".to_owned()
            + &head("law = \"jkr\"\nwork_of_adhesion = 0.2\nrestitution = 0.5\nsliding_friction = 0.4")
            + "[[particles]]\nsource = \"p.csv\"\nmaterial = \"g\"\n[[outlet]]\nplane = \"0,0,0,0,0,-1\"\nlength = 0.03\nmotion = \""
            + motion
            + "\"\n";
        let rows =
            "x,y,z,radius,vx,vy,vz,wy\n0,0,0.001,0.004,0.2,0,-1,50\n0.012,0,0.002,0.004,-0.2,0,-1,50\n";
        let folder = folder(&[("s.toml", &scene), ("p.csv", &rows.to_owned())]);
        let done = run(folder.path(), &[]);
        assert_eq!(done.code, 0, "{motion}: {}", done.stderr);
        let rows = String::from_utf8(succeed(folder.path(), "dem-measure", &["run.mcap", "--energy"]).stdout);
        let rows = rows.expect("text");
        let column = rows.lines().next().expect("a head").split(',').position(|c| c.contains("integration"));
        let column = column.expect("a column for what the step made");
        for row in rows.lines().skip(1) {
            let made: f64 = row.split(',').nth(column).expect("a number").parse().expect("a number");
            // Grains that stay free collide, and a step makes a little of their 6.9e-4 J.
            let limit = if motion == "recorded" { 1e-8 } else { 1e-12 };
            assert!(made.abs() < limit, "{motion}: {made:e} J");
        }
    }
}

/// A fold of two plates; drawn with one of them twice, the other way round, as CAD programs do.
#[test]
fn a_plate_that_is_drawn_twice_is_one() {
    let [a, b] = [[0.0, -0.05, 0.0], [0.0, 0.05, 0.0]];
    let [c, d] = [[0.033, 0.05, 0.0375], [0.033, -0.05, 0.0375]];
    let [e, f] = [[-0.05, 0.05, -0.0034], [-0.05, -0.05, -0.0034]];
    let once = [[a, b, c], [a, c, d], [a, b, e], [a, e, f]];
    let line =
        |t: &[[f64; 3]; 3]| t.iter().flatten().map(f64::to_string).collect::<Vec<_>>().join(" ") + "\n";
    let text: String = once.iter().map(line).collect();
    let twice = text.clone() + &line(&[c, b, a]) + &line(&[d, c, a]);
    let scene = "gravity = [0, 0, -9.81]\ntime.until = 0.05\ntime.safety = 0.1\n".to_owned()
        + &head("restitution = 0.8\nsliding_friction = 0.4")
        + "[[particles]]\nsource = \"p.csv\"\nmaterial = \"g\"\n[[wall]]\nmesh = \"m.txt\"\nmaterial = \"g\"\n";
    let rows = "x,y,z,radius,vx,vy,vz\n0.004,-0.006,0.0133,0.005,-0.28,0.076,-0.26\n";
    let ends = [text, twice].map(|mesh| {
        let folder = folder(&[("s.toml", &scene), ("p.csv", &rows.to_owned()), ("m.txt", &mesh)]);
        let done = run(folder.path(), &[]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        succeed(folder.path(), "dem-measure", &["run.mcap", "--track", "0"]).stdout
    });
    assert_eq!(ends[0], ends[1]);
}

/// Two grains on a dense bed of fixed spheres, and a clump of four on a plane.
#[test]
fn grains_that_touch_a_wall_are_counted_once_each() {
    let counted = |folder: &Path| -> Vec<u64> {
        let frame = json(&folder.join("run.mcap"), "/wall_forces").pop().expect("forces");
        let walls = frame["walls"].as_array().expect("walls").iter();
        walls.map(|wall| wall["contacts"].as_u64().expect("a number")).collect()
    };
    let start = "gravity = [0, 0, -9.81]\ntime.until = 0.1\noutput.wall_forces = true\n".to_owned()
        + &head("restitution = 0.1\nsliding_friction = 0.3");
    let wall: String = (0..441)
        .map(|k| format!("{},{},-0.02,0.02\n", 5e-4 * f64::from(k % 21 - 10), 5e-4 * f64::from(k / 21 - 10)))
        .collect();
    let spheres = folder(&[
        (
            "s.toml",
            &(start.clone()
                + "[[particles]]\nsource = \"p.csv\"\nmaterial = \"g\"\n[[particles]]\nsource = \"w.csv\"\nmaterial = \"g\"\nfixed = true\n"),
        ),
        ("p.csv", &"x,y,z,radius\n-0.0021,0,0.002,0.002\n0.0021,0,0.002,0.002\n".to_owned()),
        ("w.csv", &("x,y,z,radius\n".to_owned() + &wall)),
    ]);
    assert_eq!(run(spheres.path(), &[]).code, 0);
    assert_eq!(counted(spheres.path()), [2]);
    let plate = with(
        &(start
            + "[[clump]]\nname = \"plate\"\nmaterial = \"g\"\nspheres = [[-0.002, -0.002, 0, 0.003], [0.002, -0.002, 0, 0.003], [-0.002, 0.002, 0, 0.003], [0.002, 0.002, 0, 0.003]]\n\
               [[body]]\nclump = \"plate\"\nposition = [0, 0, 0.003]\n[[wall]]\nplane = \"0,0,0,0,0,1\"\nmaterial = \"g\"\n"),
    );
    let done = run(plate.path(), &[]);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert_eq!(counted(plate.path()), [1]);
}

/// Spheres a tenth of a grain apart are named where a law adheres; elsewhere, and where they are farther apart, they are not.
#[test]
fn walls_too_dense_for_adhesion_are_named() {
    let warned = |law: &str, apart: f64| {
        let scene = "time.until = 0.0001\n".to_owned()
            + &head(law)
            + "[[particles]]\nsource = \"p.csv\"\nmaterial = \"g\"\n[[particles]]\nsource = \"w.csv\"\nmaterial = \"g\"\nfixed = true\n";
        let wall: String = (0..400)
            .map(|k| format!("{},{},-0.02,0.02\n", apart * f64::from(k % 20), apart * f64::from(k / 20)))
            .collect();
        let folder = folder(&[
            ("s.toml", &scene),
            ("p.csv", &"x,y,z,radius\n0.005,0.005,0.012,0.01\n".to_owned()),
            ("w.csv", &("x,y,z,radius\n".to_owned() + &wall)),
        ]);
        let done = run(folder.path(), &[]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        done.stderr.contains("each adheres by itself")
    };
    let adheres = "law = \"jkr\"\nwork_of_adhesion = 0.05\nrestitution = 0.5";
    assert!(warned(adheres, 0.002) && !warned(adheres, 0.005) && !warned("restitution = 0.5", 0.002));
}

/// What `--set` cures is no fault of a scene; of a fault that stays the message names the place in the file.
#[test]
fn overrides_may_cure_a_scene() {
    let scene = "gravity = [\"0\", \"0\", \"-9.81 m/s²\"]\ntime.until = 0.001\n".to_owned()
        + &head("sliding_friction = 0.4")
        + "[[insert]]\nmaterial = \"g\"\ndiameter = 0.006\nshape = \"box:0,0,0,0.1,0.1,0.1\"\nrate_count = 100\nvelocity = [0, 0, -1]\nmass = \"5 g\"\n\
           [[wall]]\nplane = \"0,0,-0.01,0,0,1\"\nmaterial = \"g\"\nspring = { direction = [0, 0, 1], stiffness = \"1 kN/m\", damping = \"0.1 N·s/m\", mass = 1, speed_limit = 0.1 }\n";
    let folder = with(&scene);
    let missing = tool(folder.path(), "dem-run", &["s.toml", "--check"]);
    assert!(missing.code == 1 && missing.stderr.contains("restitution"), "{}", missing.stderr);
    let cured = tool(folder.path(), "dem-run", &["s.toml", "--check", "--set", "contact.0.restitution=0.5"]);
    assert_eq!(cured.code, 0, "{}", cured.stderr);
    let still =
        tool(folder.path(), "dem-run", &["s.toml", "--check", "--set", "contact.0.rolling_resistance=0.1"]);
    assert!(still.code == 1 && still.stderr.contains("restitution"), "{}", still.stderr);
}
