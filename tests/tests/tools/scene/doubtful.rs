//! Warnings of implausible files and numbers, and everyday files that need none.

use super::with_particles_of_a_file;
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{Done, tool};
use std::fs;
use tempfile::tempdir;

const ONE: &str = "x,y,z,radius\n0,0,0.1,0.01\n";

fn checked(scene: &str, csv: &str) -> Done {
    let folder = folder(&[("s.toml", scene)]);
    fs::write(folder.path().join("p.csv"), csv).unwrap();
    tool(folder.path(), "dem-run", &["s.toml", "--check"])
}

fn says(scene: &str, csv: &str, code: i32, parts: &[&str]) -> Done {
    let done = checked(scene, csv);
    let all = parts.iter().all(|part| done.stderr.contains(part));
    assert!(done.code == code && all, "{csv}: {}: wanted {parts:?} in: {}", done.code, done.stderr);
    done
}

fn is_fine(scene: &str, csv: &str) {
    let done = says(scene, csv, 0, &[]);
    assert!(!done.stderr.contains("warning"), "{}", done.stderr);
}

fn warns(scene: &str, csv: &str, parts: &[&str]) {
    let done = says(scene, csv, 0, parts);
    assert!(done.stderr.contains("warning"), "{}", done.stderr);
}

fn refuses(scene: &str, csv: &str, parts: &[&str]) {
    let done = says(scene, csv, 1, parts);
    assert!(!done.stderr.contains("warning"), "{}", done.stderr);
}

#[test]
fn everyday_files_of_spreadsheets_are_read_and_wrong_columns_told() {
    let scene = with_particles_of_a_file();
    is_fine(&scene, ONE);
    is_fine(&scene, &format!("\u{feff}{ONE}"));
    says(&scene, "x,y,z,radius\n", 1, &["p.csv: holds no particle"]);
    refuses(&scene, "X,Y,Z,Radius\n0,0,0.1,0.01\n", &["'X' is there: did you mean 'x'?"]);
    warns(&scene, "x,y,z,radius,VX\n0,0,0.1,0.01,1\n", &["'VX' is not used", "did you mean vx?"]);
    let contradicts = ["row 0: radius 0.01 m and diameter 0.01 m contradict each other"];
    refuses(&scene, "x,y,z,radius,diameter\n0,0,0.1,0.01,0.01\n", &contradicts);
    is_fine(&scene, "x,y,z,radius,diameter\n0,0,0.1,0.01,0.02\n");
}

#[test]
fn doubtful_particles_are_told() {
    let scene = with_particles_of_a_file();
    let spin = "x,y,z,radius,wy\n0,0,0.1,0.01,50\n";
    is_fine(&scene, spin);
    let smooth = scene.replace("sliding_friction = 0.5\n", "");
    warns(&smooth, spin, &["p.csv: the spins", "not kept", "sliding_friction"]);
    let deep = "id,x,y,z,radius\n4,0,0,0.1,0.01\n9,0.0185,0,0.1,0.01\n";
    let overlap = ["particles 4 and 9 overlap by 1.500e-3 m", "15.0 % of the smaller radius", "[[fill]]"];
    warns(&scene, deep, &overlap);
    is_fine(&scene, &deep.replace("0.0185", "0.01995"));
    let in_floor = ["particle 0 and wall 'floor' overlap by 1.000e-3 m"];
    warns(&scene, "x,y,z,radius\n0,0,-0.001,0.01\n", &in_floor);
    let long = scene.replace("until = 0.01", "until = 1");
    let large = ["particle 0: radius = 10 m", "metres", "10 mm are 0.01"];
    warns(&long, "x,y,z,radius\n0,0,30,10\n", &large);
}

#[test]
fn doubtful_materials_are_told() {
    let scene = with_particles_of_a_file();
    let with_density = |density: &str| scene.replace("density = 3300", &format!("density = {density}"));
    let light = ["s.toml:6:11: material.0.density = 3.3 kg/m³", "if g/cm³ are meant, write 3300"];
    warns(&with_density("3.3"), ONE, &light);
    let heavy = ["material.0.density = 3300000 kg/m³", "if g/m³ are meant, write 3300"];
    warns(&with_density("3.3e6"), ONE, &heavy);
    let stiff = scene.replace("young = 2e8", "young = 2e13");
    warns(&stiff, ONE, &["material.1.young", "stiffer than diamond"]);
}

#[test]
fn what_begins_after_the_end_is_told() {
    let insert = |from: &str| {
        let grains = "[[insert]]\nmaterial = \"sinter\"\nshape = \"box:0,0,1,1,1,2\"\ndiameter = 0.02\nrate_count = 100\ncount = 3\nvelocity = [0, 0, -1]\n";
        format!("{}{grains}from = {from}\n", with_particles_of_a_file())
    };
    let late = ["insert.0.from = 5 s", "is not before the end of the run at 0.01 s", "a later time.until"];
    warns(&insert("5"), ONE, &late);
    is_fine(&insert("0.005"), ONE);
    refuses(&insert("1e308"), ONE, &["insert.0.from", "is outside the range", "give 0 to"]);
}

#[test]
fn corners_of_a_domain_that_are_turned_are_refused() {
    let domain = |low: &str| {
        let domain = "[domain]\nperiodic = [\"x\"]\nhigh = [1, 1, 1]\n";
        format!("{}{domain}low = {low}\n", with_particles_of_a_file())
    };
    refuses(&domain("[-1, 5, 0]"), ONE, &["domain.high = 1 m", "is below low, 5 m"]);
    is_fine(&domain("[-1, 1, 0]"), ONE);
}

/// With a servo the forces on walls are written, whatever the scene says.
#[test]
fn forces_that_a_servo_writes_cannot_be_left_out() {
    let lid = "[[wall]]\nname = \"lid\"\nplane = \"0,0,1,0,0,-1\"\nmaterial = \"sinter\"\nservo = { direction = [0, 0, -1], force = 1, \
               speed_limit = 0.1 }\n";
    let scene = |written| format!("{}{lid}[output]\nwall_forces = {written}\n", with_particles_of_a_file());
    warns(
        &scene("false"),
        ONE,
        &["output.wall_forces", "changes nothing: wall 'lid' has a servo", "take it out"],
    );
    is_fine(&scene("true"), ONE);
}

/// Rock of a file.
const ROCK: &str = r#"[time]
until = 0.1
[[material]]
name = "rock"
density = 2000
young = 1e7
poisson = 0.25
[[contact]]
between = ["rock", "rock"]
restitution = 0.5
[[particles]]
source = "p.csv"
material = "rock"
"#;

const HELD: &str = r#"[[particles]]
source = "held.csv"
material = "rock"
fixed = true
[[bond]]
between = ["rock", "rock"]
gap = 1e-4
young = 1e7
poisson = 0.25
"#;

/// A row of grains of which the first is fixed would fall: no bond holds to a wall.
#[test]
fn a_bond_that_fixed_grains_cannot_have_is_told() {
    let folder = tempdir().unwrap();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text).unwrap();
    write("s.toml", &[ROCK, HELD].concat());
    write("p.csv", "x,y,z,radius\n0.02,0,0,0.01\n0.04,0,0,0.01\n");
    for (held, told) in [(0.0, true), (-0.001, false)] {
        write("held.csv", &format!("x,y,z,radius\n{held},0,0,0.01\n"));
        let done = tool(folder.path(), "dem-run", &["s.toml", "--check"]);
        assert_eq!(done.code, 0, "{}", done.stderr);
        assert_eq!(done.stderr.contains("to which no bond holds"), told, "{}", done.stderr);
    }
}

const LID: &str = r#"[[wall]]
name = "box"
box = [-0.1, -0.1, 0, 0.1, 0.1, 0.2]
faces = ["x-", "x+", "y-", "y+", "z-"]
material = "rock"
[[wall]]
name = "lid"
plane = "0,0,0.2,0,0,-1"
material = "rock"
servo = { direction = [0, 0, -1], stress = 100, area_between = SIDES, speed_limit = 0.1 }
"#;

#[test]
fn sides_of_a_servo_lie_across_its_direction_and_are_two() {
    let scene = |sides: &str| [ROCK, &LID.replace("SIDES", sides)].concat();
    is_fine(&scene("[[\"box x-\", \"box x+\"], [\"box y-\", \"box y+\"]]"), ONE);
    let along = ["area_between = [\"box z-\", \"lid\"]: lie apart along the servo's direction"];
    refuses(&scene("[[\"box x-\", \"box x+\"], [\"box z-\", \"lid\"]]"), ONE, &along);
    let twice = ["give the length of one side twice"];
    refuses(&scene("[[\"box x-\", \"box x+\"], [\"box x+\", \"box x-\"]]"), ONE, &twice);
}

/// The faces of a box are planes without an end: grains above an open top cannot leave over the rim.
#[test]
fn grains_beyond_the_open_side_of_a_box_are_told() {
    let bin = |top: &str| {
        let faces = "faces = [\"x-\", \"x+\", \"y-\", \"y+\", \"z-\"]\nmaterial = \"rock\"\n";
        [ROCK, &format!("[[wall]]\nname = \"bin\"\nbox = [-0.1, -0.1, 0, 0.1, 0.1, {top}]\n{faces}")].concat()
    };
    is_fine(&bin("0.2"), ONE);
    let told = [
        "wall 'bin': 1 grain starts beyond the open side z+ of the box, at 0.05 m",
        "endless planes",
        "mesh",
    ];
    warns(&bin("0.05"), ONE, &told);
}

/// Of a key that is set twice the last value counts, and a warning has both.
#[test]
fn a_key_that_is_set_twice() {
    let folder = folder(&[("s.toml", super::SCENE)]);
    let sets = ["--set", "time.until=0.5", "--set", "gravity=[0,0,0]", "--set", "time.until=0.25"];
    let done = tool(folder.path(), "dem-run", &[&["s.toml", "--check"], &sets[..]].concat());
    assert_eq!(done.code, 0, "{}", done.stderr);
    let twice = "--set time.until=0.5: is set again, and time.until=0.25 counts";
    assert!(
        done.stderr.contains(twice) && done.stderr.matches("is set again").count() == 1,
        "{}",
        done.stderr
    );
}
