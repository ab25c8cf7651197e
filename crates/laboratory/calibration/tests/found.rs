//! Known parameters are found again, and what the data cannot tell is named.

use calibration::session::{Session, Standing, Watch};
use calibration::{CalibrateError, Judged, judge, next_tests, recipe};
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

struct Nobody;

impl Watch for Nobody {
    fn tell(&self, _: &str) {}
    fn warn(&self, _: &str) {}
    fn progress(&self, _: usize, _: usize, _: &str) {}
}

/// The judgement of a recipe, and what each test would tell next.
fn found(
    folder: &Path,
    toml: &str,
    data: &[&str],
) -> Result<(Judged, Vec<calibration::Next>), CalibrateError> {
    judged(folder, toml, data, true)
}

/// The same; `candidates`: all tests are run in the last step.
fn judged(
    folder: &Path,
    toml: &str,
    data: &[&str],
    candidates: bool,
) -> Result<(Judged, Vec<calibration::Next>), CalibrateError> {
    let file = folder.join("r.toml");
    fs::write(&file, toml).unwrap();
    let data = data.iter().map(|d| (*d).to_owned()).collect();
    let recipe = recipe::read(&file, &data)?;
    let dir = folder.join("trials");
    let session = Session {
        recipe: &recipe,
        dir,
        jobs: 2,
        stop: || false,
        watch: &Nobody,
        list: false,
        candidates,
        verify: false,
    };
    match session.run()? {
        Standing::Open(_) => panic!("nothing is listed"),
        Standing::Done { tried, steps } => {
            let next = next_tests(&recipe, steps.last().unwrap(), &tried);
            Ok((judge(&recipe, &tried, &steps), next))
        }
    }
}

/// Stress over displacement: y = a (1 − exp(−b u)) + c u, with noise of 0.5; a guard stops steep ones.
const MODEL: &str = "awk -v a={a} -v b={b} -v c={c} -v n={nothing} -v seed={seed} 'BEGIN {
  if (b > 8) { print \"overlap\" > \"/dev/stderr\"; exit 3 }
  srand(seed); for (k = 0; k < 9; k++) rand()
  print \"u,tau\"; for (k = 0; k <= 50; k++) { u = k / 10; print u \",\" a * (1 - exp(-b * u)) + c * u + (rand() + rand() - 1) } }'";

fn curve_recipe(settings: &str) -> String {
    let parameter =
        |name: &str, bounds: &str| format!("[[parameter]]\nname = \"{name}\"\nbounds = {bounds}\n");
    [
        format!("[settings]\n{settings}\n"),
        parameter("a", "[10, 100]"),
        parameter("b", "[0.3, 10]"),
        parameter("c", "[0, 10]"),
        parameter("nothing", "[0, 1]"),
        format!("[[test]]\nname = \"shear\"\ncommand = '''{MODEL}'''\nx = \"u\"\ny = \"tau\"\n"),
    ]
    .concat()
}

/// A measured curve: the model at a = 42, b = 1.7, c = 3.
fn laboratory(folder: &Path) -> String {
    let command = MODEL.replace("{a}", "42").replace("{b}", "1.7").replace("{c}", "3");
    let command = command.replace("{nothing}", "0").replace("{seed}", "12345");
    let out = Command::new("bash").args(["-c", &command]).output().unwrap();
    let file = folder.join("lab.csv");
    fs::write(&file, out.stdout).unwrap();
    file.display().to_string()
}

#[test]
fn known_parameters_are_found_and_one_without_influence_is_named() {
    let folder = TempDir::new().unwrap();
    let data = laboratory(folder.path());
    let (judged, _) = found(folder.path(), &curve_recipe("trials = 64\nfirst = 40"), &[&data]).unwrap();
    for (f, truth) in judged.findings.iter().zip([42.0, 1.7, 3.0]) {
        assert!((f.value / truth - 1.0).abs() < 0.05 && f.determined, "{f:?}");
        assert!(f.width < 0.2 && f.low < truth && truth < f.high, "{f:?}");
    }
    let nothing = &judged.findings[3];
    assert!(!nothing.determined && nothing.width > 0.85 && nothing.influence < 0.01, "{nothing:?}");
    assert!(
        judged.trials[1] > 0 && judged.trials[2] == 0,
        "stopped trials count, and none failed: {:?}",
        judged.trials
    );
    assert!(
        calibration::words::sentences(&judged)
            .iter()
            .any(|l| l.starts_with("nothing: the data do not determine it"))
    );
    // The log has each trial, and each run its provenance.
    let log = fs::read_to_string(folder.path().join("trials/trials.csv")).unwrap();
    assert!(
        log.lines().count() == 1 + judged.trials.iter().sum::<usize>() && log.contains("stopped"),
        "{log}"
    );
    let run = folder.path().join("trials/trials/0001/shear-0/result.json");
    assert!(fs::read_to_string(run).unwrap().contains("\"stamp\""));
}

#[test]
fn parameters_that_trade_off_are_named_and_a_telling_test_is_proposed() {
    let folder = TempDir::new().unwrap();
    let toml = "[settings]\ntrials = 40\nfirst = 20\n\
        [[parameter]]\nname = \"sliding\"\nbounds = [0.1, 1]\n[[parameter]]\nname = \"rolling\"\nbounds = [0.1, 1]\n\
        [[test]]\nname = \"heap\"\ncommand = \"awk 'BEGIN { print 20 + 20 * {sliding} * {rolling} }'\"\nvalue = 26\ndeviation = 0.3\n\
        [[test]]\nname = \"useless\"\ncommand = \"echo 3\"\ndeviation = 0.1\n\
        [[test]]\nname = \"discharge\"\ncommand = \"awk 'BEGIN { print 5 - 2 * {sliding} }'\"\ndeviation = \"2 %\"\n";
    let (judged, next) = found(folder.path(), toml, &[]).unwrap();
    let pair = judged.pairs.first().expect("a pair");
    assert_eq!(pair.parameters, ["sliding", "rolling"]);
    assert!(pair.correlation < -0.9, "{pair:?}");
    // Along the line, sliding × rolling stays 0.3.
    assert!(pair.ends.iter().all(|e| (e[0] * e[1] - 0.3).abs() < 0.05), "{pair:?}");
    assert_eq!(next[0].test, "discharge");
    assert!(next[0].ratios[0] < 0.3 && next.last().unwrap().gain < 0.01, "{next:?}");
}

#[test]
fn steps_fit_parts_of_a_curve_and_hold_what_was_found() {
    let folder = TempDir::new().unwrap();
    let data = laboratory(folder.path());
    // Late points give a and c, early points then b.
    let steps = "[[step]]\nname = \"late\"\nfit = [\"a\", \"c\"]\nto = [{ test = \"shear\", from = 3 }]\ntrials = 24\nfirst = 16\n\
        [[step]]\nname = \"early\"\nfit = \"b\"\nto = [{ test = \"shear\", until = 1 }]\ntrials = 16\nfirst = 10\n";
    let toml = curve_recipe("")
        .replace("{nothing}", "0")
        .replace("[[parameter]]\nname = \"nothing\"\nbounds = [0, 1]\n", "");
    let (judged, _) = found(folder.path(), &(toml + steps), &[&data]).unwrap();
    for (f, truth) in judged.findings.iter().zip([42.0, 1.7, 3.0]) {
        assert!((f.value / truth - 1.0).abs() < 0.1, "{f:?}");
    }
    assert_eq!(
        judged.findings.iter().map(|f| f.step.as_str()).collect::<Vec<_>>(),
        ["late", "early", "late"]
    );
}

#[test]
fn other_units_and_failing_commands_are_errors_with_a_cure() {
    let folder = TempDir::new().unwrap();
    let data = laboratory(folder.path());
    let toml = curve_recipe("trials = 40");
    let why = |toml: &str, data: &[&str]| {
        let _ = fs::remove_dir_all(folder.path().join("trials"));
        found(folder.path(), toml, data).unwrap_err().to_string()
    };
    let text = fs::read_to_string(&data).unwrap();
    let wrong = folder.path().join("kpa.csv");
    fs::write(&wrong, text.replacen("u,tau", "u,tau [kPa]", 1)).unwrap();
    let message = why(&toml, &[wrong.to_str().unwrap()]);
    assert!(message.contains("times as large as the data: are the units the same?"), "{message}");
    let message = why(&toml.replace("awk", "awkk"), &[&data]);
    assert!(
        message.contains("the first 3 runs have all failed") && message.contains("command.sh"),
        "{message}"
    );
    let message = why(&toml.replace("k <= 50", "k <= 20"), &[&data]);
    assert!(message.contains("its curve reaches from x = 0 to 2, the data have x = "), "{message}");
    let message = why(&toml.replace("b > 8", "b > 0"), &[&data]);
    assert!(message.contains("stopped by a guard") && message.contains("overlap"), "{message}");
}

#[test]
fn what_a_guard_stops_is_outside_of_the_posterior() {
    let folder = TempDir::new().unwrap();
    let toml = "[settings]\ntrials = 24\nfirst = 16\n[[parameter]]\nname = \"b\"\nbounds = [0, 10]\n\
        [[test]]\nname = \"t\"\ncommand = \"awk 'BEGIN { if ({b} > 5) exit 3; print {b} }'\"\nvalue = 5\ndeviation = 2\n";
    let (judged, _) = found(folder.path(), toml, &[]).unwrap();
    // Without the guard, half of the posterior would lie above 5, and its interval would reach to 8.
    let f = &judged.findings[0];
    assert!(f.high < 6.5 && f.value < 4.7 && judged.trials[1] > 0, "{f:?} {:?}", judged.trials);
}

/// A line y = a + b x that a guard cannot stop; small specimens are weaker (`bias` over their size), and scatter more. Each run is logged.
fn specimens(bias: f64, refines: &str) -> String {
    let command = format!(
        "echo {{size}} >> {{here}}/log; awk -v seed={{seed}} 'BEGIN {{ srand(seed); rand(); print \"x,y\"; for (k = 0; k <= 10; k++) print k \",\" \
         {{a}} + k * {{b}} - {bias} / {{size}} + 4 * (rand() - 0.5) / {{size}} }}'"
    );
    let parameter = |name: &str| format!("[[parameter]]\nname = \"{name}\"\nbounds = [0, 10]\n");
    let test = |name: &str, more: &str| {
        format!(
            "[[test]]\nname = \"{name}\"\ncommand = '''{command}{more}'''\nx = \"x\"\ny = \"y\"\ndata = \"lab.csv\"\ndeviation = 0.3\n"
        )
    };
    let step = |name: &str, size: u32, more: &str| {
        format!(
            "[[step]]\nname = \"{name}\"\nfit = \"all\"\nto = [\"line\"]\nwith = {{ size = {size} }}\ntrials = 24\nfirst = 12\n{more}"
        )
    };
    let steps = step("small", 4, "") + &step("large", 40, refines);
    [parameter("a"), parameter("b"), test("line", ""), test("other", " # another"), steps].concat()
}

#[test]
fn large_specimens_refine_small_ones_and_a_step_runs_its_own_tests() {
    let folder = TempDir::new().unwrap();
    let rows: String = (0..=10).map(|k| format!("{k},{}\n", 3.0 + 2.0 * f64::from(k))).collect();
    fs::write(folder.path().join("lab.csv"), format!("x,y\n{rows}")).unwrap();
    let run = |toml: &str| {
        let _ = fs::remove_dir_all(folder.path().join("trials"));
        judged(folder.path(), toml, &[], false).unwrap().0
    };
    let judged = run(&specimens(0.5, "refines = \"small\"\n"));
    for (f, truth) in judged.findings.iter().zip([3.0, 2.0]) {
        assert!((f.value - truth).abs() < 0.1 * truth && f.low < truth && truth < f.high, "{f:?}");
        assert!(f.step == "large", "{f:?}");
    }
    // The log has one line for each trial: the test that no step fits to is not run.
    let log = fs::read_to_string(folder.path().join("log")).unwrap();
    let runs = |size: &str| log.lines().filter(|l| *l == size).count();
    assert_eq!(runs("4") + runs("40"), judged.trials.iter().sum::<usize>(), "{log}");
    let trials = fs::read_to_string(folder.path().join("trials/trials.csv")).unwrap();
    // The range of all but each fourth trial at the ends: those that lie anywhere.
    let spread = |step: &str, column: usize, anywhere: usize| {
        let of = trials.lines().filter(|l| l.split(',').nth(1) == Some(step));
        let mut values: Vec<f64> = of.map(|l| l.split(',').nth(column).unwrap().parse().unwrap()).collect();
        values.sort_by(f64::total_cmp);
        let ends = anywhere * values.len() / 4;
        (0..=ends).map(|low| values[values.len() - 1 - ends + low] - values[low]).fold(f64::MAX, f64::min)
    };
    assert!(spread("small", 7, 0) > 8.0 && spread("large", 7, 1) < 3.0, "{trials}");
    // Small specimens that mislead: a is 3 + 20/4 there, which the large ones correct.
    let judged = run(&specimens(20.0, "refines = \"small\"\n"));
    for (f, truth) in judged.findings.iter().zip([3.5, 2.0]) {
        assert!((f.value - truth).abs() < 0.1 * truth && f.low < truth && truth < f.high, "{f:?}");
    }
    // Small specimens that all give the same.
    let all = "{a} + k * {b} - 0.5 / {size} + 4 * (rand() - 0.5) / {size}";
    let same = specimens(0.5, "refines = \"small\"\n")
        .replace(all, "({size} < 9 ? 1 : {a} + k * {b} + 0.1 * (rand() - 0.5))");
    let judged = run(&format!("[settings]\nabandon = 0\n{same}"));
    for (f, truth) in judged.findings.iter().zip([3.0, 2.0]) {
        assert!((f.value - truth).abs() < 0.1 * truth && f.low < truth && truth < f.high, "{f:?}");
    }
    // Large specimens that tell nothing of b: what small ones tell of it is no finding of the second step.
    let flat = specimens(0.5, "refines = \"small\"\n").replace("k * {b}", "k * ({size} < 9 ? {b} : 2)");
    let judged = run(&flat);
    assert!(judged.findings[0].determined && !judged.findings[1].determined, "{judged:?}");
}
