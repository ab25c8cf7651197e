//! cost-curve from outside: a small grid, an interrupted sweep, a changed scene, repeats, what is refused; and the step that an
//! accuracy asks for.

mod plots;

use grainpipe_tests::scenes::{Head, folder};
use grainpipe_tests::tools::{Done, program, succeed, tool};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;
use tempfile::TempDir;

/// A ball that falls 10 cm: z = z₀ − g t²/2 whatever the step; a ball that hits the floor: its speed depends on the step.
const DROP: Head = Head {
    time: "until = 0.16\nsafety = 0.5",
    output: "every = 0.02\ncontacts = true",
    material: "stone",
    density: 2500.0,
    young: 1e7,
    contact: "law = \"hooke\"\nstiffness = 1e4\nrestitution = 0.5",
};

fn dropped() -> String {
    let ball = "[[particles]]\nsource = \"ball.csv\"\nmaterial = \"stone\"\n";
    // Sampled, an impact has errors that are worth a curve.
    let scene = format!("{}{ball}{}", DROP.toml(), DROP.floor());
    scene.replace("safety = 0.5\n", "safety = 0.5\ncontacts = \"sampled\"\n")
}

const IMPACT: [&str; 6] = ["--set", "output.every=0.0004", "--measure", "restitution", "--exact", "0.5"];

/// The same at one phase of the step: one run for each setting.
const ONE: [&str; 8] =
    ["--set", "output.every=0.0004", "--measure", "restitution", "--exact", "0.5", "--phases", "1"];

fn with(scene: &str) -> TempDir {
    folder(&[("s.toml", scene), ("ball.csv", "id,x,y,z,radius,vz\n0,0,0,0.055,0.005,-1\n")])
}

fn curve(folder: &TempDir, options: &[&str]) -> Done {
    succeed(folder.path(), "cost-curve", &[&["s.toml"], options].concat())
}

fn refused(folder: &TempDir, options: &[&str], code: i32) -> String {
    let done = tool(folder.path(), "cost-curve", &[&["s.toml"], options].concat());
    assert_eq!(done.code, code, "{options:?}: {}", done.stderr);
    done.stderr
}

/// Without a reference the other runs tell nothing: it is run first, and alone where it fails.
#[test]
fn a_reference_that_cannot_be_run_ends_the_study_at_once() {
    let folder = with(&dropped());
    let vary = [
        "--vary",
        "stiffness=1,0.001",
        "--vary",
        "safety=0.4,0.8",
        "--reference",
        "stiffness=0.001",
        "--reference",
        "safety=0.4",
    ];
    let said = refused(&folder, &[&vary[..], &["--measure", "restitution", "--dir", "study"]].concat(), 1);
    assert!(said.contains("the reference cannot be run"), "{said}");
    let made = fs::read_dir(folder.path().join("study")).unwrap().filter_map(Result::ok);
    let made: Vec<_> =
        made.filter(|run| run.path().join("made").exists()).map(|run| run.file_name()).collect();
    assert_eq!(made.len(), 1, "{made:?}");
}

/// Cells of a column of the CSV; cells in quotes stay whole.
fn column(done: &Done, name: &str) -> Vec<String> {
    let text = String::from_utf8_lossy(&done.stdout).into_owned();
    let cells = |line: &str| {
        let (mut list, mut quoted) = (vec![String::new()], false);
        for c in line.chars() {
            match c {
                '"' => quoted = !quoted,
                ',' if !quoted => list.push(String::new()),
                c => list.last_mut().unwrap().push(c),
            }
        }
        list
    };
    let mut lines = text.lines();
    let heads = cells(lines.next().unwrap());
    let at = heads
        .iter()
        .position(|h| h.split(' ').next() == Some(name))
        .unwrap_or_else(|| panic!("{name} in {heads:?}"));
    lines.map(|line| cells(line)[at].clone()).collect()
}

fn numbers(done: &Done, name: &str) -> Vec<f64> {
    column(done, name).iter().map(|cell| cell.parse().unwrap_or(f64::NAN)).collect()
}

#[test]
fn a_small_grid_gives_errors_a_plot_words_and_a_recommended_setting() {
    let folder = with(&dropped());
    let files = ["-o", "x.svg", "--words", "w.md", "--report", "r.json", "--work", "steps"];
    let done =
        curve(&folder, &[&ONE[..], &["--vary", "safety=0.02,0.1,0.5", "--for", "3%"], &files].concat());
    let errors = numbers(&done, "error");
    assert!(errors[0] < errors[2] && errors[2] < 0.2, "{errors:?}");
    let steps = numbers(&done, "steps_per_second");
    assert!((steps[0] / steps[2] - 25.0).abs() < 0.1, "{steps:?}");
    let marks = column(&done, "mark");
    // The truth of the recommendation is worked out here again: the fewest steps with an error of at most 3 %.
    let good = (0..3).rev().find(|k| errors[*k] <= 0.03).unwrap();
    assert!(marks[good].contains("recommended") && marks[2].contains("in-use"), "{marks:?} {errors:?}");
    assert!(fs::read_to_string(folder.path().join("x.svg")).unwrap().contains("<svg"));
    let words = fs::read_to_string(folder.path().join("w.md")).unwrap();
    assert!(
        words.contains("safety ÷ 25 (0.02) leaves") && words.contains("takes 25 times the steps"),
        "{words}"
    );
    let report: Value = serde_json::from_slice(&fs::read(folder.path().join("r.json")).unwrap()).unwrap();
    assert_eq!((report["runs"].as_u64(), report["kept"].as_u64()), (Some(3), Some(0)));
    assert_eq!(report["in_use"]["safety"], "0.5");
    let again = curve(
        &folder,
        &[&ONE[..], &["--vary", "safety=0.02,0.1,0.5", "--work", "steps", "-o", "x.png"]].concat(),
    );
    assert!(again.stderr.contains("3 of them made before"), "{}", again.stderr);
    assert_eq!(numbers(&again, "error"), errors);
    assert!(fs::read(folder.path().join("x.png")).unwrap().starts_with(b"\x89PNG"));
}

/// Heights of the ball in 40 further scenes: its impact begins at other phases of the step than in any run of the sweep.
fn worst_of_other_heights(folder: &TempDir, safety: &str) -> f64 {
    let mut balls = "id,x,y,z,radius,vz\n".to_owned();
    for k in 0..40 {
        let z = 0.055 + 0.004 * (0.31 + 0.754_877_666 * f64::from(k)).fract();
        balls += &format!("{k},{},0,{z:?},0.005,-1\n", 0.02 * f64::from(k));
    }
    fs::write(folder.path().join("many.csv"), balls).unwrap();
    let sets = [format!("time.safety={safety}"), "particles.0.source=many.csv".to_owned()];
    let options =
        ["s.toml", "--set", &sets[0], "--set", &sets[1], "--set", "output.every=0.0004", "-o", "many.mcap"];
    succeed(folder.path(), "dem-run", &options);
    let found = numbers(&succeed(folder.path(), "dem-measure", &["many.mcap", "--impact"]), "restitution");
    assert_eq!(found.len(), 40, "every ball hits the floor once");
    found.iter().map(|e| (e / 0.5 - 1.0).abs()).fold(0.0, f64::max)
}

/// One impact begins at one phase of the step, which hides what the next one will be off by.
#[test]
fn what_is_recommended_holds_at_every_phase_of_the_step() {
    let folder = with(&dropped());
    let options =
        ["--vary", "safety=0.02,0.03,0.05,0.07,0.1,0.15,0.2,0.3,0.5", "--for", "3%", "--work", "steps"];
    let recommended = |done: &Done| {
        let at = column(done, "mark").iter().position(|m| m.contains("recommended")).unwrap();
        column(done, "safety")[at].clone()
    };
    let one = recommended(&curve(&folder, &[&ONE[..], &options].concat()));
    assert!(
        worst_of_other_heights(&folder, &one) > 0.03,
        "safety {one} of one phase holds, and it should not"
    );
    let done = curve(&folder, &[&IMPACT[..], &options].concat());
    assert_eq!(numbers(&done, "repeats"), [8.0; 9]);
    assert!(done.stderr.contains("72 runs, 9 of them made before"), "{}", done.stderr);
    assert!(done.stderr.contains("worst of 8 phases of the step"), "{}", done.stderr);
    let steps = numbers(&done, "steps_per_second");
    assert!((steps[0] / steps[8] - 25.0).abs() < 0.1, "shorter steps of the phases do not count: {steps:?}");
    let all = recommended(&done);
    let worst = worst_of_other_heights(&folder, &all);
    assert!(worst <= 0.03, "safety {all}: {worst}");
}

#[test]
fn finished_points_are_used_changed_ones_made_again_and_lines_can_be_spread() {
    let folder = with(&dropped());
    let vary = ["--vary", "safety=0.1,0.3,0.5", "--dir", "points"];
    let options = [&ONE[..], &vary].concat();
    let listed = curve(&folder, &[&options[..], &["--print-commands"]].concat());
    let lines: Vec<String> = String::from_utf8_lossy(&listed.stdout).lines().map(str::to_owned).collect();
    assert_eq!(lines.len(), 3);
    assert!(lines[0].contains("# dem-run s.toml") && lines[0].contains("--set time.safety=0.1"), "{lines:?}");
    // One point by another hand, one that was killed while it ran: its folder is there, and nothing says that it is whole.
    let status = Command::new("bash").args(["-c", &lines[0]]).current_dir("/").status();
    assert!(status.unwrap().success());
    fs::write(folder.path().join("points/safety=0.3/run.mcap"), "half a run").unwrap();
    let done = curve(&folder, &options);
    assert!(done.stderr.contains("3 runs, 1 of them made before"), "{}", done.stderr);
    // Another scene: nothing of it is taken.
    fs::write(folder.path().join("s.toml"), dropped().replace("restitution = 0.5", "restitution = 0.6"))
        .unwrap();
    let done = curve(&folder, &options);
    assert!(done.stderr.contains("3 of 3 runs there used another scene"), "{}", done.stderr);
    assert!(done.stderr.contains("3 runs, 0 of them made before"), "{}", done.stderr);
    // And other particles, though the scene is the same.
    fs::write(folder.path().join("ball.csv"), "id,x,y,z,radius,vz\n0,0,0,0.056,0.005,-1\n").unwrap();
    let done = curve(&folder, &options);
    assert!(done.stderr.contains("3 of 3 runs there used another scene"), "{}", done.stderr);
}

#[test]
fn an_interrupted_sweep_goes_on_from_where_it_was() {
    let folder = with(&dropped());
    let options =
        [&["s.toml"], &ONE[..], &["--vary", "safety=0.1,0.3,0.5", "--rounds", "100", "-q"]].concat();
    let mut command = Command::new(program("cost-curve"));
    command.args(&options).current_dir(folder.path()).stdout(Stdio::null()).stderr(Stdio::piped());
    let child = command.spawn().unwrap();
    let first = folder.path().join("cost-curve.points/safety=0.1/made");
    while !first.exists() {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap().success());
    let done: Done = child.wait_with_output().unwrap().into();
    assert_eq!(done.code, 3, "{}", done.stderr);
    assert!(done.stderr.contains("of 300 runs are finished: the same command continues"), "{}", done.stderr);
    let options =
        [&ONE[..], &["--vary", "safety=0.1,0.3,0.5", "--rounds", "2", "--report", "r.json"]].concat();
    curve(&folder, &options);
    let report: Value = serde_json::from_slice(&fs::read(folder.path().join("r.json")).unwrap()).unwrap();
    assert!(report["kept"].as_u64() >= Some(1) && report["runs"] == 6, "{report}");
}

#[test]
fn repeats_have_an_interval_and_blanks_are_filled_before_the_run() {
    let fill = "[[fill]]\nmaterial = \"stone\"\nshape = \"box:0,0,0.01,0.1,0.1,0.05\"\ndiameter = [0.004, 0.01]\ncount = 20\n[[wall]]";
    let whole = dropped();
    let (head, tail) = whole.split_once("[[particles]]").unwrap();
    let scene = format!("{head}{fill}{}", tail.split_once("[[wall]]").unwrap().1);
    let folder = with(&scene);
    let options = ["--vary", "safety=0.1,0.5", "--repeat", "3", "--work", "cpu"];
    let options = [&options[..], &["--measure", "bed-height --ground 0"]].concat();
    let done = curve(&folder, &options);
    let (intervals, seeds) = (numbers(&done, "value_interval"), numbers(&done, "repeats"));
    assert_eq!(seeds, [3.0, 3.0]);
    assert!(numbers(&done, "work").iter().all(|w| *w > 0.0 && *w < 1000.0), "processor time");
    assert!(intervals.iter().all(|i| *i > 0.0), "other seeds, other heaps: {intervals:?}");
    assert!(folder.path().join("cost-curve.points/safety=0.1,seed=2/run.mcap").exists());
    // The same runs, measured otherwise: a profile against that of the finest setting.
    let profile =
        ["--measure", "velocity-profile --bins 4 --within box:0,0,0,0.1,0.1,0.05 --mean", "--for", "300%"];
    let done = curve(&folder, &[&options[..6], &profile].concat());
    assert!(done.stderr.contains("6 runs, 6 of them made before"), "{}", done.stderr);
    let (error, interval) = (numbers(&done, "error"), numbers(&done, "error_interval"));
    assert!(error[0] == 0.0 && error[1] > 0.0 && interval[1] > 0.0, "{error:?} ± {interval:?}");
    // A line of the shell makes the input; one that prints nothing gives none.
    let height = ["--measure", "bed-height --ground 0", "--reference", "count=2"];
    let done =
        curve(&folder, &[&["--vary", "count=1,2", "--each", "echo {count} >&2"], &height[..]].concat());
    assert_eq!(numbers(&done, "error"), [0.0, 0.0], "the same run");
    assert!(numbers(&done, "prepare").iter().all(|s| *s > 0.0));
    let blank =
        ["--vary", "count=1,2", "--each", "echo {count} {left}", "--measure", "bed-height", "--exact", "1"];
    let done = tool(folder.path(), "cost-curve", &[&["s.toml"], &blank[..]].concat());
    assert!(done.code == 2 && done.stderr.contains("nothing fills {left}: vary left"), "{}", done.stderr);
    let options = [
        "--vary",
        "count=1,2",
        "--each",
        "echo {count} >&2; false",
        "--measure",
        "bed-height",
        "--exact",
        "1",
    ];
    let why = refused(&folder, &options, 1);
    assert!(why.contains("no point can be run: count 1: --each: 1"), "{why}");
}

#[test]
fn a_point_that_cannot_run_is_told_and_the_rest_is_judged() {
    let folder = with(&dropped());
    let vary = ["--vary", "dt=1e-5,1e-2", "--reference", "dt=1e-5"];
    let done = curve(&folder, &[&IMPACT[..4], &vary].concat());
    let (state, why) = (column(&done, "state"), column(&done, "why"));
    assert_eq!(state[..2], ["done", "failed"], "{state:?}");
    assert!(why[1].contains("0.01") || why[1].contains("1e-2") || why[1].contains("1.0000e-2"), "{why:?}");
    assert!(done.stderr.contains("cannot be run: dem-run:"), "{}", done.stderr);
}

#[test]
fn what_is_wrong_is_refused_before_anything_runs() {
    let folder = with(&dropped());
    let vary = ["--vary", "safety=0.1,0.5"];
    let with = |more: &[&str]| refused(&folder, &[&vary[..], more].concat(), 2);
    assert!(with(&["--measure", "heap-angel"]).contains("did you mean 'heap-angle'?"));
    assert!(with(&["--measure", "restitution", "-o", "x.pdf"]).contains("must end in .svg or .png"));
    assert!(with(&["--measure", "restitution", "--repeat", "3"]).contains("s.toml uses no random numbers"));
    assert!(with(&["--measure", "restitution", "--for", "-1%"]).contains("give a share such as 1%"));
    assert!(with(&["--measure", "restitution", "--laboratory", "a,b"]).contains("half width"));
    assert!(with(&["--measure", "restitution", "--reference", "dt=1"]).contains("is not varied"));
    let why = refused(&folder, &["--vary", "gravity=[0,0,-9],[0,0,-1]", "--measure", "restitution"], 2);
    assert!(why.contains("say --reference gravity=[0,0,-9]"), "{why}");
    let why =
        refused(&folder, &["--vary", "time.saftey=0.1,0.5", "--measure", "restitution", "--exact", "1"], 1);
    assert!(why.contains("unknown key 'saftey'; did you mean 'safety'?"), "{why}");
    for more in [&[][..], &["--exact", "1"]] {
        let why =
            refused(&folder, &[&["--vary", "safty=0.1,0.5", "--measure", "restitution"], more].concat(), 2);
        assert!(why.contains("--vary safty: there is no such key; did you mean 'safety'?"), "{why}");
    }
    for (set, part) in [("time.dt", "'=' is missing"), ("fill.7.count=1", "no list 'fill'")] {
        let why = with(&["--measure", "restitution", "--set", set]);
        assert!(why.contains(&format!("--set {set}: ")) && why.contains(part), "{why}");
    }
    let why = refused(&folder, &["--vary", "safety=0.1,7", "--measure", "restitution"], 1);
    assert!(why.contains("point safety=7") && why.contains("time.safety = 7"), "{why}");
    let why = refused(
        &folder,
        &["--vary", "safety=0.5,0.6", "--measure", "angle of --impact", "--set", "output.every=4e-4"],
        2,
    );
    assert!(why.contains("--impact has no 'angle': it has"), "{why}");
    let why = refused(
        &folder,
        &[
            "--vary",
            "safety=0.5,0.6",
            "--measure",
            "restitution",
            "--for",
            "0.1",
            "--set",
            "output.every=4e-4",
        ],
        2,
    );
    assert!(why.contains("shares of it: give a share, such as 1%"), "{why}");
}

/// Pairs that meet head-on at 4.295 m/s, at other phases of a step than those that the curve was measured with.
fn pairs(folder: &Path) {
    let mut text = "id,x,y,z,radius,vx\n".to_owned();
    for k in 0..60 {
        let gap = 0.0003 + 0.002 * (0.1 + 0.754_877_666 * f64::from(k)).fract();
        let (y, v) = (0.02 * f64::from(k), 4.295 / 2.0);
        text += &format!(
            "{},{:?},{y},0,0.005,{v}\n{},{:?},{y},0,0.005,{:?}\n",
            2 * k,
            -0.005 - gap / 2.0,
            2 * k + 1,
            0.005 + gap / 2.0,
            -v
        );
    }
    fs::write(folder.join("ball.csv"), text).unwrap();
}

/// Largest relative error of the restitution of those pairs, and the report of the run.
fn impact_error(folder: &TempDir, accuracy: &str, restitution: f64) -> (f64, Value) {
    pairs(folder.path());
    let set = format!("time.accuracy={accuracy}");
    let e = format!("contact.0.restitution={restitution}");
    let arguments = ["s.toml", "--set", &set, "--set", &e, "-o", "run.mcap", "--report", "r.json"];
    succeed(folder.path(), "dem-run", &arguments);
    let done = succeed(folder.path(), "dem-measure", &["run.mcap", "--impact"]);
    let found = numbers(&done, "restitution");
    assert_eq!(found.len(), 60, "every pair meets once");
    let worst = found.iter().map(|v| (v / restitution - 1.0).abs()).fold(0.0, f64::max);
    (worst, serde_json::from_slice(&fs::read(folder.path().join("r.json")).unwrap()).unwrap())
}

/// The step that an accuracy asks for gives it, on the impact that its curve was measured with, at other phases.
#[test]
fn the_step_that_an_accuracy_picks_gives_it() {
    let impact = dropped()
        .replace("gravity = [0, 0, -9.81]\n", "")
        .replace("until = 0.16\nsafety = 0.5", "until = 0.0035")
        .replace("every = 0.02", "every = \"step\"");
    let impact = impact.split("[[wall]]").next().unwrap();
    let hertz = impact.replace("law = \"hooke\"\nstiffness = 1e4\n", "");
    for (law, scene) in [("hooke", impact), ("hertz", &hertz)] {
        let folder = with(scene);
        for accuracy in [0.05, 0.01] {
            for restitution in [0.1, 0.5, 0.9] {
                let (error, report) = impact_error(&folder, &format!("{}%", 100.0 * accuracy), restitution);
                println!("{law} {accuracy} e {restitution}: {error:.5}, {}", report["chosen_by"]);
                assert!(error <= accuracy, "{law}, {accuracy}, e = {restitution}: {error}");
                let why = report["chosen_by"].as_str().unwrap();
                assert!(why.contains(law) && why.contains("impact-error.csv"), "{why}");
            }
        }
        let (hit, _) = impact_error(&folder, "1%", 0.3);
        assert!(hit > 0.003, "{law}: the step is not smaller than it needs to be: {hit}");
    }
}

#[test]
fn an_accuracy_is_explained_and_what_contradicts_it_is_refused() {
    let folder = with(&dropped().replace("safety = 0.5\n", "accuracy = \"2%\"\n"));
    let done = succeed(folder.path(), "dem-run", &["s.toml", "--explain"]);
    let text = String::from_utf8_lossy(&done.stdout).into_owned();
    assert!(
        text.contains("chosen by")
            && text.contains("time.accuracy 2 %: safety 0.0")
            && text.contains("hooke"),
        "{text}"
    );
    let refuse = |set: &str| {
        let done = tool(folder.path(), "dem-run", &["s.toml", "--set", set, "--check"]);
        assert_eq!(done.code, 1, "{set}: {}", done.stderr);
        done.stderr
    };
    let why = refuse("time.safety=0.2");
    assert!(
        why.contains("time.accuracy = 2 %: safety = 0.2 sets the step already; take one of them out"),
        "{why}"
    );
    assert!(refuse("time.dt=1e-6").contains("dt = 0.000001 s sets the step already"));
    assert!(
        refuse("time.accuracy=\"0.0001%\"")
            .contains("is less than any measured step reaches with law \"hooke\"")
    );
    assert!(refuse("time.accuracy=high").contains("expected a share such as \"1%\" or 0.01"));
    assert!(refuse("time.accuracy=-1").contains("time.accuracy"));
}
