//! Runs that a signal, a guard or a full disk stops, and runs that go on from them.

use super::*;
use stream::mcap::Reader;

#[test]
fn a_killed_run_is_refused_as_input_and_resumes_from_its_last_checkpoint() {
    let folder = with(&poured());
    let path = |name: &str| folder.path().join(name);
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "whole.mcap"]);
    let done = line(folder.path(), "dem-run s.toml | head -c 9000 > /dev/null");
    assert_eq!(done.code, 0, "a reader that goes away is no failure: {}", done.stderr);
    let bytes = succeed(folder.path(), "dem-run", &["s.toml"]).stdout;
    fs::write(path("killed.mcap"), &bytes[..bytes.len() * 55 / 100]).unwrap();
    assert!(!events(&path("killed.mcap")).1);
    assert_eq!(checkpoints(&path("killed.mcap")).len(), 1, "the cut is between two checkpoints");
    succeed(folder.path(), "dem-run", &["s.toml", "--resume", "killed.mcap", "-o", "rest.mcap"]);
    let (whole, rest) = (frames(&path("whole.mcap")), frames(&path("rest.mcap")));
    assert!(whole[5..] == rest[..]);
    let done = tool(folder.path(), "stage-replay", &["killed.mcap", "-o", "x.mcap"]);
    assert!(done.code == 1 && !path("x.mcap").exists(), "{}", done.stderr);
}

#[test]
fn another_scene_or_a_damaged_run_is_not_resumed() {
    let folder = with(&poured());
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap", "--until", "0.05"]);
    let resume = |run: &str, set: &str| {
        tool(folder.path(), "dem-run", &["s.toml", "--resume", run, "--set", set, "-o", "x.mcap"])
    };
    for (set, part) in [
        ("contact.0.restitution=0.4", "contact.0.restitution was 0.5, now 0.4"),
        ("fill.0.seed=1", "fill.0.seed = 1 is new"),
        ("time.dt=1e-6", "time.dt = "),
        ("time.until=0.02", "give a later --until"),
    ] {
        let done = resume("run.mcap", set);
        assert!(done.code == 1 && done.stderr.contains(part), "{set}: {}", done.stderr);
    }
    let mut bytes = fs::read(folder.path().join("run.mcap")).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(folder.path().join("flipped.mcap"), bytes).unwrap();
    let done = resume("flipped.mcap", "output.every=0.02");
    assert!(done.code == 1 && done.stderr.contains("flipped.mcap"), "{}", done.stderr);
    fs::write(folder.path().join("empty.mcap"), "").unwrap();
    assert_eq!(resume("empty.mcap", "output.every=0.02").code, 1);
    assert!(!folder.path().join("x.mcap").exists());
}

#[test]
fn a_guard_ends_the_run_with_code_3_a_reason_and_a_checkpoint() {
    let folder = with(&poured());
    let done = tool(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap", "--set", "guards.overlap=0.01"]);
    assert_eq!(done.code, 3, "{}", done.stderr);
    assert!(done.stderr.contains("overlaps") && done.stderr.contains("guards.overlap"), "{}", done.stderr);
    let (events, whole) = events(&folder.path().join("run.mcap"));
    assert!(whole, "the file is valid");
    let log = events.iter().any(|e| {
        matches!(e, Event::Bytes { topic, data, .. }
        if topic == "/log" && String::from_utf8_lossy(data).contains("overlaps"))
    });
    assert!(log, "the log says why");
    let last = events.iter().rev().find(|e| !matches!(e, Event::Metadata { .. }));
    assert!(
        matches!(last, Some(Event::Bytes { topic, .. }) if topic == "/checkpoint"),
        "it ends in a checkpoint"
    );
}

/// Programs read the cause from the report and from the log, and need no word of the sentence beside it.
#[test]
fn the_report_and_the_log_of_a_stopped_run_name_the_guard() {
    let folder = with(&poured());
    for (set, guard) in [("guards.overlap=0.01", "overlap"), ("guards.motion=0.0005", "motion")] {
        let done =
            tool(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap", "--report", "r.json", "--set", set]);
        assert_eq!(done.code, 3, "{set}: {}", done.stderr);
        let report: serde_json::Value =
            serde_json::from_slice(&fs::read(folder.path().join("r.json")).unwrap()).unwrap();
        let stop = serde_json::json!({"by": "guard", "guard": guard});
        assert_eq!(report["stop"], stop, "{report}");
        assert!(report["stopped"].as_str().is_some_and(|text| text.starts_with("t = ")), "{report}");
        let log = json(&folder.path().join("run.mcap"), "/log");
        let log = log.iter().find(|message| message["kind"] == "stopped").expect("a message of the stop");
        assert_eq!(log["stop"], stop);
    }
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "run.mcap", "--report", "r.json"]);
    let report = fs::read_to_string(folder.path().join("r.json")).unwrap();
    assert!(!report.contains("\"stop\""), "nothing stopped it: {report}");
}

/// Starts a run that takes minutes.
fn long_run(folder: &Path) -> std::process::Child {
    // Under nohup, whose children ignore a lost terminal, this one does not.
    let mut command = std::process::Command::new("env");
    command.arg("--default-signal=HUP").arg(program("dem-run"));
    command.current_dir(folder).args(["s.toml", "--until", "1000", "-o", "run.mcap"]);
    command.args(["--set", "output.every=0.01", "--set", "output.checkpoint=0.01"]);
    command.stderr(std::process::Stdio::piped()).spawn().unwrap()
}

/// The unfinished file of a run, once it holds some frames and checkpoints.
fn unfinished(folder: &Path) -> std::path::PathBuf {
    let start = std::time::Instant::now();
    loop {
        let mut files = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
        let part = files.find(|p| p.extension().is_some_and(|e| e == "part"));
        if let Some(part) = part.filter(|p| fs::metadata(p).is_ok_and(|m| m.len() > 600_000)) {
            return part;
        }
        assert!(start.elapsed().as_secs() < 60, "the run does not begin");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
}

fn send(signal: &str, child: &std::process::Child) {
    let id = child.id().to_string();
    assert!(std::process::Command::new("kill").args([signal, &id]).status().unwrap().success());
}

#[test]
fn a_signal_ends_the_run_with_code_3_and_a_checkpoint_to_go_on_from() {
    let folder = with(&poured());
    let path = |name: &str| folder.path().join(name);
    for signal in ["-INT", "-HUP", "-TERM"] {
        let child = long_run(folder.path());
        let part = unfinished(folder.path());
        send(signal, &child);
        let done = child.wait_with_output().unwrap();
        let said = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(3), "{said}");
        assert!(said.contains("stopped by a signal at t = ") && said.contains("--resume run.mcap"), "{said}");
        assert!(events(&path("run.mcap")).1 && !part.exists(), "the file is whole");
    }
    let stopped = frames(&path("run.mcap"));
    let until = (stopped.len() as f64 + 3.5) * 0.01;
    let (until, every) = (until.to_string(), ["--set", "output.every=0.01"]);
    let every = [&every[..], &["--set", "output.checkpoint=0.01"]].concat();
    succeed(
        folder.path(),
        "dem-run",
        &[&["s.toml", "--until", &until, "-o", "whole.mcap"], &every[..]].concat(),
    );
    let resume = ["s.toml", "--until", &until, "--resume", "run.mcap", "-o", "rest.mcap"];
    succeed(folder.path(), "dem-run", &[&resume, &every[..]].concat());
    let (whole, rest) = (frames(&path("whole.mcap")), frames(&path("rest.mcap")));
    assert!(whole[..stopped.len()] == stopped[..] && whole[stopped.len()..] == rest[..]);
}

#[test]
fn a_killed_run_leaves_a_part_that_is_resumed() {
    let folder = with(&poured());
    let child = long_run(folder.path());
    let part = unfinished(folder.path());
    send("-KILL", &child);
    child.wait_with_output().unwrap();
    let part = part.file_name().unwrap().to_str().unwrap();
    succeed(folder.path(), "dem-run", &["s.toml", "--until", "1000", "--check", "--resume", part]);
    assert!(!checkpoints(&folder.path().join(part)).is_empty());
}

#[test]
fn a_run_that_was_stopped_gives_no_stage_downstream_that_looks_whole() {
    let outlet = "[[outlet]]\nplane = \"0,0,-0.05,0,0,-1\"\nlength = 0.03\n";
    // A slope that only the outermost grains meet before they pass the outlet.
    let slope = "plane = \"0.04,0,-0.046,-1,0,1\"";
    let falling = poured().replace("plane = \"0,0,0,0,0,1\"", slope) + outlet;
    let folder = with(&falling.replace("until = 0.12", "until = 0.4"));
    let strict = "dem-run s.toml --set guards.overlap=0.001";
    assert_eq!(line(folder.path(), &format!("{strict} -o up.mcap")).code, 3);
    let why = ["up.mcap: the run was stopped at t = 1.1", "guards.overlap", "--until"];
    refused(folder.path(), "stage-replay up.mcap -o x.mcap", 1, &why);
    let passed = line(folder.path(), "stage-replay up.mcap").stdout;
    let events: Vec<_> = Reader::new(&passed[..]).collect();
    assert!(events.iter().any(|e| matches!(e, Ok(Event::Points { .. }))), "what was recorded is passed on");
    assert!(events.iter().any(|e| e.is_err()), "and has no end");
    succeed(folder.path(), "stage-replay", &["up.mcap", "--until", "0.11", "-o", "early.mcap"]);
}

/// The last frame of a run that a guard stopped is not its end: the next scene prints a warning.
#[test]
fn the_last_frame_of_a_stopped_run_is_taken_with_a_warning() {
    let next = format!("{}[[particles]]\nsource = \"run.mcap\"\n{}", HEAD.toml(), HEAD.floor());
    let folder = folder(&[("s.toml", poured()), ("next.toml", next)]);
    let run =
        |set: &[&str]| tool(folder.path(), "dem-run", &[&["s.toml", "-q", "-o", "run.mcap"], set].concat());
    let next = || tool(folder.path(), "dem-run", &["next.toml", "--until", "0.001", "-o", "next.mcap"]);
    assert_eq!(run(&["--set", "guards.overlap=1e-4"]).code, 3);
    let done = next();
    let warned =
        done.stderr.contains("run.mcap: the run was stopped at t = ") && done.stderr.contains("overlap");
    assert!(done.code == 0 && warned, "{}", done.stderr);
    assert_eq!(run(&["--until", "0.02"]).code, 0);
    assert!(!next().stderr.contains("was stopped"), "a run that reached its end is no reason");
}

/// The parser of records has errors in colours, with lines of its own source: none of that is shown.
#[test]
fn a_damaged_record_is_refused_in_one_plain_line() {
    let folder = with(&poured());
    succeed(folder.path(), "dem-run", &["s.toml", "--until", "0.01", "-q", "-o", "run.mcap"]);
    let mut bytes = fs::read(folder.path().join("run.mcap")).unwrap();
    let at = bytes.windows(10).position(|part| part == b"provenance").unwrap();
    bytes[at] = 0xff;
    fs::write(folder.path().join("bad.mcap"), bytes).unwrap();
    let done = tool(folder.path(), "dem-measure", &["bad.mcap", "--contacts"]);
    assert_eq!(done.code, 1);
    let wanted = "a record does not have the fields of its kind; the file is damaged, write or copy it again";
    assert!(done.stderr.contains(wanted) && done.stderr.is_ascii(), "{}", done.stderr);
    assert!(done.stderr.len() < 300 && !done.stderr.contains('\u{1b}'), "{}", done.stderr);
}
