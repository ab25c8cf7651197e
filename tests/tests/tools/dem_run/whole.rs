//! A resumed run whose output holds everything from the beginning.

use super::*;
use std::collections::BTreeMap;
use std::process::Stdio;

/// Frames, crossings, energies, forces on walls: what is read of a run.
const RECORDED: &str = "energy = true\ncontacts = true\nwall_forces = true\n";
const OUTLET: &str = "[[outlet]]\nplane = \"0,0,0.045,0,0,-1\"\nlength = 0.03\nmotion = \"recorded\"\n";

fn scene() -> String {
    poured()
        .replace("until = 0.12", "until = 0.12\ndt = 8e-6")
        .replace("checkpoint = 0.04\n", &format!("checkpoint = 0.04\n{RECORDED}"))
        + OUTLET
}

/// All messages of each topic, but for checkpoints and what ends a file.
fn messages(path: &Path) -> BTreeMap<String, Vec<String>> {
    let mut all: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for event in events(path).0 {
        let (topic, message) = match event {
            Event::Points { topic, time_ns, table } => (topic, format!("{time_ns} {table:?}")),
            Event::Bytes { topic, time_ns, data } => {
                (topic, format!("{time_ns} {}", String::from_utf8_lossy(&data)))
            }
            Event::Metadata { name, map } if name == "time" => (name, format!("{map:?}")),
            Event::Metadata { .. } => continue,
        };
        if !["/checkpoint", "/log", "/crossings/watermark"].contains(&&*topic) {
            all.entry(topic).or_default().push(message);
        }
    }
    all
}

/// Stopped by a guard, which a resumed run may raise (it limits the time step, so that is given): the file of the stopped run has nothing that the uninterrupted one lacks.
fn stopped(folder: &Path) {
    let done = tool(folder, "dem-run", &["s.toml", "--set", "guards.overlap=0.02", "-o", "part.mcap"]);
    assert!(done.code == 3 && done.stderr.contains("guards.overlap"), "{}", done.stderr);
}

#[test]
fn a_whole_resumed_run_is_the_uninterrupted_one() {
    let folder = with(&scene());
    let path = |name: &str| folder.path().join(name);
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "once.mcap"]);
    stopped(folder.path());
    succeed(folder.path(), "dem-run", &["s.toml", "--resume", "part.mcap", "--whole", "-o", "whole.mcap"]);
    let (once, part, whole) =
        (messages(&path("once.mcap")), messages(&path("part.mcap")), messages(&path("whole.mcap")));
    assert!(part["/particles"].len() > 3 && part["/particles"].len() < whole["/particles"].len());
    for topic in ["/particles", "/energy", "/contacts", "/wall_forces", "/surfaces", "time"] {
        assert!(once[topic] == whole[topic] && !once[topic].is_empty(), "{topic} differs");
    }
    assert_eq!(once.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>());
    let said = messages_of_log(&path("whole.mcap"));
    assert!(!said.contains("\"stopped\"") && messages_of_log(&path("part.mcap")).contains("\"stopped\""));
    // What is made of it is the same, too, without a warning; crossings come in other pieces.
    let measured = |run: &str| {
        let done = succeed(folder.path(), "dem-measure", &[run, "--energy", "-q"]);
        (done.stdout, done.stderr)
    };
    assert_eq!(measured("once.mcap"), measured("whole.mcap"));
    let replayed = |run: &str| {
        let out = format!("inlet-{run}");
        succeed(folder.path(), "stage-replay", &[run, "-q", "-o", &out]);
        tables(&path(&out), "/inlet")
    };
    assert!(replayed("once.mcap") == replayed("whole.mcap"));
}

fn messages_of_log(path: &Path) -> String {
    let pick = |event| match event {
        Event::Bytes { topic, data, .. } if topic == "/log" => String::from_utf8(data).ok(),
        _ => None,
    };
    events(path).0.into_iter().filter_map(pick).collect()
}

/// A run that was killed between a checkpoint and the frame of the same instant, or within that frame: the frame is written now.
#[test]
fn a_frame_that_a_killed_run_lacks_is_not_lost() {
    let folder = with(&poured().replace("checkpoint = 0.04\n", &format!("checkpoint = 0.04\n{RECORDED}")));
    let path = |name: &str| folder.path().join(name);
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "once.mcap"]);
    for last in ["/checkpoint", "/particles", "/contacts", "/energy"] {
        let out = fs::File::create(path("part.mcap")).unwrap();
        let mut writer = stream::mcap::Writer::new(out, &Default::default()).unwrap();
        for event in events(&path("once.mcap")).0 {
            let at = match event {
                Event::Metadata { name, map } if name != "provenance" => {
                    writer.metadata(&name, map).unwrap();
                    continue;
                }
                Event::Metadata { .. } => continue,
                Event::Points { topic, time_ns, table } => {
                    writer.points(&topic, time_ns, "world", &table).unwrap();
                    (topic, time_ns)
                }
                Event::Bytes { topic, time_ns, data } => {
                    let encoding = if topic == "/checkpoint" { "bincode" } else { "json" };
                    writer.bytes(&topic, encoding, time_ns, &data).unwrap();
                    (topic, time_ns)
                }
            };
            if at.0 == last && at.1 > 35_000_000 {
                break;
            }
        }
        writer.finish().unwrap();
        succeed(
            folder.path(),
            "dem-run",
            &["s.toml", "--resume", "part.mcap", "--whole", "-o", "whole.mcap"],
        );
        let (once, whole) = (messages(&path("once.mcap")), messages(&path("whole.mcap")));
        for topic in ["/particles", "/energy", "/contacts", "/wall_forces"] {
            assert!(once[topic] == whole[topic], "cut behind {last}: {topic} differs");
        }
        assert!(checkpoints(&path("once.mcap")).last() == checkpoints(&path("whole.mcap")).last());
    }
}

/// Stopped by a signal and resumed twice: what the first resumed run holds of the one before is in the second.
#[test]
fn a_run_that_is_resumed_again_is_still_whole() {
    let folder = with(&poured());
    let path = |name: &str| folder.path().join(name);
    succeed(folder.path(), "dem-run", &["s.toml", "-o", "once.mcap"]);
    let rests = [("0.025", "a", None), ("0.065", "b", Some("a")), ("0.12", "c", Some("b"))];
    for (until, to, from) in rests {
        let mut words = vec!["s.toml", "--until", until, "-o", to];
        words.extend(from.into_iter().flat_map(|from| ["--whole", "--resume", from]));
        succeed(folder.path(), "dem-run", &words);
    }
    // Without the frames at which the first two ended, which are not due.
    assert!(frames(&path("once.mcap")) == frames(&path("c")));
    // Without the option the file begins where the run goes on.
    succeed(folder.path(), "dem-run", &["s.toml", "--resume", "b", "-o", "rest.mcap"]);
    assert_eq!(frames(&path("rest.mcap")).len(), 6, "0.07 to 0.12 s");
}

#[test]
fn whole_needs_a_file_that_is_resumed() {
    let folder = with(&poured());
    succeed(folder.path(), "dem-run", &["s.toml", "--until", "0.01", "-o", "part.mcap"]);
    for (words, told) in [
        (vec!["--whole"], "--whole has no effect without --resume: leave it out"),
        (vec!["--whole", "--resume", "part.mcap", "--check"], "--whole: --check runs nothing: leave it out"),
        (vec!["--whole", "--resume", "-"], "--whole reads the resumed run twice: give --resume a file"),
    ] {
        let mut call = std::process::Command::new(program("dem-run"));
        let input = fs::File::open(folder.path().join("part.mcap")).unwrap();
        call.current_dir(folder.path()).arg("s.toml").args(&words).stdin(Stdio::from(input));
        let done = call.output().unwrap();
        let said = String::from_utf8_lossy(&done.stderr);
        assert!(done.status.code() == Some(2) && said.contains(told), "{words:?}: {said}");
    }
}
