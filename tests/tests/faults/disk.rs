//! A full disk: every tool says so and leaves nothing that looks whole; what a run had written until then stays and resumes.

use crate::pipes::{COMMANDS, plant};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::recorded::frames;
use grainpipe_tests::tools::{Done, line, succeed, tool};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const FULL: Case = case("Faults", "the disk is full: a message, code 1, and no file that looks whole");
const KEPT: Case = case("Faults", "the disk is full: the output so far is kept and resumes");

fn said(done: &Done, command: &str) -> bool {
    let tool = command.split(' ').next().unwrap_or_default();
    let said = done.code == 1
        && done.stderr.starts_with(&format!("{tool}: "))
        && done.stderr.contains("No space left on device")
        && !done.stderr.contains("panicked");
    if !said {
        println!("{command}: {} {}", done.code, done.stderr);
    }
    said
}

/// `/dev/full` takes no byte, as a stream and as a file.
#[test]
fn every_tool_says_that_the_disk_is_full() {
    let folder = plant();
    let mut silent = 0u32;
    for command in COMMANDS {
        silent += u32::from(!said(&line(folder.path(), &format!("{command} > /dev/full")), command));
        let named =
            if command.starts_with("dem-view") { continue } else { format!("{command} -o /dev/full") };
        silent += u32::from(!said(&line(folder.path(), &named), command));
    }
    FULL.within("every tool, to a device that is full", f64::from(silent), "tools", 0.0);
}

/// A disk of some kB; `None`, with a message, where mounting is not allowed.
struct Disk(PathBuf);

impl Disk {
    fn new(folder: &Path, size: &str) -> Option<Disk> {
        let path = folder.join("disk");
        fs::create_dir(&path).expect("a folder");
        let options = format!("size={size}");
        let mounted =
            Command::new("mount").args(["-t", "tmpfs", "-o", &options, "tmpfs"]).arg(&path).output();
        if mounted.is_ok_and(|m| m.status.success()) {
            return Some(Disk(path));
        }
        // Needs root, which no program can bring: not `skip`, which fails where a program is missing.
        eprintln!("skipped: a disk of {size} cannot be mounted here (needs root)");
        None
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg("-l").arg(&self.0).status();
    }
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
}

#[test]
fn no_tool_leaves_a_file_on_a_full_disk() {
    let folder = plant();
    let Some(disk) = Disk::new(folder.path(), "8k") else { return };
    let mut wrong = 0u32;
    for command in COMMANDS {
        // Smaller than two pages: it fits, and is no case.
        if command.starts_with("stage-split") || command.starts_with("dem-measure") {
            continue;
        }
        let ending = match command.split(['-', ' ']).next() {
            Some("cloud" | "bluenoise") => "ply",
            _ if command.starts_with("dem-view") => "html",
            _ => "mcap",
        };
        let done = line(folder.path(), &format!("{command} -o disk/x.{ending}"));
        let left = names(&disk.0);
        println!("{command}: left {left:?}");
        wrong += u32::from(!said(&done, command) || left.iter().any(|name| !name.ends_with(".part")));
        left.iter().for_each(|name| fs::remove_file(disk.0.join(name)).expect("it can be removed"));
    }
    FULL.within("every tool, to a disk of 8 kB", f64::from(wrong), "tools", 0.0);
}

#[test]
fn a_run_that_fills_the_disk_is_kept_and_goes_on_elsewhere() {
    let folder = plant();
    let folder = folder.path();
    let half = fs::metadata(folder.join("run.mcap")).expect("whole").len() / 2;
    let Some(disk) = Disk::new(folder, &half.to_string()) else { return };
    let done = tool(folder, "dem-run", &["s.toml", "-o", "disk/run.mcap"]);
    assert!(said(&done, "dem-run"));
    KEPT.refused(
        "a run on a disk of half its size",
        &done.stderr,
        &["is kept in ", "disk/run.mcap.part", "--resume", "No space left"],
    );
    assert_eq!(names(&disk.0), ["run.mcap.part"]);
    let done = succeed(folder, "dem-run", &["s.toml", "--resume", "disk/run.mcap.part", "-o", "rest.mcap"]);
    assert!(done.stderr.contains("frames"), "{}", done.stderr);
    let last = |name: &str| frames(&folder.join(name)).pop();
    let differs = last("rest.mcap") != last("run.mcap");
    KEPT.within(
        "last frame of the resumed run against the uninterrupted one",
        f64::from(u8::from(differs)),
        "frames",
        0.0,
    );
}

#[test]
fn a_calibration_that_fills_the_disk_goes_on_elsewhere_to_the_same_end() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let recipe = "[settings]\ntrials = 12\nfirst = 8\n[[parameter]]\nname = \"mu\"\nbounds = [0.1, 0.9]\n\
        [[test]]\nname = \"angle\"\ncommand = \"awk 'BEGIN { print 20 + 10 * {mu} + 0.01 * {seed} }'\"\nvalue = 25\ndeviation = 0.5\n";
    fs::write(folder.join("recipe.toml"), recipe).expect("a file");
    let calibrate = |dir: &str, out: &str| {
        tool(folder, "calibrate", &["recipe.toml", "-q", "--jobs", "1", "--dir", dir, "-o", out])
    };
    assert_eq!(calibrate("whole", "whole.csv").code, 0);
    let Some(disk) = Disk::new(folder, "160k") else { return };
    let done = calibrate("disk/trials", "found.csv");
    assert!(said(&done, "calibrate"));
    KEPT.refused("a calibration on a disk of 160 kB", &done.stderr, &["is the disk full?", "disk/trials/"]);
    assert!(!folder.join("found.csv").exists());
    let kept = Command::new("cp").args(["-r", "disk/trials", "rest"]).current_dir(folder).status();
    assert!(kept.is_ok_and(|s| s.success()) && disk.0.join("trials/trials/0001/trial.json").exists());
    assert_eq!(calibrate("rest", "rest.csv").code, 0);
    let read = |name: &str| fs::read_to_string(folder.join(name)).expect("whole");
    let differs = read("rest.csv") != read("whole.csv");
    KEPT.within(
        "what a calibration found, against an undisturbed one",
        f64::from(u8::from(differs)),
        "tables",
        0.0,
    );
}
