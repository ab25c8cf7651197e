//! Whole pipes of tools: pipes and files give the same bytes, and a stage that dies takes the later ones with it.

use grainpipe_tests::tools::{Done, line, program, succeed, with_stdin};
use grainpipe_tests::tree::root;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use stream::mcap::{Event, Reader};
use tempfile::{TempDir, tempdir};

/// The main job, stage by stage: scan, crop, fill, sample, walls, run.
const STAGES: [&str; 5] = [
    "cloud-crop scan.ply --remove halfspace:0,0,0,-0.766,0,0.643",
    "cloud-fill",
    "bluenoise-sample --spacing 0.02",
    "wallgen --roughness 0.002 --radius uniform --material steel",
    "dem-run chute.toml - --until 0.3",
];
const FILES: [&str; 5] = ["cropped.ply", "filled.ply", "sampled.ply", "walls.mcap", "run.mcap"];

fn folder() -> TempDir {
    let folder = tempdir().unwrap();
    let root = root();
    for (from, to) in
        [("sample-data/chute/chute.ply", "scan.ply"), ("pipelines/scenes/chute.toml", "chute.toml")]
    {
        fs::copy(root.join(from), folder.path().join(to)).unwrap();
    }
    folder
}

fn done(folder: &Path, text: &str) -> Done {
    let done = line(folder, text);
    assert_eq!(done.code, 0, "{text}: {}", done.stderr);
    done
}

/// Each stage with its threads, reading the file before and writing its own.
fn with_files(threads: usize) -> String {
    let stage = |k: usize| {
        let from = if k == 0 { String::new() } else { format!(" < {}", FILES[k - 1]) };
        format!("{} --threads {threads} -o {}{from}", STAGES[k], FILES[k])
    };
    (0..5).map(stage).collect::<Vec<_>>().join(" && ")
}

fn as_pipe(threads: usize) -> String {
    STAGES.map(|stage| format!("{stage} --threads {threads}")).join(" | ")
}

#[test]
fn one_pipe_and_files_between_give_the_same_bytes_for_any_number_of_threads() {
    let folder = folder();
    let bytes = |name: &str| fs::read(folder.path().join(name)).unwrap();
    let mut runs = Vec::new();
    for threads in [1, 2] {
        done(folder.path(), &with_files(threads));
        runs.push(bytes("run.mcap"));
        done(folder.path(), &format!("{} -o piped.mcap", as_pipe(threads)));
        runs.push(bytes("piped.mcap"));
    }
    assert!(runs[0].len() > 100_000 && runs.iter().all(|r| *r == runs[0]));
    // Every stage alone: the file it wrote is what it writes to a pipe, but for the packing of MCAP.
    for k in 0..3 {
        let from = if k == 0 { String::new() } else { format!(" < {}", FILES[k - 1]) };
        let out = done(folder.path(), &format!("{}{from}", STAGES[k])).stdout;
        assert!(out == bytes(FILES[k]), "{}", STAGES[k]);
    }
}

#[test]
fn a_run_has_the_channels_fields_and_records_of_the_contract() {
    let folder = folder();
    done(folder.path(), &format!("{} -o run.mcap", as_pipe(2)));
    let (mut fields, mut topics, mut records) = (BTreeMap::new(), BTreeSet::new(), BTreeMap::new());
    let mut order = Vec::new();
    for event in Reader::new(fs::File::open(folder.path().join("run.mcap")).unwrap()) {
        match event.unwrap() {
            Event::Metadata { name, map } => {
                records.insert(name, map);
            }
            Event::Points { topic, table, .. } => {
                let names: Vec<String> = table.columns().iter().map(|c| c.name.clone()).collect();
                order.push(topic.clone());
                fields.insert(topic, names.join(" "));
            }
            Event::Bytes { topic, .. } => {
                topics.insert(topic);
            }
        }
    }
    assert_eq!(fields["/particles"], "x y z radius vx vy vz wx wy wz id material");
    assert!(fields["/walls"].starts_with("x y z radius material"), "{}", fields["/walls"]);
    assert_eq!(order[0], "/walls", "walls come before the first frame");
    assert!(topics.contains("/checkpoint"), "{topics:?}");
    assert!(records["scene"]["toml"].contains("[[wall]]"), "the scene as run");
    assert!(records["scene"]["toml"].contains("until = 0.3"), "with what --until changed");
    assert!(records["materials"].values().any(|m| m.contains("\"steel\"")));
    assert_eq!(records["provenance"]["tool"], "dem-run");
    let told = format!("{:?}", records["provenance"]);
    assert!(told.contains("walls"), "the input's hash: {told}");
}

/// Runs the pipe with one arrow cut off after some bytes; the exit codes of all stages.
fn cut(folder: &Path, arrow: usize, bytes: usize) -> (Vec<i32>, String) {
    let mut stages: Vec<String> = STAGES.iter().map(|s| (*s).to_owned()).collect();
    stages[4].push_str(" -o out.mcap");
    stages.insert(arrow + 1, format!("head -c {bytes}"));
    let done = line(folder, &format!("{}; echo \"${{PIPESTATUS[@]}}\"", stages.join(" | ")));
    let codes = String::from_utf8_lossy(&done.stdout);
    let mut codes: Vec<i32> = codes.split_whitespace().map(|code| code.parse().unwrap()).collect();
    codes.remove(arrow + 1);
    (codes, done.stderr)
}

#[test]
fn a_stream_cut_off_between_two_stages_fails_every_later_one() {
    let folder = folder();
    let later = ["cloud-crop", "cloud-fill", "bluenoise-sample", "wallgen", "dem-run"];
    for arrow in 0..4 {
        for bytes in [0, 90, 700, 40_000] {
            let (codes, said) = cut(folder.path(), arrow, bytes);
            assert!(codes[..=arrow].iter().all(|&c| c == 0), "arrow {arrow}, {bytes}: {codes:?} {said}");
            assert!(codes[arrow + 1..].iter().all(|&c| c == 1), "arrow {arrow}, {bytes}: {codes:?} {said}");
            for tool in &later[arrow + 1..] {
                let place = format!("{tool}: stdin: ");
                let words = said.lines().find(|l| l.starts_with(&place)).unwrap_or_default();
                let clear = ["cut off", "truncated", "upstream", "previous tool", "no known", "first bytes"];
                assert!(clear.iter().any(|c| words.contains(c)), "{tool}, {bytes} bytes: {said}");
            }
            let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
            assert_eq!(left.len(), 2, "{left:?}");
        }
    }
}

/// Grains fall through the plane z = 0, for longer than anybody waits.
const LONG: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 100000
[output]
every = 0.02
[[material]]
name = "sinter"
density = 3300
young = 5e7
poisson = 0.25
[[contact]]
between = ["*", "*"]
restitution = 0.5
[[insert]]
material = "sinter"
shape = "cylinder:0,0,0.05,0,0,0.07,0.04"
diameter = [0.008, 0.012]
velocity = [0, 0, -1]
rate_count = 1000
[[wall]]
name = "floor"
plane = "0,0,-0.1,0,0,1"
material = "sinter"
"#;

#[test]
fn a_killed_upstream_stage_fails_every_later_one_and_leaves_nothing() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("plant.toml"), LONG).unwrap();
    for (stage, file) in [("upstream", "up.toml"), ("downstream", "down.toml")] {
        let cut = ["plant.toml", "--at", "0,0,0,0,0,-1", "--keep", stage, "-o", file];
        succeed(folder.path(), "stage-split", &cut);
    }
    let start = |tool: &str, arguments: &[&str], stdin: Stdio| {
        let mut command = Command::new(program(tool));
        command.current_dir(folder.path()).args(arguments).stdin(stdin);
        command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    };
    let mut up = start("dem-run", &["up.toml", "--threads", "1"], Stdio::null());
    let mut replay = start("stage-replay", &[], up.stdout.take().unwrap().into());
    let down = ["down.toml", "-", "--threads", "1", "-o", "down.mcap"];
    let down = start("dem-run", &down, replay.stdout.take().unwrap().into());
    // The output downstream is begun when the first crossings have arrived there.
    let begun = || fs::read_dir(folder.path()).unwrap().count() > 3;
    let deadline = Instant::now() + Duration::from_secs(60);
    while !begun() && up.try_wait().unwrap().is_none() && Instant::now() < deadline {
        std::thread::sleep(Duration::from_millis(20));
    }
    let in_time = begun();
    up.kill().unwrap();
    up.wait().unwrap();
    for (name, child) in [("stage-replay", replay), ("dem-run", down)] {
        let done = Done::from(child.wait_with_output().unwrap());
        assert!(done.code == 1 && done.stderr.contains("truncated"), "{name}: {} {}", done.code, done.stderr);
        assert!(
            done.stderr.contains(&format!("{name}: ")) && done.stderr.contains("stdin: "),
            "{}",
            done.stderr
        );
    }
    assert!(in_time, "the output was not begun within a minute");
    let left: Vec<_> = fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    // What was simulated until then may stay in sight as a part; nothing looks whole.
    let whole = left.iter().filter(|name| *name != "down.mcap.part").count();
    assert_eq!(whole, 3, "{left:?}");
}

#[test]
fn a_tool_whose_reader_goes_away_ends_quietly() {
    let folder = folder();
    done(folder.path(), &with_files(2));
    for tool in [
        "cloud-crop scan.ply",
        "cloud-fill cropped.ply",
        "bluenoise-sample filled.ply --spacing 0.01",
        "wallgen sampled.ply --roughness 0.002",
        "dem-run chute.toml walls.mcap --until 0.3",
        "dem-view run.mcap",
    ] {
        let said = done(folder.path(), &format!("{tool} -q | head -c 20 > /dev/null")).stderr;
        assert_eq!(said, "", "{tool}");
    }
}

/// Binary output would make a mess of a terminal; `script` gives the tools one.
#[test]
fn binary_output_is_refused_when_stdout_is_a_terminal() {
    if Command::new("script").arg("--version").output().is_err() {
        return grainpipe_tests::skip("script");
    }
    let folder = folder();
    let tools = program("dem-run").parent().unwrap().display().to_string();
    for tool in ["cloud-crop scan.ply", "dem-run chute.toml --set wall.0.plane=0,0,-1,0,0,1 --until 0.001"] {
        let shell = format!("PATH='{tools}':$PATH; {tool}");
        let out = with_stdin_of("script", &["-qec", &shell, "/dev/null"], folder.path());
        assert!(out.code == 2 && out.stdout.len() < 2000, "{tool}: {}", out.code);
        let said = String::from_utf8_lossy(&out.stdout).into_owned();
        assert!(said.contains("stdout is a terminal") && said.contains("-o FILE"), "{said}");
    }
    let without = with_stdin(folder.path(), "cloud-crop", &["scan.ply", "--ascii", "-o", "a.ply"], b"");
    assert_eq!(without.code, 0, "{}", without.stderr);
}

fn with_stdin_of(program: &str, arguments: &[&str], folder: &Path) -> Done {
    let mut command = Command::new(program);
    command.current_dir(folder).args(arguments).stdin(Stdio::null());
    command.output().unwrap().into()
}

#[test]
fn a_run_that_a_guard_stopped_can_be_resumed_with_another_guard() {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("s.toml"), LONG.replace("100000", "0.3")).unwrap();
    // Deeper overlaps are stiffer with Hertz: the saved step must suit the new guard as well.
    let strict = ["s.toml", "--set", "guards.overlap=0.001", "--set", "time.safety=0.1", "-o", "part.mcap"];
    let stopped = with_stdin(folder.path(), "dem-run", &strict, b"");
    assert_eq!(stopped.code, 3, "{}", stopped.stderr);
    assert!(
        stopped.stderr.starts_with("dem-run: ") && stopped.stderr.contains("guards.overlap"),
        "{}",
        stopped.stderr
    );
    succeed(
        folder.path(),
        "dem-run",
        &["s.toml", "--set", "time.safety=0.1", "--resume", "part.mcap", "-o", "rest.mcap"],
    );
    succeed(folder.path(), "dem-view", &["part.mcap", "-o", "part.png"]);
    let to_pipe = with_stdin(folder.path(), "dem-run", &strict[..5], b"");
    assert!(to_pipe.code == 3 && Reader::new(&to_pipe.stdout[..]).all(|e| e.is_ok()), "a whole stream, too");
}

/// `pipelines/once.sh` leaves a finished run alone, and makes one that a guard stopped again.
#[test]
fn a_pipeline_does_not_take_a_stopped_run_as_made() {
    let folder = tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    fs::write(file("s.toml"), LONG.replace("100000", "0.3")).unwrap();
    let once = root().join("pipelines/once.sh");
    let run =
        |words: &str| line(folder.path(), &format!("'{}' run.mcap dem-run s.toml {words}", once.display()));
    for _ in 0..2 {
        let stopped = run("--set guards.overlap=0.001 --set time.safety=0.1");
        assert!(stopped.code == 3 && stopped.stderr.contains("run-stopped.mcap"), "{}", stopped.stderr);
        assert!(file("run-stopped.mcap").exists() && !file("run.mcap").exists());
    }
    let made = run("--until 0.001");
    assert!(made.code == 0 && file("run.mcap").exists(), "{}", made.stderr);
    let refused = run("--set no.such=key");
    assert!(refused.code == 0 && refused.stderr.is_empty(), "made once: {}", refused.stderr);
}

/// A change downstream leaves the upstream stage as it is, with its time: make runs nothing again that depends on it.
#[test]
fn a_stage_that_has_not_changed_keeps_its_time() {
    let folder = tempfile::tempdir().unwrap();
    let (plant, up) = (folder.path().join("plant.toml"), folder.path().join("up.toml"));
    let floor = "[[wall]]\nname = \"tray\"\nsolid = \"box:-1,-1,-2,1,1,-1.9\"\nmaterial = \"MATERIAL\"\n";
    let name = LONG.split_once("name = \"").and_then(|(_, rest)| rest.split('"').next()).unwrap();
    let floor = floor.replace("MATERIAL", name);
    let split = || {
        let cut = ["plant.toml", "--at", "0,0,0,0,0,-1", "--keep", "upstream", "-o", "up.toml"];
        let done = succeed(folder.path(), "stage-split", &cut);
        (fs::metadata(&up).unwrap().modified().unwrap(), fs::read(&up).unwrap(), done.stderr)
    };
    fs::write(&plant, format!("{LONG}{floor}")).unwrap();
    let (first, text, said) = split();
    assert!(!said.contains("holds this stage already"), "{said}");
    fs::write(&plant, format!("{LONG}{}", floor.replace("-1.9", "-1.8"))).unwrap();
    let (second, again, said) = split();
    assert!(first == second && text == again && said.contains("up.toml holds this stage already"), "{said}");
    fs::write(&plant, format!("{LONG}{floor}").replacen("until = ", "until = 1", 1)).unwrap();
    let (third, other, _) = split();
    assert!(third > second && other != text, "a stage that has changed is written");
}
