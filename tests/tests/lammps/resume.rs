//! Runs that go on: a killed `dem-lammps --dir`, and a batch script that is submitted again, come to the frames of an undisturbed run.

use crate::lmp;
use grainpipe_tests::recorded::{column, frames};
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{program, succeed, tool};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// A pair that meets obliquely, and a grain that strikes a floor obliquely, both in contact for most of the run, with friction: what is kept has to
/// hold the springs. They do not feel each other. An outlet is crossed by a third one, and a fourth one comes in.
const IMPACTS: &str = "gravity = [0, 0, 0]
[time]
until = 1e-3
dt = 4e-9
[output]
every = 2e-5
checkpoint = 1e-4
[[material]]
name = \"glass\"
density = 2500
young = 1e7
poisson = 0.25
[[contact]]
between = [\"*\", \"*\"]
law = \"hertz\"
restitution = 0.7
sliding_friction = 0.3
[[particles]]
source = \"grains.csv\"
material = \"glass\"
[[insert]]
material = \"glass\"
shape = \"box:0.095,-0.005,0.05,0.105,0.005,0.055\"
velocity = [0, 0, -5]
diameter = 0.004
count = 1
rate = 0.1
[[wall]]
name = \"floor\"
plane = \"0,0,0,0,0,1\"
material = \"glass\"
[[outlet]]
plane = \"0,0,0.2,0,0,1\"
";

const GRAINS: &str = "x,y,z,radius,vx,vy,vz\n-0.005,0,0.05,0.005,1,0.2,0\n0.005,0,0.05,0.005,-1,-0.1,0\n0.05,0,0.005,0.005,0.6,0,-1\n\
    0.05,0.05,0.1995,0.005,0,0,1\n";

fn impacts() -> TempDir {
    folder(&[("s.toml", IMPACTS), ("grains.csv", GRAINS)])
}

/// Whether runs are alike to rounding: a state that is kept makes neighbour lists new, and so another order of sums.
fn alike(folder: &Path, names: [&str; 2]) {
    let [a, b] = names.map(|name| frames(&folder.join(name)));
    assert_eq!((a.len(), b.len()), (51, 51));
    // Each over the size of what is compared.
    let columns = [("x", 0.005), ("y", 0.005), ("z", 0.005), ("vx", 1.0), ("vy", 1.0), ("vz", 1.0)];
    let spins = [("wx", 200.0), ("wy", 200.0), ("wz", 200.0)];
    for (k, (a, b)) in a.iter().zip(&b).enumerate() {
        assert_eq!(column(a, "id"), column(b, "id"));
        for (name, size) in columns.into_iter().chain(spins) {
            for (a, b) in column(a, name).into_iter().zip(column(b, name)) {
                assert!((a - b).abs() < 1e-9 * size, "frame {k}, {name}: {a} {b}");
            }
        }
    }
}

/// Waits until a file is there, and is whole.
fn wait_for(path: &Path) {
    let since = Instant::now();
    while !fs::read(path).is_ok_and(|bytes| bytes.ends_with(b"RestartT\0")) {
        assert!(since.elapsed() < Duration::from_secs(60), "{} does not come", path.display());
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Whether another process works in the folder: LAMMPS is not started then.
fn in_use(path: &Path) -> bool {
    let lock = fs::File::options().append(true).open(path.join("kept/lock")).unwrap();
    lock.try_lock().is_err()
}

#[test]
fn a_killed_run_goes_on_from_its_folder() {
    if !lmp() {
        return;
    }
    let folder = impacts();
    let path = folder.path();
    succeed(path, "dem-lammps", &["s.toml", "-q", "-o", "whole.mcap"]);
    // A start that goes on from one state writes the other one first.
    for state in ["state_1", "state_2"] {
        let mut child = Command::new(program("dem-lammps"))
            .current_dir(path)
            .args(["s.toml", "-q", "--dir", "kept", "-o", "again.mcap"])
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        wait_for(&path.join("kept").join(state));
        child.kill().unwrap();
        child.wait().unwrap();
        // The LAMMPS of a killed one ends with its next line; until then it holds the folder.
        let since = Instant::now();
        while in_use(path) {
            assert!(since.elapsed() < Duration::from_secs(60));
            std::thread::sleep(Duration::from_millis(20));
        }
        assert!(!path.join("again.mcap").exists());
    }
    let report = ["s.toml", "-q", "--dir", "kept", "--report", "r.json", "-o", "again.mcap"];
    succeed(path, "dem-lammps", &report);
    let report = fs::read_to_string(path.join("r.json")).unwrap();
    assert!(report.contains("\"crossings\": 1,"), "samples of all starts: {report}");
    assert!(path.join("kept/frames-3.dump").exists(), "it was started three times");
    alike(path, ["whole.mcap", "again.mcap"]);
    // A finished run is read again; two at a time are refused.
    let done = succeed(path, "dem-lammps", &["s.toml", "--dir", "kept", "-o", "third.mcap"]);
    assert!(done.stderr.contains("kept: all steps are done: its frames are read"), "{}", done.stderr);
    assert!(!path.join("kept/frames-4.dump").exists());
    alike(path, ["again.mcap", "third.mcap"]);
    let lock = fs::File::options().append(true).open(path.join("kept/lock")).unwrap();
    lock.lock().unwrap();
    let busy = tool(path, "dem-lammps", &["s.toml", "--dir", "kept", "-o", "x.mcap"]);
    assert!(busy.code == 1 && busy.stderr.contains("another dem-lammps works there"), "{}", busy.stderr);
    drop(lock);
    // The folder is read like a deck that ran elsewhere; it belongs to this scene alone.
    succeed(path, "dem-lammps", &["s.toml", "-q", "--read-dump", "kept/frames.dump", "-o", "read.mcap"]);
    alike(path, ["again.mcap", "read.mcap"]);
    let other = tool(
        path,
        "dem-lammps",
        &["s.toml", "--set", "contact.0.restitution=0.6", "--dir", "kept", "-o", "x.mcap"],
    );
    assert!(
        other.code == 1 && other.stderr.contains("kept: holds another run: in its run.in, 'pair_coeff"),
        "{}",
        other.stderr
    );
}

/// Files that were cut off, and decks that are overwritten, are errors, not shorter or other runs.
#[test]
fn nothing_is_lost_without_a_word() {
    if !lmp() {
        return;
    }
    let folder = impacts();
    let path = folder.path();
    let short = ["s.toml", "--until", "2e-4", "--dir", "kept", "-o", "run.mcap"];
    succeed(path, "dem-lammps", &short);
    let frames = path.join("kept/frames.dump");
    let text = fs::read_to_string(&frames).unwrap();
    let third = text.match_indices("ITEM: TIMESTEP").nth(3).unwrap().0;
    let whole = text.len();
    for (cut, rest) in [(third, ""), (0, &text[third..])] {
        fs::write(&frames, [&text[..cut], rest].concat()).unwrap();
        let done = tool(path, "dem-lammps", &short);
        assert!(done.code == 1 && whole > 0, "{}", done.stderr);
        assert!(
            done.stderr.contains("is missing") || done.stderr.contains("it ends there"),
            "{}",
            done.stderr
        );
    }
    // States that are gone: it begins again, and says so.
    fs::remove_file(path.join("kept/finished")).unwrap();
    ["state_1", "state_2"].iter().for_each(|name| drop(fs::write(path.join("kept").join(name), "torn")));
    let again = succeed(path, "dem-lammps", &short);
    assert!(again.stderr.contains("has no whole state: the run begins again"), "{}", again.stderr);
    assert_eq!(fs::read_to_string(&frames).unwrap(), text);
    // A deck is not written over one that has run.
    let deck = ["s.toml", "--until", "2e-4", "--lmp", "lmp", "--write-deck", "kept"];
    succeed(path, "dem-lammps", &deck);
    let other = tool(path, "dem-lammps", &["s.toml", "--lmp", "lmp", "--write-deck", "kept"]);
    assert!(other.code == 1 && other.stderr.contains("kept: holds another run"), "{}", other.stderr);
}

/// A script plays Slurm's `srun`: it runs LAMMPS, and ends it when a state is whole, as a time limit does.
#[test]
fn a_batch_script_that_is_submitted_again_goes_on() {
    if !lmp() {
        return;
    }
    let folder = impacts();
    let path = folder.path();
    succeed(path, "dem-lammps", &["s.toml", "-q", "-o", "whole.mcap"]);
    succeed(path, "dem-lammps", &["s.toml", "-q", "--lmp", "lmp", "--write-deck", "deck"]);
    let bin = path.join("bin");
    fs::create_dir(&bin).unwrap();
    let srun = "#!/bin/bash\n\"$@\" > /dev/null & lmp=$!\n[ -e second ] && { wait $lmp; exit; }\n\
        while kill -0 $lmp && ! tail -c 16 state_1 2> /dev/null | grep -aq RestartT; do sleep 0.01; done\nkill -9 $lmp\ntouch second\n";
    fs::write(bin.join("srun"), srun).unwrap();
    fs::set_permissions(bin.join("srun"), fs::Permissions::from_mode(0o755)).unwrap();
    let search = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap());
    for _ in 0..2 {
        Command::new("bash")
            .arg("batch.sh")
            .current_dir(path.join("deck"))
            .env("PATH", &search)
            .output()
            .unwrap();
    }
    assert!(path.join("deck/frames-2.dump").exists());
    succeed(path, "dem-lammps", &["s.toml", "-q", "--read-dump", "deck/frames.dump", "-o", "read.mcap"]);
    alike(path, ["whole.mcap", "read.mcap"]);
}
