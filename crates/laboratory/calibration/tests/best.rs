//! The best point is one where a run is near the data, a run verifies it, and where nothing fits, the table says so first.

use calibration::session::{Session, Standing, Watch};
use calibration::{Judged, judge, recipe, words};
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

struct Silent;

impl Watch for Silent {
    fn tell(&self, _: &str) {}
    fn warn(&self, _: &str) {}
    fn progress(&self, _: usize, _: usize, _: &str) {}
}

/// What a calibration finds, and its page.
fn judged(folder: &Path, toml: &str, seed: u64, verify: bool) -> (Judged, String) {
    let file = folder.join("r.toml");
    fs::write(&file, toml).unwrap();
    let _ = fs::remove_dir_all(folder.join("t"));
    let mut recipe = recipe::read(&file, &Vec::new()).unwrap();
    recipe.settings.seed = seed;
    let (dir, watch) = (folder.join("t"), &Silent);
    let session = Session {
        recipe: &recipe,
        dir,
        jobs: 2,
        stop: || false,
        watch,
        list: false,
        candidates: false,
        verify,
    };
    let Standing::Done { tried, steps } = session.run().unwrap() else { panic!("nothing is listed") };
    let judged = judge(&recipe, &tried, &steps);
    let page = calibration::html(&recipe, &judged, "<svg></svg>");
    (judged, page)
}

/// A stress that rises early and falls; specimens scatter by a tenth.
const MODEL: &str = "BEGIN { srand(seed); for (k = 0; k < 9; k++) rand()
  s = 1300 * (1 - exp(-2 * sliding)) * (1 - exp(-3 * rolling)) + 200; print \"e,q\"
  for (k = 0; k <= 40; k++) { e = k / 200; print e \",\" s * (1 - exp(-e / 0.02)) * exp(-2 * e) * (1 + 0.1 * (rand() + rand() - 1)) } }";

/// Two parameters, few trials, and a curve of another shape, which none of them reproduces.
fn far_from_the_data(folder: &Path) -> String {
    fs::write(folder.join("model.awk"), MODEL).unwrap();
    let row = |k: i32| {
        let e = f64::from(k) / 200.0;
        format!("{e},{}\n", if k < 32 { 9000.0 * e } else { 350.0 })
    };
    let rows: String = (1..=40).map(row).collect();
    fs::write(folder.join("measured.csv"), format!("e,q\n{rows}")).unwrap();
    "[settings]\ntrials = 11\nfirst = 11\n\
     [[parameter]]\nname = \"sliding\"\nbounds = [0.2, 1.2]\n[[parameter]]\nname = \"rolling\"\nbounds = [0.05, 1.5]\nscale = \"log\"\n\
     [[test]]\nname = \"q\"\ncommand = \"awk -v sliding={sliding} -v rolling={rolling} -v seed={seed} -f {here}/model.awk\"\n\
     x = \"e\"\ny = \"q\"\ndata = \"measured.csv\"\ndeviation = \"5 %\"\n"
        .to_owned()
}

/// Root mean square of the distance from the data, of a specimen that no trial had.
fn distance(folder: &Path, sliding: f64, rolling: f64) -> f64 {
    let values = [format!("sliding={sliding}"), format!("rolling={rolling}"), "seed=999".to_owned()];
    let options = values.iter().flat_map(|v| ["-v", v]);
    let out = Command::new("awk").args(options).arg("-f").arg(folder.join("model.awk")).output().unwrap();
    let points = |text: &str| -> Vec<f64> {
        text.lines().skip(1).map(|l| l.split(',').nth(1).unwrap().parse().unwrap()).collect()
    };
    let run = points(&String::from_utf8(out.stdout).unwrap());
    let data = points(&fs::read_to_string(folder.join("measured.csv")).unwrap());
    let squares = run[1..].iter().zip(&data).map(|(a, b)| (a - b) * (a - b));
    (squares.sum::<f64>() / data.len() as f64).sqrt()
}

/// An untried corner where the emulator is unsure is not the best point: a run of that is as near as the nearest trial.
#[test]
fn the_best_point_of_few_trials_is_near_the_data_and_not_where_nothing_is_known() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    let toml = far_from_the_data(path);
    for seed in [2, 1, 3, 4] {
        let (judged, _) = judged(path, &toml, seed, false);
        let best = distance(path, judged.findings[0].best, judged.findings[1].best);
        let log = fs::read_to_string(path.join("t/trials.csv")).unwrap();
        let trials = log.lines().skip(1).map(|line| {
            let cells: Vec<f64> = line.split(',').skip(6).take(2).map(|c| c.parse().unwrap()).collect();
            distance(path, cells[0], cells[1])
        });
        let nearest = trials.fold(f64::INFINITY, f64::min);
        assert!(best < 1.03 * nearest, "seed {seed}: {best} at {:?}, trials {nearest}", judged.findings);
    }
}

#[test]
fn where_nothing_fits_this_is_the_first_line_with_the_nearest_run() {
    let folder = TempDir::new().unwrap();
    let (judged, page) = judged(folder.path(), &far_from_the_data(folder.path()), 2, true);
    let fit = &judged.steps[0];
    assert!(!fit.fits && fit.simulated.is_some(), "{fit:?}");
    let headline = words::headline(&judged).unwrap();
    assert!(
        headline.starts_with(
            "nothing fits: of 11 trials and the best point, none reproduces the data; the nearest is "
        ),
        "{headline}"
    );
    assert!(headline.contains("(sliding = ") && headline.contains(": square of misfit "), "{headline}");
    let csv = words::csv(&judged);
    assert!(csv.lines().next().unwrap() == format!("# {headline}"), "{csv}");
    let first = page.find(&headline).unwrap();
    assert!(first < page.find("<table>").unwrap(), "it stands above the tables");
    // Every column of the table is explained on the page.
    let names = csv.lines().nth(1).unwrap().split(',');
    names.for_each(|name| assert!(page.contains(&format!("<code>{name}</code>")), "{name}"));
}

/// A number that waves with two parameters, of which eight trials tell little; many tell enough.
#[test]
fn too_few_trials_are_measured_and_give_no_advice_on_bounds() {
    let folder = TempDir::new().unwrap();
    let recipe = |trials: usize| {
        format!(
            "[settings]\ntrials = {trials}\nfirst = {trials}\n[[parameter]]\nname = \"a\"\nbounds = [0, 1]\n[[parameter]]\nname = \"b\"\nbounds = [0, 1]\n\
             [[test]]\nname = \"wave\"\nvalue = 2.2\ndeviation = 0.05\n\
             command = \"awk 'BEGIN {{ print sin(9 * {{a}}) + cos(7 * {{b}}) + {{a}} }}'\"\n"
        )
    };
    let (few, _) = judged(folder.path(), &recipe(8), 1, false);
    let fit = &few.steps[0];
    let warnings = words::warnings(&few).join("\n");
    assert!(fit.too_few() && fit.unseen > 0.3, "{fit:?}");
    assert!(
        warnings.contains("too few trials") && warnings.contains("8 trials for 2 parameters"),
        "{warnings}"
    );
    assert!(!warnings.contains("widen"), "what is unknown is no reason to widen bounds: {warnings}");
    let (many, _) = judged(folder.path(), &recipe(60), 1, false);
    let fit = &many.steps[0];
    assert!(!fit.too_few() && fit.unseen < 0.1 && fit.fits, "{fit:?}");
}

/// A line; with `more`, runs with seeds from 1000 on are shifted, which no trial shows.
fn line(more: &str) -> String {
    format!(
        "[settings]\ntrials = 24\nfirst = 12\nseed = 976\n[[parameter]]\nname = \"a\"\nbounds = [0, 4]\n[[parameter]]\nname = \"b\"\nbounds = [0, 4]\n\
         [[test]]\nname = \"line\"\nx = \"x\"\ny = \"y\"\ndata = \"lab.csv\"\ndeviation = 0.1\n\
         command = '''awk 'BEGIN {{ {more}; print \"x,y\"; for (k = 0; k <= 10; k++) print k \",\" {{a}} + k * {{b}} + shift }}' # {{seed}}'''\n"
    )
}

#[test]
fn a_run_shows_what_the_emulator_promises_of_the_best_point() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    let rows: String = (0..=10).map(|k| format!("{k},{}\n", 3.0 + 2.0 * f64::from(k))).collect();
    fs::write(path.join("lab.csv"), format!("x,y\n{rows}")).unwrap();
    let (kept, _) = judged(path, &line("shift = 0"), 976, true);
    let fit = &kept.steps[0];
    assert!(
        fit.fits && !fit.surprise && fit.best_is_trial.is_none() && words::headline(&kept).is_none(),
        "{fit:?}"
    );
    assert!((fit.simulated.unwrap() - fit.misfit).abs() < 1.0, "{fit:?}");
    assert!(path.join("t/best/1/trial.json").exists());
    assert!((kept.findings[0].best - 3.0).abs() < 0.05 && (kept.findings[1].best - 2.0).abs() < 0.02);
    // Without the run it stays a promise.
    let (promised, _) = judged(path, &line("shift = 0"), 976, false);
    assert!(promised.steps[0].simulated.is_none() && promised.steps[0].fits && !path.join("t/best").exists());
    assert_eq!(promised.findings[0].best, kept.findings[0].best);
    assert!(words::sentences(&promised).iter().any(|l| l.contains("predicted, not simulated")));
    // A run that is not what was promised: this is said, and the nearest trial stands as best.
    let (broken, _) = judged(path, &line("shift = ({seed} >= 1000) * 2"), 976, true);
    let fit = &broken.steps[0];
    assert!(fit.surprise && fit.simulated.unwrap() > 100.0 + fit.misfit, "{fit:?}");
    let number = fit.best_is_trial.expect("a trial stands as best");
    assert_eq!(fit.nearest.as_ref().unwrap().trial, Some(number));
    let warnings = words::warnings(&broken).join("\n");
    assert!(
        warnings.contains("the best point is not what the emulator says")
            && warnings.contains(&format!("trial {number} is nearer")),
        "{warnings}"
    );
    // One that fails: likewise.
    let (failed, _) = judged(path, &line("shift = 0; if ({seed} >= 1000) exit 1"), 976, true);
    assert!(
        failed.steps[0].best_is_trial.is_some() && failed.steps[0].no_result.is_some(),
        "{:?}",
        failed.steps
    );
    assert!(words::warnings(&failed).join("\n").contains("the best point has no result: exit code 1"));
}
