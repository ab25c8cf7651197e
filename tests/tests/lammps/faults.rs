//! LAMMPS that fails: its last words, the exit code, and the part of the run that viewers show. Scripts play LAMMPS, so that no test waits for a fault.

use crate::decks::scene;
use grainpipe_tests::tools::{Done, program, succeed, tool};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;
use tempfile::TempDir;

/// A script that plays LAMMPS: it answers `-h`, finds the dump, and writes the first frame; `$frames` is the dump, `$atoms` rows of 40 atoms at rest.
fn actor(folder: &Path, then: &str) -> String {
    let script = format!(
        "#!/bin/bash\n\
         [ \"$1\" = -h ] && {{ echo 'Large-scale Atomic/Molecular Massively Parallel Simulator - 29 Sep 2021'; exit; }}\n\
         frames=${{@: -1}}\n\
         frame() {{ echo \"ITEM: TIMESTEP\"; echo $1; echo \"ITEM: NUMBER OF ATOMS\"; echo 40; echo \"ITEM: BOX BOUNDS mm mm mm\"; \
         for k in 1 2 3; do echo 0 1; done; echo \"ITEM: ATOMS id x y z vx vy vz omegax omegay omegaz\"; \
         for k in $(seq 40); do echo $k 0.1 0.1 0.$k 0 0 0 0 0 0; done; }}\n\
         {{ frame 0\n{then}\n}} > $frames\n"
    );
    let path = folder.join("actor");
    fs::write(&path, script).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    path.display().to_string()
}

fn run(then: &str) -> (TempDir, Done) {
    let folder = scene();
    let lmp = actor(folder.path(), then);
    let done = tool(folder.path(), "dem-lammps", &["s.toml", "--lmp", &lmp, "-o", "run.mcap"]);
    (folder, done)
}

/// The part of the run that a failure leaves.
fn part(folder: &Path) -> Option<String> {
    let names =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned());
    names.into_iter().find(|name| name.ends_with(".part"))
}

/// A failure: exit code 1, words, no file under the final name, and a part that is shown.
fn fails(then: &str, words: &[&str]) {
    let (folder, done) = run(then);
    assert_eq!(done.code, 1, "{then}: {}", done.stderr);
    for word in words {
        assert!(done.stderr.contains(word), "{then}: {}", done.stderr);
    }
    assert!(!folder.path().join("run.mcap").exists());
    let part = part(folder.path()).expect("the part of the run");
    assert!(done.stderr.contains(&part), "{}", done.stderr);
    succeed(folder.path(), "dem-view", &[&part, "-o", "part.html", "-q"]);
}

#[test]
fn lammps_that_stops_with_an_error_is_quoted() {
    fails(
        "echo 'ERROR: Lost atoms: original 40 current 39 (src/thermo.cpp:438)' >&2; echo 'Last command: run 100' >&2; exit 1",
        &["exit code 1", "Lost atoms: original 40 current 39", "Last command: run 100"],
    );
}

#[test]
fn lammps_that_is_killed_is_reported() {
    fails("kill -9 $BASHPID $$", &["was killed (signal 9)"]);
}

/// A rank that is lost takes the launcher with it, which says so.
#[test]
fn a_lost_rank_is_reported() {
    let words = "mpirun noticed that process rank 1 with PID 7 on node here exited on signal 9 (Killed).";
    fails(&format!("echo '{words}' >&2; exit 137"), &["exit code 137", "process rank 1"]);
}

#[test]
fn a_dump_that_breaks_off_is_an_error() {
    fails("echo 'ITEM: TIMESTEP'; echo 20; echo 'ITEM: NUMBER OF ATOMS'; echo 40", &["ends inside a frame"]);
    fails("frame 20 | head -n 20", &["ends inside a frame"]);
    fails("true", &["ended before its last frame"]);
}

#[test]
fn wrong_frames_are_errors() {
    // The step of the second frame is 127.
    fails("frame 20", &["the next frame is that of step 20, and that of step 127 is missing"]);
    fails("frame 127 | sed 's/^7 0.1/7 nan/'", &["particle 6 has the value NaN"]);
    fails("frame 127 | sed 's/^7 0.1/99 0.1/'", &["atom 99 is no particle of the scene"]);
    fails("frame 127 | sed 's/^40$/39/' | head -n -1", &["39 atoms, and the scene has 40 particles"]);
    fails("frame 20 | sed 's/omegaz/omegaz type/'", &["its columns are"]);
}

/// LAMMPS that is missing or is another program.
#[test]
fn a_program_that_is_not_lammps_is_refused() {
    let folder = scene();
    let missing = tool(folder.path(), "dem-lammps", &["s.toml", "--lmp", "no-such-lammps", "-o", "x.mcap"]);
    assert_eq!(missing.code, 1);
    assert!(
        missing.stderr.contains("no-such-lammps: cannot start it")
            && missing.stderr.contains("apt install lammps"),
        "{}",
        missing.stderr
    );
    let other = tool(folder.path(), "dem-lammps", &["s.toml", "--lmp", "true", "-o", "x.mcap"]);
    assert!(other.code == 1 && other.stderr.contains("is not LAMMPS"), "{}", other.stderr);
    assert!(part(folder.path()).is_none());
}

/// A full disk ends LAMMPS and leaves no file that looks whole.
#[test]
fn a_full_disk_is_an_error() {
    let folder = scene();
    let lmp = actor(folder.path(), "for k in $(seq 20 20 2000); do frame $k; done; sleep 60");
    let done = tool(folder.path(), "dem-lammps", &["s.toml", "--lmp", &lmp, "-o", "/dev/full"]);
    assert_eq!(done.code, 1, "{}", done.stderr);
    assert!(done.stderr.contains("No space left on device"), "{}", done.stderr);
}

/// A signal ends LAMMPS, and the file is whole up to there: exit code 3.
#[test]
fn a_signal_ends_the_run_in_order() {
    let folder = scene();
    let lmp = actor(folder.path(), "sleep 60 & wait");
    let mut child = Command::new(program("dem-lammps"))
        .current_dir(folder.path())
        .args(["s.toml", "--lmp", &lmp, "-o", "run.mcap"])
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_millis(1500));
    let id = child.id().to_string();
    assert!(Command::new("kill").args(["-TERM", &id]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(3));
    assert_eq!(grainpipe_tests::recorded::frames(&folder.path().join("run.mcap")).len(), 1);
}
