//! What dem-measure says of runs whose answers are known.

mod below_a_hopper;
mod bonds;
mod brute;
mod cracks;
mod documented;
mod flow;
mod kinds;
mod lasting;
mod made;
mod refused;
mod specimen;
mod wall_forces;
mod worn;

use geom::Vec3;
use grainpipe_tests::tools::{Done, line, program, succeed, tool};
use made::{Chance, Grain, Made, at_rest, fcc, grain};
use serde_json::Value;
use std::f64::consts::PI;
use std::io::{BufRead, BufReader, Write};
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::time::Duration;
use tempfile::{TempDir, tempdir};

/// Saves a run as `run.mcap` in a separate folder.
fn saved(made: Made) -> TempDir {
    let folder = tempdir().unwrap();
    made.save(&folder.path().join("run.mcap"));
    folder
}

fn one_frame(scene: &str, grains: &[Grain]) -> TempDir {
    let mut made = Made::new(scene);
    made.frame(0.0, grains);
    saved(made)
}

fn measure(folder: &TempDir, arguments: &[&str]) -> Done {
    succeed(folder.path(), "dem-measure", &[&["run.mcap"], arguments].concat())
}

/// The column of a CSV that is called so, without its unit.
fn column(done: &Done, name: &str) -> Vec<f64> {
    let text = String::from_utf8_lossy(&done.stdout).into_owned();
    let mut lines = text.lines();
    let heads: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let at = heads.iter().position(|h| h.split(' ').next() == Some(name));
    let at = at.unwrap_or_else(|| panic!("{name} in {heads:?}"));
    lines.map(|l| l.split(',').nth(at).unwrap().parse().unwrap_or(f64::NAN)).collect()
}

/// A value of the sum, from the JSON.
fn sum(folder: &TempDir, arguments: &[&str], name: &str) -> f64 {
    let done = measure(folder, &[arguments, &["--json"]].concat());
    let json: Value = serde_json::from_slice(&done.stdout).unwrap();
    json["summary"][name]["value"].as_f64().unwrap_or(f64::NAN)
}

fn failed(folder: &TempDir, arguments: &[&str]) -> String {
    let done = tool(folder.path(), "dem-measure", &[&["run.mcap"], arguments].concat());
    assert_ne!(done.code, 0, "{arguments:?} must fail");
    done.stderr
}

/// A heap of grains of radius 5 mm whose centres lie on `height` of x, y, with noise of a third of a diameter.
fn heap(height: impl Fn(f64, f64) -> f64, seed: u64) -> Vec<Grain> {
    let mut chance = Chance(seed);
    let mut places = Vec::new();
    for i in -45..=45 {
        for j in -45..=45 {
            let x = (f64::from(i) + 0.8 * (chance.next() - 0.5)) * 0.007;
            let y = (f64::from(j) + 0.8 * (chance.next() - 0.5)) * 0.007;
            let h = height(x, y);
            places.push([x, y, if h > 0.0 { h + 0.0033 * chance.next() } else { 0.0 }]);
        }
    }
    at_rest(places, 0.005)
}

#[test]
fn a_noisy_cone_has_its_angle_within_the_interval() {
    let slope = 28f64.to_radians().tan();
    let mut grains = heap(|x, y| (0.28 - (x * x + y * y).sqrt()) * slope, 1);
    let folder = one_frame("", &grains);
    let (angle, interval) =
        (sum(&folder, &["--repose"], "angle"), sum(&folder, &["--repose"], "angle_interval"));
    assert!((angle - 28.0).abs() <= interval && interval < 0.6, "{angle} ± {interval}");
    // Grains in the air and a cone that lies on its side change nothing.
    let mut chance = Chance(7);
    for id in 0..60 {
        let place = [chance.next() - 0.5, chance.next() - 0.5, 0.3 + chance.next()].map(|v| 0.5 * v);
        grains.push(grain(100_000 + id, place, 0.005));
    }
    grains.iter_mut().for_each(|g| g.place = Vec3::new(g.place.z, g.place.x, g.place.y));
    let folder = one_frame("", &grains);
    let turned = sum(&folder, &["--repose", "--up", "1,0,0"], "angle");
    assert!((turned - 28.0).abs() <= interval + 0.2, "{turned}");
    // Gravity says the same.
    let folder = one_frame("gravity = [-9.81, 0, 0]", &grains);
    assert_eq!(sum(&folder, &["--repose"], "angle"), turned);
}

#[test]
fn a_heap_that_leans_on_a_wall_has_the_angle_of_its_slope() {
    let slope = 33f64.to_radians().tan();
    let folder = one_frame("", &heap(|x, _| (x + 0.1) * slope, 3));
    let options = ["--repose", "--side", "x+", "--sectors", "6"];
    let (angle, interval) = (sum(&folder, &options, "angle"), sum(&folder, &options, "angle_interval"));
    assert!((angle - 33.0).abs() <= interval && interval < 0.6, "{angle} ± {interval}");
    let picture = measure(&folder, &[&options[..], &["--plot", "heap.png"]].concat());
    assert_eq!(column(&picture, "angle").len(), 6);
    assert!(std::fs::read(folder.path().join("heap.png")).unwrap().starts_with(b"\x89PNG"));
}

/// Face-centred cubic: 12 contacts, φ = π/√18, in any slab that holds whole layers.
#[test]
fn a_dense_lattice_has_its_coordination_and_solid_fraction() {
    let a = 0.02;
    // A hair of overlap, which porosity takes off again.
    let radius = a / 8f64.sqrt() * (1.0 + 1e-9);
    let mut grains = at_rest(fcc(4, a), radius);
    grains.iter_mut().for_each(|g| g.velocity = Vec3::new(3.0, 0.0, if g.id % 2 == 0 { 4.0 } else { -4.0 }));
    let scene = "[domain]\nperiodic = [\"x\", \"y\", \"z\"]\nlow = [0, 0, 0]\nhigh = [0.08, 0.08, 0.08]\n";
    let folder = one_frame(scene, &grains);
    let done = measure(&folder, &["--contacts"]);
    assert_eq!((column(&done, "coordination"), column(&done, "rattlers")), (vec![12.0], vec![0.0]));
    assert_eq!(column(&done, "pairs"), [6.0 * 256.0]);
    let phi = PI / 18f64.sqrt();
    // Cells of the lattice hold as much wherever they begin.
    let inner = "box:0.023,0.027,0.031,0.063,0.067,0.071";
    for (shape, tolerance) in [(inner, 1e-8), ("sphere:0.04,0.04,0.04,0.03", 0.02)] {
        let found = 1.0 - sum(&folder, &["--porosity", shape], "porosity");
        assert!((found - phi).abs() < tolerance, "{shape}: {found}");
    }
    let done = measure(&folder, &["--profile", "--within", inner, "--bins", "4", "--field", "radius"]);
    for (k, found) in column(&done, "solid_fraction").into_iter().enumerate() {
        assert!((found - phi).abs() < 1e-8, "slab {k}: {found}");
    }
    assert!(column(&done, "vx").iter().all(|v| (v - 3.0).abs() < 1e-9));
    assert!(column(&done, "radius").iter().all(|r| (r - radius).abs() < 1e-9));
    let heat = column(&done, "granular_temperature");
    assert!(heat.iter().all(|t| (t - 16.0 / 3.0).abs() < 0.5), "{heat:?}");
}

#[test]
fn velocities_are_weighted_by_mass() {
    let heavy = Grain { velocity: Vec3::x(), ..grain(0, [0.3, 0.5, 0.5], 0.1) };
    let light = Grain { velocity: Vec3::zeros(), material: 1, ..grain(1, [0.7, 0.5, 0.5], 0.1) };
    let mut made = Made::new("");
    made.frame(0.0, &[heavy, light]).frame(1.0, &[heavy]);
    let folder = saved(made);
    let options = ["--profile", "--within", "box:0,0,0,1,1,1", "--bins", "1", "--mean"];
    let done = measure(&folder, &options);
    assert!(
        (column(&done, "vx")[0] - 5000.0 / 6000.0).abs() < 1e-11,
        "two frames of the heavy, one of the light"
    );
    let volume = 4.0 / 3.0 * PI * 0.001;
    assert!((column(&done, "solid_fraction")[0] - 1.5 * volume).abs() < 1e-12);
    // Down a slope of 30°: x goes along it, z away from it. The box moves with the axes.
    let slope = ["--profile", "--turn-deg", "y,30", "--within", "box:-0.2,0,0.3,0.2,1,0.9", "--bins", "1"];
    let done = measure(&folder, &[&slope[..], &["--last"]].concat());
    assert!((column(&done, "vx")[0] - 0.75_f64.sqrt()).abs() < 1e-12, "cos 30°");
    assert!((column(&done, "vz")[0] - 0.5).abs() < 1e-12, "sin 30°");
    assert!(
        (column(&done, "solid_fraction")[0] * 0.24 - volume).abs() < 1e-12,
        "0.01 m along x, 0.58 m along z"
    );
}

#[test]
fn mixed_and_segregated_beds_have_indices_1_and_0() {
    let mut chance = Chance(5);
    let lattice =
        (0..12 * 12 * 12).map(|k| [k % 12, k / 12 % 12, k / 144].map(|i| (f64::from(i) + 0.5) * 0.01));
    let mut grains = at_rest(lattice, 0.004);
    let options = ["--segregation", "--kind", "b", "--cell", "0.03"];
    grains.iter_mut().for_each(|g| g.material = u16::from(g.place.z > 0.06));
    let folder = one_frame("", &grains);
    assert!(sum(&folder, &options, "lacey_index").abs() < 1e-12);
    // Of lighter grains, whose bed is two halves of unequal mass.
    let difference = sum(&folder, &options, "centre_difference");
    assert!((difference - 1.0).abs() < 0.12 && difference > 0.0, "{difference}");
    grains.iter_mut().for_each(|g| g.material = u16::from(chance.next() < 0.4));
    let folder = one_frame("", &grains);
    let (index, difference) =
        (sum(&folder, &options, "lacey_index"), sum(&folder, &options, "centre_difference"));
    // 64 cells of 27: the index of a random mixture deviates by √(2/63)/26 = 0.007.
    assert!((index - 1.0).abs() < 0.02 && difference.abs() < 0.1, "{index} {difference}");
    // By size, where it is the size that differs.
    grains.iter_mut().for_each(|g| g.radius = if g.place.z > 0.06 { 0.0045 } else { 0.004 });
    let folder = one_frame("", &grains);
    let by_size = ["--segregation", "--split", "0.0085", "--cell", "0.03"];
    assert!(sum(&folder, &by_size, "lacey_index").abs() < 1e-12);
    assert!(failed(&folder, &["--segregation", "--split", "1"]).contains("only one kind of grains"));
}

#[test]
fn the_ledger_closes_where_no_grain_enters() {
    let mut made = Made::new("");
    let ledger = |k: f64, balance: f64| {
        format!(r#"{{"translation": {k}, "potential": {}, "bonds": 0.5, "balance": {balance}}}"#, -k)
    };
    let one = [grain(0, [0.0; 3], 0.01)];
    let two = [one[0], grain(1, [1.0; 3], 0.01)];
    made.frame(0.0, &one).json("/energy", 0.0, &ledger(0.0, 1.0));
    made.frame(0.1, &one).json("/energy", 0.1, &ledger(2.0, 1.001));
    made.frame(0.2, &two).json("/energy", 0.2, &ledger(4.0, 7.0));
    made.frame(0.3, &two).json("/energy", 0.3, &ledger(4.0, 6.998));
    let folder = saved(made);
    let done = measure(&folder, &["--energy", "--plot", "energy.svg"]);
    let expected = [0.0, 0.001, 0.001, -0.001];
    for (found, expected) in column(&done, "closure_error").iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
    assert_eq!(column(&done, "bonds"), [0.5; 4]);
    assert!((column(&done, "closure_relative")[3] + 0.00025).abs() < 1e-12, "of the 4 J exchanged");
    assert!(done.stderr.contains("1 interval left out"), "{}", done.stderr);
    assert!(std::fs::read(folder.path().join("energy.svg")).unwrap().starts_with(b"<svg"));
}

/// Grain 0 on the floor and against grain 1; grain 2 touches nothing.
fn with_contacts() -> TempDir {
    let mut made = Made::new("");
    made.json("/surfaces", 0.0, r#"[{"name": "floor"}, {"name": "side"}]"#);
    made.wall_spheres(&[[0.0, 0.0, -0.01], [0.02, 0.0, -0.01], [0.04, 0.0, -0.01]]);
    let grains = at_rest([[0.0, 0.0, 0.01], [0.02, 0.0, 0.01], [0.5, 0.5, 0.5]], 0.01);
    let (x, z) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]);
    for (time, push) in [(0.0, 2.0), (0.1, 4.0)] {
        made.frame(time, &grains).contacts(
            time,
            &[
                (0, 1, false, [0.01, 0.0, 0.01], [-1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], 0.0),
                (0, 1, false, [0.01, 0.0, 0.01], [-1.0, 0.0, 0.0], [-3.0, 0.0, 0.5], 0.0),
                (0, 0, true, [0.0; 3], z, [0.5, 0.0, push], 0.125),
                // Ended since the frame before: their work counts, they do not.
                (2, 0, true, [0.0; 3], z, [0.0; 3], 0.125),
                (1, 2, false, [0.02, 0.0, 0.02], z, [0.0; 3], 0.5),
                (1, 0, true, [0.028, 0.0, -0.005], z, [0.0, 0.0, 1.0], 0.5),
                (1, 1, true, [0.03, 0.0, 0.01], x, [7.0, 0.0, 0.0], 0.0),
            ],
        );
    }
    saved(made)
}

#[test]
fn recorded_contacts_give_numbers_forces_and_wear() {
    let folder = with_contacts();
    let done = measure(&folder, &["--contacts", "--last"]);
    assert_eq!((column(&done, "pairs"), column(&done, "wall_contacts")), (vec![1.0], vec![3.0]));
    assert!((column(&done, "coordination")[0] - 2.0 / 3.0).abs() < 1e-11);
    // Grain 0 has two, grain 1 three, grain 2 rattles.
    assert_eq!(column(&done, "mechanical_coordination"), [2.5]);
    assert!((column(&done, "rattlers")[0] - 1.0 / 3.0).abs() < 1e-11);
    let done = measure(&folder, &["--forces"]);
    let normal = column(&done, "normal");
    // 1 N and 3 N: half and one and a half of the mean.
    assert_eq!((normal[2], normal[7], normal.iter().sum::<f64>()), (1.0, 1.0, 2.0));
    assert!((column(&done, "normal_density")[2] - 2.5).abs() < 1e-12);
    assert!((sum(&folder, &["--forces"], "mean_tangential") - 0.25).abs() < 1e-12);
    let floor = measure(&folder, &["--wall-force", "all", "--wall", "floor"]);
    assert_eq!((column(&floor, "fz"), column(&floor, "fx")), (vec![-3.0, -5.0], vec![-0.5, -0.5]));
    assert_eq!(column(&floor, "sliding_work_sum"), [0.75, 1.5]);
    let left = measure(&folder, &["--wall-force", "box:-1,-1,-1,0.01,1,1"]);
    assert_eq!(column(&left, "fz"), [-2.0, -4.0]);
    let wear = measure(&folder, &["--wear", "all", "--wall", "0", "--plot", "wear.png"]);
    assert_eq!(
        (column(&wear, "x"), column(&wear, "sliding_work")),
        (vec![0.0, 0.02, 0.04], vec![0.5, 1.0, 0.0])
    );
    assert_eq!(
        (column(&wear, "mean_normal"), column(&wear, "largest_normal")),
        (vec![3.0, 1.0, 0.0], vec![4.0, 1.0, 0.0]),
        "a sphere that nothing touched has a row, too"
    );
    let cells = measure(&folder, &["--wear", "all", "--wall", "floor", "--cell", "0.02"]);
    assert_eq!(
        (column(&cells, "x"), column(&cells, "work_per_area")),
        (vec![0.01, 0.03], vec![1250.0, 2500.0])
    );
}

/// A ball falls freely from z = 0.3 m, without speed, past a plane and through a box: dem-run and dem-measure in a pipe.
#[test]
fn a_falling_ball_is_timed_in_a_pipe() {
    let folder = tempdir().unwrap();
    let scene = "gravity = [0, 0, -9.81]\n[time]\nuntil = 0.3\n[output]\nevery = 0.02\n[[material]]\nname = \"m\"\n\
        density = 2500\nyoung = 1e6\npoisson = 0.3\n[[contact]]\nbetween = [\"*\", \"*\"]\nrestitution = 0.5\n\
        [[particles]]\nsource = \"balls.csv\"\nmaterial = \"m\"\n";
    std::fs::write(folder.path().join("fall.toml"), scene).unwrap();
    std::fs::write(folder.path().join("balls.csv"), "id,x,y,z,radius\n5,0,0,0.3,0.01\n").unwrap();
    let fall = |height: f64| (2.0 * height / 9.81).sqrt();
    let done = line(folder.path(), "dem-run fall.toml | dem-measure - --residence box:-1,-1,0.05,1,1,0.2");
    assert_eq!(done.code, 0, "{}", done.stderr);
    let (entered, left) = (column(&done, "entered")[0], column(&done, "left")[0]);
    assert!((entered - fall(0.1)).abs() < 1e-6 && (left - fall(0.25)).abs() < 1e-6, "{entered} {left}");
    assert!((column(&done, "residence")[0] - (fall(0.25) - fall(0.1))).abs() < 1e-6);
    let done = line(folder.path(), "dem-run fall.toml | dem-measure - --flow 0,0,0.1,0,0,-1 --span 0.01");
    let passed = column(&done, "forward").iter().position(|n| *n == 1.0).unwrap();
    assert_eq!(passed, (fall(0.2) / 0.01) as usize, "{}", done.stderr);
}

/// Rows come while the run is still being written.
#[test]
fn rows_come_as_the_run_grows() {
    let folder = tempdir().unwrap();
    let mut command = Command::new(program("dem-measure"));
    command.current_dir(folder.path()).args(["-", "--porosity", "box:0,0,0,1,1,1"]);
    let mut child =
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    let (mut to, from) = (child.stdin.take().unwrap(), child.stdout.take().unwrap());
    let mut made = Made::new("");
    made.frame(0.0, &[grain(0, [0.5; 3], 0.1)]);
    made.0.flush_chunk().unwrap();
    made.frame(0.1, &[grain(0, [0.5; 3], 0.1)]);
    let bytes = made.0.finish().unwrap();
    // The second frame and the end are held back.
    let cut = bytes.len() * 3 / 5;
    to.write_all(&bytes[..cut]).unwrap();
    // In a thread of its own: a tool that holds its rows back fails here and does not hang.
    let (send, lines) = mpsc::channel();
    std::thread::spawn(move || {
        BufReader::new(from).lines().map_while(Result::ok).try_for_each(|l| send.send(l))
    });
    let first =
        [0, 1].map(|_| lines.recv_timeout(Duration::from_secs(20)).expect("rows come before the end"));
    assert!(first[0].starts_with("time [s],porosity [1]") && first[1].starts_with("0,0.99581"), "{first:?}");
    to.write_all(&bytes[cut..]).unwrap();
    drop(to);
    assert_eq!(lines.iter().count(), 1);
    assert!(child.wait().unwrap().success());
}

#[test]
fn the_same_bytes_for_any_number_of_threads() {
    let slope = 0.5;
    let folder = one_frame("", &heap(|x, y| (0.28 - (x * x + y * y).sqrt()) * slope, 1));
    for options in
        [&["--repose"][..], &["--porosity", "cylinder:0,0,0,0,0,0.1,0.1"], &["--profile"], &["--contacts"]]
    {
        let [one, many] = ["1", "3"].map(|n| measure(&folder, &[options, &["--threads", n]].concat()).stdout);
        assert_eq!(one, many, "{options:?}");
    }
}

/// A frame that is due at 0.3 s is written at the step nearest to it.
#[test]
fn times_are_those_that_frames_are_due_at() {
    let mut made = Made::new("gravity = [0, 0, -9.81]\n");
    made.record("time", &[("dt", "0.001"), ("start", "0"), ("end", "1")]);
    for (time, z) in [(0.0, 1.0), (0.1004, 2.0), (0.1996, 3.0), (0.3003, 4.0)] {
        made.frame(time, &[grain(0, [0.0, 0.0, z], 0.01)]);
    }
    let folder = saved(made);
    let times = |words: &[&str]| column(&measure(&folder, &[&["--bed-height"], words].concat()), "time");
    assert_eq!(times(&["--time", "0.1"]), [0.1004]);
    assert_eq!(times(&["--time", "0.3"]), [0.3003]);
    assert_eq!(times(&["--time", "0.099"]), [0.1004], "the nearest, as in pictures");
    assert_eq!(times(&["--time", "0.049"]), [0.0]);
    assert_eq!(times(&["--from", "0.2", "--until", "0.3"]), [0.1996, 0.3003]);
}

/// Grains that leave the box of the first frame are in the profile of a file; of a pipe it is said what is not.
#[test]
fn a_mean_profile_is_around_the_grains_of_all_frames() {
    let mut made = Made::new("gravity = [0, 0, -9.81]\n");
    made.frame(0.0, &[grain(0, [0.0; 3], 0.01), grain(1, [0.1, 0.0, 0.0], 0.01)]);
    made.frame(0.1, &[grain(0, [0.0; 3], 0.01), grain(1, [0.5, 0.0, 0.0], 0.01)]);
    let folder = saved(made);
    let words = ["--profile", "--axis", "x", "--bins", "2", "--mean"];
    let file = measure(&folder, &words);
    assert!((column(&file, "grains").iter().sum::<f64>() - 2.0).abs() < 1e-9);
    assert!(!file.stderr.contains("outside this grid"), "{}", file.stderr);
    let piped = line(folder.path(), &format!("cat run.mcap | dem-measure {}", words.join(" ")));
    assert!(piped.stderr.contains("25.0 % of the grains are outside this grid"), "{}", piped.stderr);
    assert!(piped.stderr.contains("--within box:-0.01,-0.01,-0.01,0.51,0.01,0.01"), "{}", piped.stderr);
}

/// A ball on an edge of a periodic box is in it whole, in four parts.
#[test]
fn a_ball_across_periodic_faces_is_in_the_box_whole() {
    let mut made = Made::new("[domain]\nperiodic = [\"x\", \"y\"]\nlow = [0, 0, 0]\nhigh = [1, 1, 1]\n");
    made.frame(0.0, &[grain(0, [0.02, 0.99, 0.5], 0.1), grain(1, [0.5, 0.5, 0.5], 0.1)]);
    let folder = saved(made);
    let solid = sum(&folder, &["--porosity", "box:0,0,0,1,1,1"], "solid_fraction");
    assert!((solid - 2.0 * 4.0 / 3.0 * PI * 1e-3).abs() < 1e-12, "{solid}");
    for within in [&[][..], &["--within", "box:0,0,0,1,1,1"]] {
        let done = measure(&folder, &[&["--profile", "--bins", "2,2,1"], within].concat());
        let grains = column(&done, "grains");
        assert!((grains.iter().sum::<f64>() - 2.0).abs() < 1e-9, "{grains:?}");
    }
    // Once each, also where the grid is turned or larger than the box.
    for words in [&["--within", "box:-0.2,-0.2,0,1.2,1.2,1"][..], &["--turn-deg", "z,45"]] {
        let grains =
            column(&measure(&folder, &[&["--profile", "--bins", "1,1,1"], words].concat()), "grains");
        assert!((grains[0] - 2.0).abs() < 1e-9, "{words:?}: {grains:?}");
    }
    // A shape beyond the faces holds images: the ball on the edge is in it four times.
    let beyond = sum(&folder, &["--porosity", "box:-0.2,-0.2,0,1.2,1.2,1"], "solid_fraction") * 1.4 * 1.4;
    assert!((beyond - 5.0 * 4.0 / 3.0 * PI * 1e-3).abs() < 1e-12, "{beyond}");
}
