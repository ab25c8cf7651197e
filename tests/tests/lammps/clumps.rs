//! Rigid clumps on both engines: free flight, an oblique impact, a pile.

use crate::{lmp, refusal};
use grainpipe_tests::engines::both;
use grainpipe_tests::recorded::{column, tables};
use grainpipe_tests::scenes::{folder, write};
use grainpipe_tests::tools::{succeed, tool};
use std::fs;
use std::path::Path;
use std::process::Command;
use stream::Table;

const HEAD: &str = "[output]
every = 0.002
[[material]]
name = \"glass\"
density = 2500
young = 1e7
poisson = 0.25
[[contact]]
between = [\"*\", \"*\"]
law = \"hooke\"
stiffness = 2e4
restitution = 0.6
sliding_friction = 0.3
[[clump]]
name = \"stone\"
material = \"glass\"
spheres = [[0, 0, 0, 0.004], [0.005, 0, 0, 0.003], [0.001, 0.004, 0, 0.003], [0, 0.001, 0.004, 0.0025]]
[[clump]]
name = \"rod\"
material = \"glass\"
spheres = [[0, 0, 0, 0.003], [0.004, 0, 0, 0.003], [0.008, 0, 0, 0.003]]
";

const FLOOR: &str = "[[wall]]\nname = \"floor\"\nplane = \"0,0,0,0,0,1\"\nmaterial = \"glass\"\n";

/// The tables of clumps of both engines.
fn bodies(folder: &Path) -> [Vec<Table>; 2] {
    ["ours.mcap", "theirs.mcap"].map(|run| tables(&folder.join(run), "/bodies"))
}

/// Largest angle between the orientations of a clump on both engines [rad].
fn turned([ours, theirs]: &[Vec<Table>; 2], clump: usize) -> f64 {
    let parts = |t: &Table| TURN.map(|name| column(t, name)[clump]);
    let of = |(a, b): (&Table, &Table)| {
        let (a, b) = (parts(a), parts(b));
        // q and -q are one orientation.
        let chord = |sign: f64| a.iter().zip(b).map(|(p, q)| (p - sign * q).powi(2)).sum::<f64>().sqrt();
        2.0 * chord(1.0).min(chord(-1.0))
    };
    ours.iter().zip(theirs).map(of).fold(0.0, f64::max)
}

/// Largest difference of columns of all clumps, frame by frame.
fn differences(pairs: &[Vec<Table>; 2], names: &[&str]) -> Vec<f64> {
    let [ours, theirs] = pairs;
    assert_eq!(ours.len(), theirs.len());
    let of = |(a, b): (&Table, &Table)| {
        assert_eq!(column(a, "id"), column(b, "id"));
        let one = |name: &&str| {
            let pairs = column(a, name).into_iter().zip(column(b, name));
            pairs.map(|(p, q)| (p - q).abs()).fold(0.0, f64::max)
        };
        names.iter().map(one).fold(0.0, f64::max)
    };
    ours.iter().zip(theirs).map(of).collect()
}

const TURN: [&str; 4] = ["qw", "qx", "qy", "qz"];

/// A tumbling stone and a rod that turns about its axis and across it fall across a periodic face; nothing touches.
#[test]
fn clumps_in_flight_are_where_they_are_in_dem_run() {
    if !lmp() {
        return;
    }
    let scene = "gravity = [0, 0, -9.81]\n[time]\nuntil = 0.05\ndt = 2e-6\n[domain]\nperiodic = [\"x\"]\nlow = [0, 0, 0]\nhigh = [0.05, 0, 0]\n"
        .to_owned()
        + HEAD
        + "[[body]]\nclump = \"stone\"\nposition = [0.045, 0, 0.1]\nquaternion = [0.8, 0.6, 0, 0]\nvelocity = [0.3, 0.1, 0]\nspin = [60, -20, 45]\n\
           [[body]]\nclump = \"rod\"\nposition = [0.01, 0.05, 0.1]\nvelocity = [-0.4, 0, 0.2]\nspin = [80, 30, 0]\nscale = 0.7\n";
    let folder = folder(&[("s.toml", scene)]);
    let [ours, theirs] = both(folder.path(), &[]);
    let flights = bodies(folder.path());
    let worst = |names: &[&str]| differences(&flights, names).into_iter().fold(0.0, f64::max);
    let [x, v, w] = [["x", "y", "z"], ["vx", "vy", "vz"], ["wx", "wy", "wz"]].map(|names| worst(&names));
    let [stone, rod] = [0, 1].map(|k| turned(&flights, k));
    println!("in flight: {x:.1e} m, {v:.1e} m/s, {w:.1e} rad/s, turned by {stone:.1e} and {rod:.1e} rad");
    assert!(x < 1e-13 && v < 1e-12 && w < 1e-6 && stone < 1e-7);
    // Members of a rod do not show its turn about its axis, which is integrated from frame to frame.
    assert!(rod < 1e-3);
    let slow = ["s.toml", "--set", "output.every=0.01", "-o", "slow.mcap"];
    let said = tool(folder.path(), "dem-lammps", &slow).stderr;
    assert!(
        said.contains("body 4, whose members are on one line, turns by 0.9 rad")
            && said.matches("one line").count() == 1,
        "{said}"
    );
    for name in ["mass", "scale", "members", "clump"] {
        assert!(worst(&[name]) == 0.0, "{name}");
    }
    for (a, b) in ours.iter().zip(&theirs) {
        assert_eq!(column(a, "body"), column(b, "body"));
        let off =
            |name| column(a, name).into_iter().zip(column(b, name)).map(|(p, q): (f64, f64)| (p - q).abs());
        let worst = ["x", "y", "z"].into_iter().flat_map(off).fold(0.0, f64::max);
        assert!(worst < 1e-8, "{worst:e}");
    }
}

/// A body of four spheres, strikes a floor obliquely with one of them; largest difference of velocities over the speed.
fn impact(restitution: f64, friction: f64, stiffness: f64, steps: f64) -> f64 {
    let (speed, mass) = (1e-3, 2500.0 * 4e-7);
    let time = 3.0 * (mass / stiffness).sqrt();
    let (dt, every, v) = (time / steps, time / 20.0, speed);
    let head = HEAD.split("[[clump]]").next().unwrap().replace("0.002", &format!("{every:?}"));
    let head = head
        .replace("2e4", &format!("{stiffness:?}"))
        .replace("0.6", &format!("{restitution:?}"))
        .replace("0.3", &format!("{friction:?}"));
    let scene = format!(
        "[time]\nuntil = {time:?}\ndt = {dt:?}\n{head}{FLOOR}[[clump]]\nname = \"four\"\nmaterial = \"glass\"\n\
         spheres = [[0, 0, 0, 0.004], [0.003, 0.001, -0.004, 0.003], [-0.002, 0.003, 0.003, 0.0025], [-0.003, -0.003, 0, 0.003]]\n\
         moments = {{ volume = 4e-7, centre = [0, 0, 0], inertia = [3e-12, 2.5e-12, 2e-12, 2e-13, -1e-13, 3e-13] }}\n\
         [[body]]\nclump = \"four\"\nposition = [0, 0, 0.007]\nvelocity = [{:?}, {:?}, {:?}]\nspin = [{:?}, {:?}, {:?}]\n",
        0.6 * v,
        0.2 * v,
        -v,
        50.0 * v,
        -80.0 * v,
        60.0 * v
    );
    let folder = folder(&[("s.toml", scene)]);
    both(folder.path(), &["--set", "gravity=[0,0,0]"]);
    let pairs = bodies(folder.path());
    let worst = |names: &[&str]| differences(&pairs, names).into_iter().fold(0.0, f64::max);
    let speeds: Vec<f64> = pairs[0].iter().map(|frame| column(frame, "vz")[0]).collect();
    let end = speeds.len() - 1;
    assert!(speeds[end] - speeds[0] > 0.3 * speed && speeds[end] == speeds[end - 2], "{speeds:?}");
    (worst(&["vx", "vy", "vz"]) / speed).max(0.005 * worst(&["wx", "wy", "wz"]) / speed)
}

/// Without a dashpot and at small overlaps both laws are the same, and so are m*, arms and inertia.
#[test]
fn a_clump_bounces_obliquely_as_in_dem_run() {
    if !lmp() {
        return;
    }
    let elastic = impact(1.0, 0.3, 2e10, 1e5);
    let smooth = impact(0.6, 1e-9, 2e10, 1e5);
    let both = impact(0.6, 0.3, 2e10, 1e5);
    println!("oblique impact of a clump: elastic {elastic:.1e}, smooth {smooth:.1e}, with both {both:.1e}");
    // LAMMPS caps friction by |F_n|, also where the dashpot pulls, and cuts springs to the cap less the dashpot.
    assert!(elastic < 1e-5 && smooth < 1e-4 && both < 0.06, "{elastic:e} {smooth:e} {both:e}");
}

/// Clumps that fall into a box settle to the same height, and lie as densely.
#[test]
fn a_pile_of_clumps_settles_to_the_same_height() {
    if !lmp() {
        return;
    }
    let scene = "gravity = [0, 0, -9.81]\n[time]\nuntil = 0.5\n[domain]\nperiodic = [\"x\", \"y\"]\nlow = [0, 0, 0]\nhigh = [0.05, 0.05, 1]\n"
        .to_owned()
        + &HEAD.replace("every = 0.002", "every = 0.05")
        + FLOOR
        + "[[fill]]\nclump = \"stone\"\nshape = \"box:0,0,0,0.05,0.05,0.25\"\ncount = 80\n\
           [[fill]]\nclump = \"rod\"\nshape = \"box:0,0,0.25,0.05,0.05,0.4\"\ncount = 40\n";
    let folder = folder(&[("s.toml", scene)]);
    let mut heights = [Vec::new(), Vec::new()];
    for seed in ["1", "2", "3"] {
        both(
            folder.path(),
            &["--set", &format!("fill.0.seed={seed}"), "--set", &format!("fill.1.seed={seed}")],
        );
        for (run, heights) in bodies(folder.path()).iter().zip(&mut heights) {
            let last = &run[run.len() - 1];
            let speed = column(last, "vz").iter().map(|v| v.abs()).sum::<f64>() / last.rows() as f64;
            let z = column(last, "z");
            assert!(z.len() == 120 && speed < 0.01, "{speed}");
            heights.push(z.iter().sum::<f64>() / 120.0);
        }
    }
    println!("piles of clumps: {heights:?}");
    let [ours, theirs] = heights.map(|h| h.iter().sum::<f64>() / 3.0);
    assert!((ours / theirs - 1.0).abs() < 0.03, "{ours} {theirs}");
}

/// From a state of LAMMPS, which keeps bodies in a file of their own, a run goes on as one that was not interrupted, also in contact and across a face.
#[test]
fn clumps_go_on_from_a_state() {
    if !lmp() {
        return;
    }
    let scene = "gravity = [0, 0, 0]\n[time]\nuntil = 2e-3\ndt = 1e-7\n[domain]\nperiodic = [\"x\"]\nlow = [0, 0, 0]\nhigh = [0.05, 0, 0]\n"
        .to_owned()
        + &HEAD.replace("every = 0.002", "every = 1e-4\ncheckpoint = 3e-4")
        + FLOOR
        + "[[body]]\nclump = \"stone\"\nposition = [0.0495, 0, 0.0045]\nvelocity = [0.3, 0.1, -0.5]\nspin = [60, -20, 45]\n\
           [[body]]\nclump = \"rod\"\nposition = [0.01, 0.05, 0.1]\nvelocity = [-0.4, 0, 0.2]\nspin = [80, 30, 0]\n";
    let folder = folder(&[("s.toml", scene)]);
    let path = folder.path();
    succeed(path, "dem-lammps", &["s.toml", "--write-deck", "deck", "-q"]);
    let lammps = |options: &[&str]| {
        let mut lammps = Command::new("lmp");
        lammps.args(["-in", "run.in", "-log", "none"]).args(options).current_dir(path.join("deck"));
        let done = lammps.output().unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stdout));
    };
    let read = |run: &str| {
        succeed(path, "dem-lammps", &["s.toml", "--read-dump", "deck/frames.dump", "-q", "-o", run]);
        tables(&path.join(run), "/bodies")
    };
    lammps(&[]);
    let whole = read("whole.mcap");
    lammps(&["-var", "state", "state_1", "-var", "frames", "frames-2.dump"]);
    let again = read("again.mcap");
    let pairs = [whole, again];
    let worst = |names: &[&str]| differences(&pairs, names).into_iter().fold(0.0, f64::max);
    let [x, v, w] = [["x", "y", "z"], ["vx", "vy", "vz"], ["wx", "wy", "wz"]].map(|names| worst(&names));
    assert!(x < 1e-12 && v < 1e-9 && w < 1e-6, "{x:e} {v:e} {w:e}");
    assert!(turned(&pairs, 0) < 1e-9 && turned(&pairs, 1) < 1e-4);
    let speeds: Vec<f64> = pairs[0].iter().map(|frame| column(frame, "vz")[0]).collect();
    assert!(speeds.windows(2).filter(|v| v[0] != v[1]).count() > 5, "it is in contact: {speeds:?}");
    assert!(fs::read_to_string(path.join("deck/batch.sh")).unwrap().contains("$state.rigid"));
}

#[test]
fn what_clumps_cannot_have_is_refused_by_name() {
    let body = "[[body]]\nclump = \"rod\"\nposition = [0.01, 0.05, 0.1]\n";
    let head = "[time]\nuntil = 0.1\n".to_owned() + HEAD + FLOOR;
    let folder = folder(&[("s.toml", "")]);
    let outlet = "[[outlet]]\nplane = \"0,0,0.05,0,0,-1\"\n";
    let one = "[[clump]]\nname = \"one\"\nmaterial = \"glass\"\nspheres = [[0, 0, 0, 0.004]]\n[[body]]\nclump = \"one\"\nposition = [0, 0, 0.1]\n";
    let inserts = "[[insert]]\nclump = \"rod\"\nshape = \"box:0,0,0.2,0.1,0.1,0.22\"\nvelocity = [0, 0, -1]\nrate_count = 20\n";
    for (more, options, words) in [
        (body.to_owned() + outlet, &[][..], "outlet with clumps"),
        (body.to_owned() + one, &[], "clump 'one'"),
        (body.to_owned() + inserts, &[], "clumps that come in"),
        (body.to_owned(), &["--set", "contact.0.rolling_resistance=0.1"], "rolling_resistance with clumps"),
    ] {
        write(folder.path(), "s.toml", head.clone() + &more);
        let said = refusal(folder.path(), options);
        assert!(said.contains(words), "{words}: {said}");
    }
}
