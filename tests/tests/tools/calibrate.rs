//! calibrate: killed at any instant, listed as jobs, or shared by two processes, it comes to the same end.

use crate::every_option::files::inputs;
use grainpipe_tests::tools::{line, program, succeed, tool};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

/// A recipe of two parameters whose runs take a while.
fn slow(folder: &Path) {
    let text = fs::read_to_string(folder.join("recipe.toml")).unwrap();
    let text = text
        .replace("trials = 12", "trials = 14\nfirst = 10\nbatch = 2")
        .replace("awk 'BEGIN", "sleep 0.03; awk 'BEGIN");
    fs::write(folder.join("slow.toml"), text).unwrap();
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}

#[test]
fn a_killed_calibration_goes_on_to_the_same_end() {
    let folder = inputs();
    let path = folder.path();
    slow(path);
    let options =
        |dir: &str, out: &str| format!("slow.toml --data shear.csv --jobs 1 -q --dir {dir} -o {out}");
    let words = |text: String| text.split(' ').map(str::to_owned).collect::<Vec<_>>();
    let whole = words(options("a", "a.csv"));
    succeed(path, "calibrate", &whole.iter().map(String::as_str).collect::<Vec<_>>());
    for wait in [40, 90, 170, 60, 110, 20] {
        let mut command = Command::new(program("calibrate"));
        command.current_dir(path).args(words(options("b", "b.csv"))).stderr(Stdio::null());
        let mut child = command.spawn().unwrap();
        std::thread::sleep(Duration::from_millis(wait));
        child.kill().unwrap();
        child.wait().unwrap();
    }
    assert!(!path.join("b.csv").exists(), "it was killed before its end");
    let again = words(options("b", "b.csv"));
    succeed(path, "calibrate", &again.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(read(path, "a.csv"), read(path, "b.csv"));
    let left = Command::new("find")
        .args(["b", "-name", "*.part-*", "-o", "-name", "*.lock"])
        .current_dir(path)
        .output()
        .unwrap();
    assert_eq!(String::from_utf8_lossy(&left.stdout), "", "nothing is left over");
}

#[test]
fn jobs_that_others_run_give_the_same_end() {
    let folder = inputs();
    let path = folder.path();
    succeed(path, "calibrate", &["recipe.toml", "--data", "shear.csv", "-q", "--dir", "a", "-o", "a.csv"]);
    let mut rounds = 0;
    loop {
        let options = [
            "recipe.toml",
            "--data",
            "shear.csv",
            "-q",
            "--dir",
            "b",
            "--jobs-file",
            "jobs.txt",
            "-o",
            "b.csv",
        ];
        succeed(path, "calibrate", &options);
        let jobs = read(path, "jobs.txt");
        if jobs.is_empty() {
            break;
        }
        assert!(!path.join("b.csv").exists());
        jobs.lines().for_each(|job| assert_eq!(line(path, job).code, 0, "{job}"));
        rounds += 1;
        assert!(rounds < 9, "it comes to an end");
    }
    // The last one simulates the best point.
    assert_eq!((read(path, "a.csv"), rounds), (read(path, "b.csv"), 3));
}

/// Trials are judged without the others, by other data, and in a folder that goes on afterwards.
#[test]
fn the_trials_so_far_are_judged_and_nothing_is_run() {
    let folder = inputs();
    let path = folder.path();
    let data = ["recipe.toml", "--data", "shear.csv", "--dir", "a"];
    let of = |more: &[&str]| tool(path, "calibrate", &[&data[..], more].concat());
    let none = of(&["--so-far"]);
    assert!(none.code == 1 && none.stderr.contains("no trials are there yet"), "{}", none.stderr);
    assert_eq!(of(&["-q", "-o", "all.csv"]).code, 0);
    let value = |file: &str| -> f64 {
        read(path, file).lines().nth(1).unwrap().split(',').nth(2).unwrap().parse().unwrap()
    };
    let trials = || fs::read_dir(path.join("a/trials")).unwrap().count();
    let before = trials();
    assert_eq!(of(&["--so-far", "-q", "-o", "again.csv"]).code, 0);
    let width = |file: &str| -> f64 {
        let text = read(path, file);
        let cells: Vec<&str> = text.lines().nth(1).unwrap().split(',').collect();
        cells[4].parse::<f64>().unwrap() - cells[3].parse::<f64>().unwrap()
    };
    // The same trials: another start of the emulator's lengths, and other random numbers.
    assert!((value("again.csv") - value("all.csv")).abs() < 0.3 * width("all.csv"));
    assert_eq!(trials(), before, "nothing was run");
    // A folder that holds a few of them, of which one was cut off.
    for k in (before / 2 + 1)..=before {
        fs::remove_dir_all(path.join(format!("a/trials/{k:04}"))).unwrap();
    }
    let half = of(&["--so-far", "-o", "half.csv"]);
    assert!(half.code == 0 && half.stderr.contains(&format!("{} trials", before / 2)), "{}", half.stderr);
    for k in 2..=before / 2 {
        fs::remove_dir_all(path.join(format!("a/trials/{k:04}"))).unwrap();
    }
    let one = of(&["--so-far"]);
    assert!(one.code == 1 && one.stderr.contains("too few to learn from"), "{}", one.stderr);
    // The calibration itself goes on, to the same end.
    assert_eq!(of(&["-q", "-o", "end.csv"]).code, 0);
    assert_eq!(read(path, "end.csv"), read(path, "all.csv"));
}

/// Trials that are not those of the recipe as it is now: bounds, held values, commands, failures.
#[test]
fn what_trials_so_far_cannot_tell_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let recipe = |bounds: &str, value: f64, awk: &str| {
        let text = format!(
            "[settings]\ntrials = 16\nfirst = 12\n[[parameter]]\nname = \"a\"\nbounds = {bounds}\n[[parameter]]\nname = \"b\"\nbounds = [0, 10]\n\
             [[test]]\nname = \"one\"\ncommand = \"awk 'BEGIN {{ print {{a}} + {{seed}} * 1e-9 }}'\"\nvalue = {value}\ndeviation = 0.1\n\
             [[test]]\nname = \"sum\"\ncommand = \"awk 'BEGIN {{ print {awk} }}'\"\nvalue = 7\ndeviation = 0.1\n\
             [[step]]\nname = \"A\"\nfit = \"a\"\nto = [\"one\"]\n[[step]]\nname = \"B\"\nfit = \"b\"\nto = [\"sum\"]\n"
        );
        fs::write(path.join("r.toml"), text).unwrap();
    };
    let so_far = |more: &[&str]| {
        let done = tool(path, "calibrate", &[&["r.toml", "--so-far", "--dir", "t"], more].concat());
        (done.code, done.stderr)
    };
    recipe("[0, 10]", 3.0, "{a} + {b}");
    succeed(path, "calibrate", &["r.toml", "-q", "--dir", "t", "-o", "x.csv"]);
    let (code, said) = so_far(&[]);
    assert!(code == 0 && !said.contains("warning"), "{said}");
    // Bounds that leave the best trials out: the interval is inside of them.
    recipe("[4, 10]", 3.0, "{a} + {b}");
    let (code, said) = so_far(&["-o", "y.csv"]);
    let low: f64 = read(path, "y.csv").lines().nth(1).unwrap().split(',').nth(3).unwrap().parse().unwrap();
    assert!(code == 0 && low >= 4.0, "{low} {said}");
    // Other data: the second step's trials hold what the first one found then.
    recipe("[0, 10]", 5.0, "{a} + {b}");
    let (_, said) = so_far(&[]);
    assert!(said.contains("step 'B': its trials hold a = 3") && said.contains("step 'A' finds"), "{said}");
    // Another command.
    recipe("[0, 10]", 3.0, "{b} + {a}");
    let (_, said) = so_far(&[]);
    assert!(
        said.contains("of another command, seed, or version") && said.contains("step 'B' has 0 trials"),
        "{said}"
    );
    let (code, said) = so_far(&["--seed", "7"]);
    assert!(code == 1 && said.contains("trials that are left out"), "{said}");
    // Data in another unit.
    recipe("[0, 10]", 3000.0, "{a} + {b}");
    let (code, said) = so_far(&[]);
    assert!(code == 1 && said.contains("are the units the same?"), "{said}");
}

#[test]
fn errors_end_with_the_right_code() {
    let folder = inputs();
    let path = folder.path();
    let no_data = tool(path, "calibrate", &["recipe.toml"]);
    assert!(no_data.code == 1 && no_data.stderr.contains("recipe.toml:"), "{}", no_data.stderr);
    for (options, message) in [
        (&["recipe.toml", "--data", "other=shear.csv"][..], "no test 'other'"),
        (&["--data", "shear.csv"], "name a recipe"),
        (&["recipe.toml", "--data", "shear.csv", "--plot", "fit.pdf"], "must end in .svg or .png"),
        (
            &["--guess", "--material", "sandd", "--size", "1mm", "--moisture", "dry", "--repose-deg", "30"],
            "did you mean 'sand'?",
        ),
        (&["--guess", "--material", "sand"], "Give --size"),
    ] {
        let done = tool(path, "calibrate", options);
        assert!(
            done.code == 2 && done.stderr.contains(message),
            "{options:?}: {} {}",
            done.code,
            done.stderr
        );
    }
}

#[test]
fn tests_with_the_same_command_share_its_runs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let test = |name: &str, value: f64| {
        format!(
            "[[test]]\nname = \"{name}\"\ncommand = \"echo run >> {{here}}/log; awk 'BEGIN {{ print \\\"sum,product\\\"; print {{a}} + {{b}} \\\",\\\" {{a}} * {{b}} }}' > both.csv\"\n\
             read = \"both.csv\"\ny = \"{name}\"\nvalue = {value}\ndeviation = 0.05\n"
        )
    };
    let parameter = |name: &str, low: f64, high: f64| {
        format!("[[parameter]]\nname = \"{name}\"\nbounds = [{low}, {high}]\n")
    };
    let settings = "[settings]\ntrials = 16\nfirst = 8\nbatch = 4\n".to_owned();
    let text = [
        settings,
        parameter("a", 0.0, 2.0),
        parameter("b", 2.0, 5.0),
        test("sum", 4.0),
        test("product", 3.0),
    ];
    fs::write(path.join("both.toml"), text.concat()).unwrap();
    succeed(path, "calibrate", &["both.toml", "-q", "--jobs", "2", "--dir", "trials", "-o", "found.csv"]);
    let trials = read(path, "trials/trials.csv").lines().count() - 1;
    assert_eq!(
        read(path, "log").lines().count(),
        trials + 1,
        "each trial ran its command once, and the best point"
    );
    let found = read(path, "found.csv");
    let value = |name: &str| {
        let row = found.lines().find(|l| l.starts_with(&format!("{name},"))).unwrap();
        row.split(',').nth(2).unwrap().parse::<f64>().unwrap()
    };
    assert!((value("a") - 1.0).abs() < 0.1 && (value("b") - 3.0).abs() < 0.1, "{found}");
}

/// The same data as two specimens would make intervals too small, under whatever name.
#[test]
fn a_specimen_counts_once() {
    let folder = inputs();
    let path = folder.path();
    fs::copy(path.join("shear.csv"), path.join("copy.csv")).unwrap();
    let name = read(path, "recipe.toml");
    let test = name.split("[[test]]\nname = \"").nth(1).unwrap().split('"').next().unwrap().to_owned();
    for (file, told) in
        [("shear.csv", "shear.csv: is given twice"), ("copy.csv", "copy.csv: holds the same as")]
    {
        let (one, other) = (format!("{test}=shear.csv"), format!("{test}={file}"));
        let done = tool(path, "calibrate", &["recipe.toml", "--data", &one, "--data", &other, "-o", "x.csv"]);
        assert!(done.code == 1 && done.stderr.contains(told), "{}: {}", done.code, done.stderr);
    }
}
