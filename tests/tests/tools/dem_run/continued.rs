//! The command that a stopped run prints, and files in the wrong place of a command line.

use super::*;
use std::process::{Child, Command, Stdio};

/// What is typed after "with: ", up to the end of the line.
fn printed(said: &str) -> String {
    let (_, command) = said.split_once("with: ").unwrap_or_else(|| panic!("no command: {said}"));
    command.lines().next().unwrap().to_owned()
}

/// Runs a line of the shell in its own process and stops dem-run once it has written checkpoints.
fn stopped(folder: &Path, scene: &str, rest: &[&str], stdout: Stdio) -> String {
    let mut command = Command::new(program("dem-run"));
    command.current_dir(folder).arg(scene).args(["--until", "1000", "--set", "output.every=0.01"]).args(rest);
    let child: Child = command.stdout(stdout).stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(std::time::Duration::from_millis(1500));
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    let done = child.wait_with_output().unwrap();
    assert_eq!(done.status.code(), Some(3));
    String::from_utf8(done.stderr).unwrap()
}

/// The time at which a run stopped [s].
fn time(said: &str) -> f64 {
    said.split("at t = ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap()
}

#[test]
fn the_command_after_a_signal_works_as_printed() {
    let folder = folder(&[("my plant's.toml", &*poured())]);
    let folder = folder.path();
    let said = stopped(folder, "my plant's.toml", &["-qo", "a run.mcap"], Stdio::null());
    let command = printed(&said);
    assert!(
        command.ends_with("--resume 'a run.mcap' -o 'a run.2.mcap'") && command.contains(" -q "),
        "{said}"
    );
    // As printed, but for the end of the run, which a test cannot wait for.
    let soon = |command: &str, said: &str| {
        command.replace("--until 1000", &format!("--until {}", time(said) + 0.02))
    };
    let done = line(folder, &soon(&command, &said));
    assert_eq!(done.code, 0, "{command}: {}", done.stderr);
    // The whole run, and 0.02 s more with frames of 0.01 s, the last step being one.
    let [before, count] = ["a run.mcap", "a run.2.mcap"].map(|name| frames(&folder.join(name)).len());
    assert!(count == before + 2 || count == before + 3, "{before} frames, then {count}");
    // stdout that was sent to a file.
    let to = fs::File::create(folder.join("piped.mcap")).unwrap();
    let said = stopped(folder, "my plant's.toml", &[], to.into());
    let command = printed(&said);
    assert!(command.contains("piped.mcap -o "), "{said}");
    let done = line(folder, &soon(&command, &said));
    assert!(done.code == 0 && folder.join("piped.2.mcap").exists(), "{command}: {}", done.stderr);
}

#[test]
fn the_command_after_a_guard_goes_past_it() {
    let folder = with(&poured());
    let call = ["s.toml", "-o", "run.mcap", "--set", "guards.overlap=0.02", "--set", "time.safety=0.2"];
    let done = tool(folder.path(), "dem-run", &call);
    assert_eq!(done.code, 3, "{}", done.stderr);
    let command = printed(&done.stderr);
    assert!(
        command.contains("--set guards.overlap=0.04") && command.contains("--resume run.mcap"),
        "{command}"
    );
    let done = line(folder.path(), &command);
    // It goes on from there; a wider guard may trip as well, and prints its command.
    assert!(
        done.code == 0 || (done.code == 3 && done.stderr.contains("guards.overlap=0.08")),
        "{}",
        done.stderr
    );
    assert!(folder.path().join("run.2.mcap").exists());
}

/// Grains that are inserted until they pile up to where they come in.
const PILED: &str = r#"gravity = [0, 0, -9.81]
[time]
until = 1.5
[output]
every = 0.02
[[material]]
name = "g"
density = 2500
young = 2e6
poisson = 0.3
[[contact]]
between = ["*", "*"]
restitution = 0.5
sliding_friction = 0.3
[[insert]]
material = "g"
shape = "box:0,0,0.02,0.03,0.03,0.03"
diameter = 0.006
velocity = [0, 0, -0.3]
rate_count = 300
[[wall]]
box = [-0.003, -0.003, 0, 0.033, 0.033, 0.1]
faces = ["x-", "x+", "y-", "y+", "z-"]
material = "g"
"#;

/// What is said is about an insert, and the command goes on, with all that was written before: what finds no room waits from then on.
#[test]
fn the_command_after_an_insert_without_room_goes_past_it() {
    let folder = with(PILED);
    let stop = "insert.0.when_blocked=stop";
    let said = tool(folder.path(), "dem-run", &["s.toml", "-q", "--set", stop, "-o", "run.mcap"]);
    assert_eq!(said.code, 3, "{}", said.stderr);
    for words in
        ["of 1.5 s", "insert 0 has no room", "insert.0.rate", "--set insert.0.when_blocked=wait", "--whole"]
    {
        assert!(said.stderr.contains(words), "{words}: {}", said.stderr);
    }
    assert!(!said.stderr.contains("inlet") && !said.stderr.contains("stage-replay"), "{}", said.stderr);
    let on = line(folder.path(), &printed(&said.stderr));
    assert!(on.code == 0 || time(&on.stderr) > time(&said.stderr), "{}", on.stderr);
    assert!(!on.stderr.contains("has no room"), "{}", on.stderr);
    let frames = ["run.mcap", "run.2.mcap"].map(|name| frames(&folder.path().join(name)).len());
    assert!(frames[1] >= frames[0], "{frames:?}");
}

#[test]
fn files_in_the_wrong_place_are_told() {
    let folder =
        folder(&[("a.toml", &*poured()), ("b.toml", &*poured()), ("x.ply", "ply\nformat ascii 1.0\n")]);
    succeed(folder.path(), "dem-run", &["a.toml", "--until", "0.01", "-o", "run.mcap"]);
    for (words, told) in [
        (vec!["a.toml", "b.toml"], "b.toml is a second scene, and a run has one"),
        (vec!["a.toml", "b.toml", "--check"], "dem-run a.toml -o A.mcap && dem-run b.toml -o B.mcap"),
        (vec!["run.mcap", "a.toml"], "run.mcap is an MCAP file, and the first file is the scene"),
        (vec!["run.mcap"], "dem-run SCENE.toml --resume run.mcap"),
        (vec!["x.ply", "a.toml"], "x.ply is a cloud or a mesh"),
        (vec!["a.toml", "x.ply"], "x.ply holds no walls of dem-run: make walls of a cloud with wallgen"),
    ] {
        let done = tool(folder.path(), "dem-run", &words);
        assert!(done.code == 2 && done.stderr.contains(told), "{words:?}: {} {}", done.code, done.stderr);
    }
}
