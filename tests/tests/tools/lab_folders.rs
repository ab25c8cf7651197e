//! Folders of lab-test that several processes share, and specimens that others make.

use grainpipe_tests::lab::{ROCK, SAND, cube};
use grainpipe_tests::scenes::folder;
use grainpipe_tests::tools::{line, program, succeed, tool};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

const SHEAR: &[&str] =
    &["direct-shear", "sand.toml", "--grains", "200", "--stress", "1000", "--rows", "40", "--strain", "6%"];

/// Lines of `commands.sh` of all specimens in a folder that start with a program.
fn commands(dir: &Path, program: &str) -> usize {
    let specimens =
        fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_dir());
    let lines = |specimen: PathBuf| fs::read_to_string(specimen.join("commands.sh")).unwrap();
    specimens.map(|s| lines(s).lines().filter(|line| line.starts_with(program)).count()).sum()
}

/// Two processes on one folder make each specimen once and come to the same results; one with other options is refused while they work.
#[test]
fn two_processes_share_a_folder() {
    let lab = folder(&[("sand.toml", SAND.to_owned())]);
    let path = lab.path();
    let words = |out: &'static str| {
        [SHEAR, &["--seeds", "3", "--threads", "1", "--dir", "d", "-q", "-o", out]].concat()
    };
    let start = |words: &[&str]| {
        let mut command = Command::new(program("lab-test"));
        command.current_dir(path).args(words).spawn().unwrap()
    };
    let mut both = ["a.csv", "b.csv"].map(|out| start(&words(out)));
    while !path.join("d/stress=1000,seed=0/stamp").exists() {
        std::thread::sleep(Duration::from_millis(1));
    }
    let other = [SHEAR, &["--speed", "0.2", "--dir", "d", "-q", "-o", "c.csv"]].concat();
    let refused = tool(path, "lab-test", &other);
    assert!(both.iter_mut().all(|child| child.wait().unwrap().success()));
    assert!(refused.code == 1 && refused.stderr.contains("another process makes"), "{}", refused.stderr);
    assert!(fs::read(path.join("a.csv")).unwrap() == fs::read(path.join("b.csv")).unwrap());
    assert_eq!(commands(&path.join("d"), "dem-run"), 6, "each specimen is prepared and tested once");
    let left: Vec<_> = fs::read_dir(path.join("d")).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert!(left.len() == 3 && left.iter().all(|path| path.is_dir()), "{left:?}");
    succeed(path, "lab-test", &other);
    assert_eq!(commands(&path.join("d/"), "dem-run"), 6, "the folder of one specimen was emptied");
}

/// The lines of `--jobs-file` make the specimens, which the same command then evaluates; those that are made are in no line.
#[test]
fn listed_specimens_are_made_by_their_lines() {
    let lab = folder(&[("sand.toml", SAND.to_owned())]);
    let path = lab.path();
    let whole = [SHEAR, &["--seeds", "2", "-q"]].concat();
    succeed(path, "lab-test", &[&whole[..], &["--dir", "e", "-o", "a.csv"]].concat());
    let words = [&whole[..], &["--dir", "d", "--jobs-file", "jobs.txt", "-o", "b.csv"]].concat();
    succeed(path, "lab-test", &words);
    let jobs = fs::read_to_string(path.join("jobs.txt")).unwrap();
    assert!(jobs.lines().count() == 2 && !path.join("b.csv").exists(), "{jobs}");
    let run =
        |jobs: &str| jobs.lines().for_each(|job| assert_eq!(line(Path::new("/"), job).code, 0, "{job}"));
    run(jobs.lines().next().unwrap());
    succeed(path, "lab-test", &words);
    let left = fs::read_to_string(path.join("jobs.txt")).unwrap();
    assert_eq!(left.lines().collect::<Vec<_>>(), jobs.lines().skip(1).collect::<Vec<_>>());
    run(&left);
    let made = commands(&path.join("d"), "dem-run");
    succeed(path, "lab-test", &words);
    assert_eq!(fs::read_to_string(path.join("jobs.txt")).unwrap(), "");
    assert!(fs::read(path.join("a.csv")).unwrap() == fs::read(path.join("b.csv")).unwrap());
    assert_eq!((made, commands(&path.join("d"), "dem-run")), (4, 4), "nothing is made again");
    let stdin = tool(path, "lab-test", &["crush", "--dir", "e", "--jobs-file", "jobs.txt"]);
    assert!(
        stdin.code == 2 && stdin.stderr.contains("--jobs-file: its lines name the sample"),
        "{}",
        stdin.stderr
    );
}

/// A run that a signal has stopped goes on from its checkpoint, and everything is as if it had not been stopped.
#[test]
fn a_specimen_that_was_stopped_goes_on_where_it_was() {
    let lab = folder(&[("sand.toml", SAND.to_owned())]);
    let path = lab.path();
    let words = |out: &'static str, dir: &'static str| [SHEAR, &["-q", "--dir", dir, "-o", out]].concat();
    succeed(path, "lab-test", &words("once.csv", "e"));
    for run in ["prepare", "test"] {
        let specimen = path.join("d/stress=1000,seed=0");
        let child = Command::new(program("lab-test")).current_dir(path).args(words("a.csv", "d")).spawn();
        let mut child = child.unwrap();
        while !specimen.join(format!("{run}.mcap.part")).exists() {
            assert!(child.try_wait().unwrap().is_none(), "it has ended");
            std::thread::sleep(Duration::from_millis(1));
        }
        assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
        assert!(child.wait().unwrap().code() == Some(3) && !path.join("a.csv").exists());
        let report = fs::read_to_string(specimen.join(format!("{run}.json"))).unwrap();
        assert!(report.contains("by a signal"), "{report}");
    }
    succeed(path, "lab-test", &words("a.csv", "d"));
    assert!(fs::read(path.join("once.csv")).unwrap() == fs::read(path.join("a.csv")).unwrap());
    let made = fs::read_to_string(path.join("d/stress=1000,seed=0/commands.sh")).unwrap();
    for run in ["prepare", "test"] {
        let resumed = format!("-o {run}.mcap --resume {run}.stopped.mcap --whole");
        assert_eq!(made.matches(&resumed).count(), 1, "{made}");
        assert!(!path.join(format!("d/stress=1000,seed=0/{run}.stopped.mcap")).exists());
    }
}

/// A program that the user's signal has ended before lab-test has noticed its own is no failure; one that something else has killed is, and the message says so.
#[test]
fn a_program_that_a_signal_ended_is_told_from_one_that_was_killed() {
    let lab = folder(&[("stone.toml", ROCK.to_owned()), ("stone.csv", cube())]);
    let path = lab.path();
    for name in ["lab-test", "dem-measure"] {
        fs::copy(program(name), path.join(name)).unwrap();
    }
    for (signal, code, words) in [
        ("TERM", 3, "stopped by a signal: 0 of 1 specimens are finished"),
        ("INT", 3, "stopped by a signal: 0 of 1 specimens are finished"),
        ("HUP", 3, "stopped by a signal: 0 of 1 specimens are finished"),
        ("KILL", 1, "dem-run was killed by signal 9: it gave no reason; is there too little memory?"),
    ] {
        fs::write(path.join("dem-run"), format!("#!/bin/sh\nkill -{signal} $$\n")).unwrap();
        fs::set_permissions(path.join("dem-run"), fs::Permissions::from_mode(0o755)).unwrap();
        let done = line(path, "./lab-test crush stone.toml --strain 2% --speed 0.2 -q -o out.csv");
        assert!(done.code == code && done.stderr.contains(words), "{signal}: {}: {}", done.code, done.stderr);
        assert!(!path.join("out.csv").exists(), "{signal}");
    }
}
