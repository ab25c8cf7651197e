//! A run that is killed loses nothing that it had written: earlier frames are there, and it goes on from its last checkpoint.

use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::scenes::{Head, RUBS, folder};
use grainpipe_tests::tools::{program, succeed, tool};
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use stream::Table;
use stream::mcap::{Event, Reader};
use tempfile::TempDir;

const FRAMES: Case = case("Faults", "killed at any moment: earlier frames are whole");
const RESUMED: Case =
    case("Faults", "killed at any moment: the resumed run ends bit for bit as the uninterrupted one");
const LOOK: Case =
    case("Faults", "killed at any moment: no output looks whole, and what exists can be viewed and measured");

/// Kills of the ordinary test; GRAINPIPE_KILLS=200 asks for more.
const KILLS: u64 = 10;

const HEAD: Head = Head {
    time: "until = 0.24",
    output: "every = 0.005\ncheckpoint = 0.02\nenergy = true",
    material: "sinter",
    density: 3300.0,
    young: 1e7,
    contact: RUBS,
};

/// Everything of a run that can be read.
struct Read {
    frames: Vec<(u64, Table)>,
    /// The last whole checkpoint: its pieces, one after the other.
    checkpoint: Vec<u8>,
    whole: bool,
}

fn read(path: &Path) -> Read {
    let mut read = Read { frames: Vec::new(), checkpoint: Vec::new(), whole: true };
    let mut pieces = Vec::new();
    for event in Reader::new(fs::File::open(path).expect("the file is there")) {
        match event {
            Ok(Event::Points { topic, time_ns, table }) if topic == "/particles" => {
                read.frames.push((time_ns, table))
            }
            Ok(Event::Bytes { topic, data, .. }) if topic == "/checkpoint" => {
                pieces.extend_from_slice(&data[1..]);
                if data[0] == 1 {
                    read.checkpoint = std::mem::take(&mut pieces);
                }
            }
            Ok(_) => {}
            Err(error) => {
                assert!(
                    matches!(error, stream::mcap::McapError::Truncated { .. }),
                    "cut, not damaged: {error:?}"
                );
                read.whole = false;
            }
        }
    }
    read
}

fn scene() -> TempDir {
    folder(&[("s.toml", HEAD.poured(0.25))])
}

fn start(folder: &Path, arguments: &[&str]) -> Child {
    let mut command = Command::new(program("dem-run"));
    command.current_dir(folder).args(arguments).stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().expect("it starts")
}

/// Kills a run with SIGKILL as soon as its unfinished output has `size` bytes; whether that was in time.
fn kill_at(folder: &Path, run: Child, size: u64) -> bool {
    kill_by(&folder.join("run.mcap.part"), run, size)
}

/// The same with an output of another name.
fn kill_by(part: &Path, mut run: Child, size: u64) -> bool {
    let deadline = Instant::now() + Duration::from_secs(60);
    while fs::metadata(part).map_or(0, |m| m.len()) < size {
        assert!(Instant::now() < deadline, "the run gets nowhere");
        if run.try_wait().expect("it can be asked").is_some() {
            return false;
        }
        std::thread::yield_now();
    }
    run.kill().expect("it can be killed");
    run.wait().expect("it has ended").code().is_none()
}

/// 200 times in `make -C pipelines soak`.
#[test]
fn a_run_that_is_killed_at_any_moment_loses_nothing_that_it_had_written() {
    let kills = std::env::var("GRAINPIPE_KILLS").ok().and_then(|n| n.parse().ok()).unwrap_or(KILLS);
    let folder = scene();
    let (folder, path) = (folder.path(), |name: &str| folder.path().join(name));
    succeed(folder, "dem-run", &["s.toml", "-q", "--threads", "1", "-o", "whole.mcap"]);
    let size = fs::metadata(path("whole.mcap")).expect("whole").len();
    let whole = read(&path("whole.mcap"));
    let (mut killed, mut resumed, mut wrong, mut lost, mut looked) = (0u32, 0u32, 0u32, 0u32, 0u32);
    let mut state = 1u64;
    for kill in 0..kills {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let run = start(folder, &["s.toml", "-q", "--threads", "1", "-o", "run.mcap"]);
        if !kill_at(folder, run, (state >> 33) % size) {
            fs::remove_file(path("run.mcap")).expect("it had ended");
            continue;
        }
        killed += 1;
        lost += u32::from(path("run.mcap").exists());
        let part = read(&path("run.mcap.part"));
        // It may also be killed with everything written, before the file had its name.
        let kept = part.frames[..] == whole.frames[..part.frames.len()]
            && (!part.whole || part.frames.len() == whole.frames.len());
        println!("kill {kill}: {} frames, kept as they were: {kept}", part.frames.len());
        wrong += u32::from(!kept);
        if kill % 5 == 0 && !part.frames.is_empty() && !part.whole {
            looked += looks(folder);
        }
        if part.checkpoint == whole.checkpoint {
            // Killed behind its last checkpoint: nothing is left to be done, and all but the last frame is sure to be there.
            wrong += u32::from(part.frames.len() + 1 < whole.frames.len());
        } else if !part.checkpoint.is_empty() {
            resumed += 1;
            let same = goes_on(folder, &whole, resumed.is_multiple_of(2));
            println!("kill {kill}: resumed to the same end: {same}");
            wrong += u32::from(!same);
        }
        fs::remove_file(path("run.mcap.part")).expect("the part");
    }
    assert!(
        2 * u64::from(killed) >= kills && resumed > 0 && looked > 0,
        "{killed} killed, {resumed} resumed"
    );
    FRAMES.within(&format!("{killed} kills, frames that differ"), f64::from(wrong), "runs", 0.0);
    RESUMED.within(&format!("{resumed} runs resumed, those that differ"), f64::from(wrong), "runs", 0.0);
    LOOK.within("outputs under their final name", f64::from(lost), "files", 0.0);
}

/// Resumes by the name of the output that never came, also from the beginning of the file; whether all is as in the whole run.
fn goes_on(folder: &Path, whole: &Read, from_start: bool) -> bool {
    let mut words = vec!["s.toml", "--resume", "run.mcap", "--threads", "1", "-o", "rest.mcap"];
    words.extend(from_start.then_some("--whole"));
    let done = succeed(folder, "dem-run", &words);
    assert!(done.stderr.contains("resuming from run.mcap.part"), "{}", done.stderr);
    let rest = read(&folder.join("rest.mcap"));
    let from = if from_start { 0 } else { whole.frames.len() - rest.frames.len() };
    rest.whole && rest.frames[..] == whole.frames[from..] && rest.checkpoint == whole.checkpoint
}

/// What is there can be seen and measured.
fn looks(folder: &Path) -> u32 {
    let done = succeed(folder, "dem-measure", &["run.mcap.part", "--energy"]);
    assert!(done.stderr.contains("the run did not end") && done.stdout.len() > 50, "{}", done.stderr);
    let done = succeed(folder, "dem-view", &["run.mcap.part", "--size", "200x120", "-o", "x.png"]);
    assert!(done.stderr.contains("the run did not end"), "{}", done.stderr);
    1
}

/// The next start says what a killed run has left; a second part gets another name; the part of a living run is not a leftover.
#[test]
fn what_a_killed_run_left_is_said_and_never_overwritten() {
    let folder = scene();
    let folder = folder.path();
    assert!(kill_at(folder, start(folder, &["s.toml", "-o", "run.mcap"]), 20_000));
    let left = fs::read(folder.join("run.mcap.part")).expect("left");
    let done = succeed(folder, "dem-run", &["s.toml", "--until", "0.02", "-o", "run.mcap"]);
    LOOK.refused(
        "the next start",
        &done.stderr,
        &["run.mcap.part is the output of an unfinished run", "--resume", "remove"],
    );
    assert!(
        fs::read(folder.join("run.mcap.part")).expect("still there") == left
            && folder.join("run.mcap").exists()
    );
    fs::remove_file(folder.join("run.mcap")).expect("whole");
    fs::write(folder.join("run.mcap.2.part"), &left).expect("written");
    let done = tool(folder, "dem-run", &["s.toml", "--resume", "run.mcap", "-o", "rest.mcap"]);
    assert_eq!(done.code, 1);
    LOOK.refused("two parts to resume from", &done.stderr, &["run.mcap.part, run.mcap.2.part", "name one"]);
    fs::remove_file(folder.join("run.mcap.2.part")).expect("a copy");
    fs::remove_file(folder.join("run.mcap.part")).expect("left");
    let mut living = living(folder);
    let done = tool(folder, "dem-run", &["s.toml", "--resume", "run.mcap.part", "-o", "rest.mcap"]);
    LOOK.refused("resuming the part of a living run", &done.stderr, &["is still writing run.mcap.part"]);
    assert_eq!((done.code, folder.join("rest.mcap").exists()), (1, false));
    std::os::unix::fs::symlink("run.mcap.part", folder.join("link.mcap")).expect("a link");
    let done = tool(folder, "dem-run", &["s.toml", "--resume", "link.mcap", "-o", "rest.mcap"]);
    LOOK.refused("a link to the part of a living run", &done.stderr, &["is still writing link.mcap"]);
    assert_eq!((done.code, folder.join("rest.mcap").exists()), (1, false));
    let done = succeed(folder, "dem-run", &["s.toml", "--until", "0.02", "-o", "run.mcap"]);
    living.kill().expect("it lives");
    living.wait().expect("it has ended");
    LOOK.refused("beside a run to the same name", &done.stderr, &["another dem-run is writing run.mcap"]);
}

/// A run that goes on for long, whose unfinished output is there.
fn living(folder: &Path) -> Child {
    let run = start(folder, &["s.toml", "--until", "100", "-o", "run.mcap"]);
    wait_for_the_part(folder);
    run
}

/// A run whose words are kept, and whose unfinished output is there.
fn begun(folder: &Path) -> Child {
    let mut command = Command::new(program("dem-run"));
    let run = command.current_dir(folder).args(["s.toml", "-o", "run.mcap"]).stderr(Stdio::piped());
    let run = run.spawn().expect("it starts");
    wait_for_the_part(folder);
    run
}

fn wait_for_the_part(folder: &Path) {
    let deadline = Instant::now() + Duration::from_secs(60);
    while !folder.join("run.mcap.part").exists() && Instant::now() < deadline {
        std::thread::yield_now();
    }
}

/// A folder takes the name while the run goes on: the output is complete, and the message says that only its name is missing.
#[test]
fn an_output_that_cannot_be_renamed_is_said_to_be_complete() {
    let folder = scene();
    let folder = folder.path();
    let run = begun(folder);
    fs::create_dir(folder.join("run.mcap")).expect("a folder");
    let done = run.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&done.stderr);
    LOOK.refused("a name that is taken", &said, &["run.mcap.part is complete", "rename it yourself"]);
    assert!(
        done.status.code() == Some(1) && !said.contains("is kept in") && !said.contains("--resume"),
        "{said}"
    );
    assert!(read(&folder.join("run.mcap.part")).whole);
}

/// What was removed while the run went on is not said to be there.
#[test]
fn an_output_that_was_removed_is_said_to_be_lost() {
    let folder = scene();
    let folder = folder.path();
    let run = begun(folder);
    fs::remove_file(folder.join("run.mcap.part")).expect("it is there");
    let done = run.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&done.stderr);
    LOOK.refused("a part that is gone", &said, &["run.mcap is lost", "was removed"]);
    assert!(done.status.code() == Some(1) && !said.contains("rename it"), "{said}");
}

/// The part of an output that is a link lies beside its target: it is named where it is, and found by the name of the link.
#[test]
fn the_part_of_a_link_is_found_beside_its_target() {
    let folder = scene();
    let folder = folder.path();
    fs::create_dir(folder.join("other")).expect("a folder");
    fs::write(folder.join("other/run.mcap"), "").expect("written");
    std::os::unix::fs::symlink("other/run.mcap", folder.join("link")).expect("a link");
    assert!(kill_by(&folder.join("other/run.mcap.part"), start(folder, &["s.toml", "-o", "link"]), 20_000));
    let done = succeed(folder, "dem-run", &["s.toml", "--until", "0.02", "-o", "link"]);
    LOOK.refused("the next start", &done.stderr, &["other/run.mcap.part is the output of an unfinished run"]);
}
