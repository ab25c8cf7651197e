//! A trial is made again when a file that it reads has changed, and not otherwise.

use calibration::session::{Session, Standing, Watch};
use calibration::{judge, recipe};
use std::fs;
use std::path::Path;
use std::sync::Mutex;

/// Keeps warnings.
#[derive(Default)]
struct Heard(Mutex<Vec<String>>);

impl Watch for Heard {
    fn tell(&self, _: &str) {}
    fn warn(&self, words: &str) {
        self.0.lock().unwrap().push(words.to_owned());
    }
    fn progress(&self, _: usize, _: usize, _: &str) {}
}

/// A recipe whose command finds factor × slope; each run adds a letter to `count` of the recipe's folder, which no word of the line names.
fn recipe_of(command: &str) -> String {
    format!(
        "[settings]\ntrials = 6\nfirst = 4\nbatch = 2\n[[parameter]]\nname = \"slope\"\nbounds = [1, 3]\n[[test]]\nname = \"t\"\n\
         command = '''{command}'''\nvalue = 4\ndeviation = 0.1\n"
    )
}

/// The best slope, how many runs were made, and warnings.
fn calibrated(folder: &Path) -> (f64, usize, Vec<String>) {
    let (heard, count) = (Heard::default(), folder.join("count"));
    let _ = fs::remove_file(&count);
    let recipe = recipe::read(&folder.join("r.toml"), &Vec::new()).unwrap();
    let (dir, watch) = (folder.join("trials"), &heard);
    let session = Session {
        recipe: &recipe,
        dir,
        jobs: 1,
        stop: || false,
        watch,
        list: false,
        candidates: false,
        verify: false,
    };
    let Standing::Done { tried, steps } = session.run().unwrap() else { panic!("nothing is listed") };
    let judged = judge(&recipe, &tried, &steps);
    let runs = fs::read_to_string(&count).unwrap_or_default().len();
    let mut warnings = heard.0.into_inner().unwrap();
    warnings.extend(calibration::words::warnings(&judged));
    (judged.findings[0].best, runs, warnings)
}

/// In a folder with a space and a quote, which the shell line has in quotes.
fn place(command: &str) -> tempfile::TempDir {
    let folder = tempfile::Builder::new().prefix("my plant's ").tempdir().unwrap();
    fs::write(folder.path().join("r.toml"), recipe_of(command)).unwrap();
    folder
}

#[test]
fn a_file_that_the_line_names_in_quotes_makes_trials_new() {
    let line = "(cd {here} && printf x >> count); f=$(cat {here}/factor.txt); awk -v f=$f -v s={slope} 'BEGIN { print f*s }'";
    let folder = place(line);
    let factor = folder.path().join("factor.txt");
    fs::write(&factor, "2").unwrap();
    let (best, runs, _) = calibrated(folder.path());
    assert!((best - 2.0).abs() < 0.2 && runs == 6, "{best} after {runs} runs");
    let (_, runs, warnings) = calibrated(folder.path());
    assert!(runs == 0 && warnings.iter().all(|w| !w.contains("again")), "{runs} runs, {warnings:?}");
    fs::write(&factor, "4").unwrap();
    let (best, runs, warnings) = calibrated(folder.path());
    assert!((best - 1.0).abs() < 0.2 && runs >= 4, "{best} after {runs} runs");
    assert!(warnings.iter().any(|w| w.contains("made again")), "{warnings:?}");
}

/// The program tells what it reads, as all of Grainpipe do: the line does not name the file.
#[test]
fn a_file_that_a_program_notes_makes_trials_new() {
    let line = "cd {here}; printf x >> count; f=$(cat factor.txt); \
                printf '{{\"path\":\"%s\",\"sha256\":\"%s\"}}\\n' \"$PWD/factor.txt\" $(sha256sum factor.txt | cut -c1-64) >> \"$GRAINPIPE_READS\"; \
                awk -v f=$f -v s={slope} 'BEGIN { print f*s }'";
    let folder = place(&line.replace("{{", "{").replace("}}", "}"));
    let factor = folder.path().join("factor.txt");
    for (text, best) in [("2", 2.0), ("4", 1.0)] {
        fs::write(&factor, text).unwrap();
        let (found, runs, _) = calibrated(folder.path());
        assert!((found - best).abs() < 0.2 && runs >= 4, "{found} after {runs} runs");
        assert_eq!(calibrated(folder.path()).1, 0, "nothing has changed");
    }
}

#[test]
fn what_cannot_be_known_is_said_where_trials_are_used_again() {
    let folder = place("(cd {here} && printf x >> count); perl -e 'print 2*$ARGV[0]' {slope}");
    let said = |warnings: &[String]| warnings.iter().any(|w| w.contains("'perl', which may read files"));
    let (_, runs, warnings) = calibrated(folder.path());
    assert!(runs == 6 && !said(&warnings), "{warnings:?}");
    let (_, runs, warnings) = calibrated(folder.path());
    assert!(runs == 0 && said(&warnings), "{runs} runs, {warnings:?}");
}

/// A line that measures what was stopped as if it had ended is said; one that a signal stopped is tried again.
#[test]
fn trials_on_stopped_runs_are_said() {
    let stop = "stopped by a guard at t = 1.95 s of 8 s: particle 7 overlaps";
    let note =
        format!("printf '%s\\n' '{{\"stopped\":\"{stop}\",\"signal\":false}}' >> \"$GRAINPIPE_READS\"");
    let folder = place(&format!("(cd {{here}} && printf x >> count); {note}; echo {{slope}}"));
    let (_, runs, warnings) = calibrated(folder.path());
    assert!(runs == 6 && warnings.iter().any(|w| w.contains(stop) && w.contains("6 trials")), "{warnings:?}");
}
