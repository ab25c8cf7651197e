//! A stage downstream: the same inlet on both engines.

use crate::{lmp, refusal};
use grainpipe_tests::recorded::{column, frames, tables};
use grainpipe_tests::scenes::{folder, write};
use grainpipe_tests::tools::{line, succeed, tool};
use std::fs;
use std::path::Path;
use stream::Table;
use tempfile::TempDir;

/// What both stages have.
const BOTH: &str = "gravity = [0, 0, -9.81]
[time]
contacts = \"sampled\"
[output]
every = 0.005
[[material]]
name = \"glass\"
density = 2500
young = 3e6
poisson = 0.25
[[contact]]
between = [\"*\", \"*\"]
law = \"hertz\"
restitution = 0.3
sliding_friction = 0.4
";

/// 300 grains with speeds and spins of their own, which fall through a plane into a box 0.25 m below, and do not meet before.
fn plant(motion: &str) -> TempDir {
    let mut grains = "id,x,y,z,radius,vx,vy,vz,wx,wy,wz\n".to_owned();
    for k in 0..300 {
        let (i, j, l) = (k % 6, k / 6 % 5, k / 30);
        let part = |factor: i32| f64::from(k * factor % 101) / 50.5 - 1.0;
        let x = [0.008 * f64::from(i) - 0.02, 0.008 * f64::from(j) - 0.016, 0.26 + 0.008 * f64::from(l)];
        let v = [0.004 * part(37), 0.004 * part(53), -0.7 + 0.02 * f64::from(l) + 0.002 * part(71)];
        let w = [20.0 * part(17), 20.0 * part(29), 20.0 * part(43)];
        let radius = 0.0025 + 0.0005 * part(61);
        let all: Vec<String> = [&x[..], &[radius], &v, &w].concat().iter().map(f64::to_string).collect();
        grains += &format!("{},{}\n", 1000 + k, all.join(","));
    }
    let up = format!(
        "[[particles]]\nsource = \"grains.csv\"\nmaterial = \"glass\"\n[[outlet]]\nplane = \"0,0,0.25,0,0,-1\"\nmotion = \"{motion}\"\n"
    );
    let wall = |name: &str, plane: &str| {
        format!("[[wall]]\nname = \"{name}\"\nplane = \"{plane}\"\nmaterial = \"glass\"\n")
    };
    let sides = [
        ("west", "-0.03,0,0,1,0,0"),
        ("east", "0.03,0,0,-1,0,0"),
        ("south", "0,-0.03,0,0,1,0"),
        ("north", "0,0.03,0,0,-1,0"),
        ("floor", "0,0,0,0,0,1"),
    ];
    let down = "[[inlet]]\nplane = \"0,0,0.25,0,0,-1\"\n".to_owned()
        + &sides.iter().map(|(name, plane)| wall(name, plane)).collect::<String>();
    let timed = |end: &str| BOTH.replacen("[time]", &format!("[time]\nuntil = {end}"), 1);
    let plant = folder(&[
        ("up.toml", timed("0.25") + &up),
        ("down.toml", timed("0.6") + &down),
        ("grains.csv", grains),
    ]);
    succeed(plant.path(), "dem-run", &["up.toml", "-q", "-o", "up.mcap"]);
    plant
}

/// Mean of a column.
pub fn mean(frame: &Table, name: &str) -> f64 {
    let all = column(frame, name);
    all.iter().sum::<f64>() / all.len() as f64
}

/// Largest difference of columns in the frames before a grain comes to the floor; all grains have come in by then.
fn difference(ours: &[Table], theirs: &[Table], names: &[&str]) -> f64 {
    let (mut worst, mut most) = (0.0f64, 0);
    for (a, b) in ours.iter().zip(theirs) {
        assert_eq!(column(a, "id"), column(b, "id"), "the same grains have come in");
        if column(a, "z").iter().any(|z| *z < 0.01) {
            break;
        }
        most = most.max(a.rows());
        for name in names {
            let pairs = column(a, name).into_iter().zip(column(b, name));
            worst = pairs.map(|(p, q)| (p - q).abs()).fold(worst, f64::max);
        }
    }
    assert_eq!(most, 300);
    worst
}

/// Runs the stage downstream on both engines; frames.
fn downstream(path: &Path, more: &[&str]) -> [Vec<Table>; 2] {
    for (engine, run) in [("dem-run", "ours.mcap"), ("dem-lammps", "theirs.mcap")] {
        succeed(
            path,
            engine,
            &[&["down.toml", "in.mcap", "-q", "--set", "time.patch=plain", "-o", run], more].concat(),
        );
    }
    ["ours.mcap", "theirs.mcap"].map(|run| frames(&path.join(run)))
}

/// In free fall: the same grains at the same times, and each where it is on the other engine.
#[test]
fn a_stage_downstream_gets_the_grains_of_its_inlet() {
    if !lmp() {
        return;
    }
    let plant = plant("ballistic");
    let path = plant.path();
    succeed(path, "stage-replay", &["up.mcap", "-q", "-o", "in.mcap"]);
    let [ours, theirs] = downstream(path, &[]);
    assert_eq!(ours.len(), 121);
    let place = difference(&ours, &theirs, &["x", "y", "z", "radius", "material"]);
    let speed = difference(&ours, &theirs, &["vx", "vy", "vz"]);
    let spin = difference(&ours, &theirs, &["wx", "wy", "wz"]);
    println!("in free fall: {place:.1e} m, {speed:.1e} m/s, {spin:.1e} rad/s");
    assert!(place < 1e-11 && speed < 1e-10 && spin < 1e-9, "{place:e} {speed:e} {spin:e}");
    let (a, b) = (&ours[120], &theirs[120]);
    assert_eq!(b.rows(), 300);
    let resting = column(b, "vz").iter().map(|v| v.abs()).fold(0.0, f64::max);
    println!(
        "at rest: z {} {}, x {} {}; speed {resting:.1e}",
        mean(a, "z"),
        mean(b, "z"),
        mean(a, "x"),
        mean(b, "x")
    );
    // Two layers in a box: on each engine the mean height of eight starts with other speeds has a standard deviation of 1.5 %.
    assert!((mean(a, "z") / mean(b, "z") - 1.0).abs() < 0.04 && resting < 0.05);
    assert!(["x", "y"].iter().all(|axis| (mean(a, axis) - mean(b, axis)).abs() < 1e-3));
}

/// Live through pipes, at constant velocity and at the times of the record: grains that had crossed before start inside the zone.
#[test]
fn a_stage_downstream_reads_a_stream_to_its_end() {
    if !lmp() {
        return;
    }
    let plant = plant("constant");
    let path = plant.path();
    succeed(path, "stage-replay", &["up.mcap", "--keep-times", "--ahead", "0.05", "-q", "-o", "in.mcap"]);
    let down = fs::read_to_string(path.join("down.toml")).unwrap();
    // A middle stage: an outlet behind the inlet; grains on their way in do not cross it.
    let outlet = "[[outlet]]\nplane = \"0,0,0.1,0,0,-1\"\n";
    write(path, "down.toml", down.split("[[wall]]").next().unwrap().to_owned() + outlet);
    let step = 5e-6;
    let given = format!("time.dt={step:?}");
    let [ours, theirs] = downstream(path, &["--until", "0.3", "--set", &given]);
    let mut most = 0.0f64;
    for (a, b) in ours.iter().zip(&theirs) {
        // Behind the outlet grains fall on LAMMPS, which takes them out later.
        let above: Vec<f64> =
            column(a, "id").into_iter().zip(column(a, "z")).filter(|g| g.1 > 0.1).map(|g| g.0).collect();
        let rows = |frame: &Table, name: &str| -> Vec<f64> {
            let all = column(frame, "id").into_iter().zip(column(frame, name));
            all.filter(|(id, _)| above.contains(id)).map(|row| row.1).collect()
        };
        for name in ["id", "x", "y", "z", "vx", "vy", "vz"] {
            let (p, q) = (rows(a, name), rows(b, name));
            assert_eq!((p.len(), q.len()), (above.len(), above.len()));
            let worst = p.iter().zip(&q).map(|(p, q)| (p - q).abs()).fold(0.0, f64::max);
            most = most.max(worst);
            // Gravity begins in the step of the release: half a step of it sooner on LAMMPS.
            assert!(worst < 0.55 * 9.81 * step, "{name}: {worst:e}");
        }
    }
    println!("released from constant velocity: {most:.1e} of {:.1e}", 9.81 * step);
    let crossed = |run: &str| -> Vec<f64> {
        tables(&path.join(run), "/crossings").iter().flat_map(|t| column(t, "id")).collect()
    };
    let sorted = |mut ids: Vec<f64>| {
        ids.sort_by(f64::total_cmp);
        ids
    };
    let [first, second] = ["ours.mcap", "theirs.mcap"].map(|run| sorted(crossed(run)));
    assert!(first.len() > 200 && first == second, "{} {}", first.len(), second.len());
    let piped = "dem-run up.toml -q | stage-replay --keep-times --ahead 0.05 -q | dem-lammps down.toml - --until 0.3 --set time.dt=5e-6 -q -o piped.mcap";
    let done = line(path, piped);
    assert_eq!(done.code, 0, "{}", done.stderr);
    assert!(frames(&path.join("piped.mcap")) == theirs);
}

/// What cannot be done, and streams that are wrong, are errors that name the cure.
#[test]
fn inlets_that_lammps_cannot_have_are_refused() {
    let plant = plant("recorded");
    let path = plant.path();
    succeed(path, "stage-replay", &["up.mcap", "-q", "-o", "in.mcap"]);
    let down = fs::read_to_string(path.join("down.toml")).unwrap();
    write(path, "s.toml", &down);
    let said = refusal(path, &["in.mcap"]);
    assert!(said.contains("inlet.motion = \"recorded\"") && said.contains("--move ballistic"), "{said}");
    let said = refusal(path, &[]);
    assert!(said.contains("waits for an inlet"), "{said}");
    // A stream that breaks off.
    succeed(path, "stage-replay", &["up.mcap", "--move", "ballistic", "-q", "-o", "in.mcap"]);
    let bytes = fs::read(path.join("in.mcap")).unwrap();
    write(path, "short.mcap", &bytes[..bytes.len() / 2]);
    let done = tool(path, "dem-lammps", &["down.toml", "short.mcap", "-o", "x.mcap"]);
    assert!(done.code == 1 && done.stderr.contains("short.mcap"), "{}", done.stderr);
    // Ids that the scene has already.
    let twice = down.clone() + "[[particles]]\nsource = \"one.csv\"\nmaterial = \"glass\"\n";
    write(path, "s.toml", twice);
    write(path, "one.csv", "id,x,y,z,radius\n1007,0,0,0.01,0.003\n");
    let said = refusal(path, &["in.mcap"]);
    assert!(said.contains("1007"), "{said}");
    // An outlet where grains wait.
    write(path, "s.toml", down.clone() + "[[outlet]]\nplane = \"0,0,0.27,0,0,1\"\n");
    let said = refusal(path, &["in.mcap"]);
    assert!(said.contains("outlet.0: grains that come in wait behind it"), "{said}");
    // A record that is shorter than the run.
    succeed(path, "dem-run", &["up.toml", "--until", "0.08", "-q", "-o", "up.mcap"]);
    succeed(path, "stage-replay", &["up.mcap", "--move", "ballistic", "-q", "-o", "in.mcap"]);
    let done = tool(path, "dem-lammps", &["down.toml", "in.mcap", "--check"]);
    assert!(done.code == 0 && done.stderr.contains("the record ends at t = "), "{}", done.stderr);
}
