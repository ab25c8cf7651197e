//! Makes the points that are not finished, and reads their results.

use super::script::{BUSY, Counter, NOW, SweepRun};
use crate::study::{CurveError, Work};
use record::StopCause;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst};

/// The result of a run.
#[derive(Debug, Clone)]
pub enum Made {
    /// It came to its end.
    Done {
        /// In the unit that was asked for, for each simulated second.
        work: f64,
        /// Wall time for each simulated second [s/s].
        seconds: f64,
        /// Steps for each simulated second [1/s].
        steps: f64,
        /// Wall time of the line that made its input [s]; 0 without one.
        prepared: f64,
    },
    /// It was refused or stopped by a guard: the message.
    Failed(String),
}

/// The stamp and exit code that a run has left.
fn left(job: &SweepRun) -> Option<(String, String)> {
    let text = std::fs::read_to_string(job.file("made")).ok()?;
    let (stamp, code) = text.trim().split_once(' ')?;
    Some((stamp.to_owned(), code.to_owned()))
}

/// Whether a run would come to the same end again: done, or stopped by a guard.
fn finished(job: &SweepRun) -> bool {
    let by_signal = || report(job).is_ok_and(|r| record::ReportedStop::is_by_signal(&r));
    left(job).is_some_and(|(stamp, code)| stamp == job.stamp && (code == "0" || code == "3" && !by_signal()))
        && !has_read_others(job)
}

/// Whether a file that a run has read is another one now.
fn has_read_others(job: &SweepRun) -> bool {
    !stream::reads::changed(&job.file(stream::reads::RECORD), None).is_empty()
}

fn report(job: &SweepRun) -> Result<Value, CurveError> {
    let file = job.file("report.json");
    let text = read_file(&file, &format!("{}: cannot read it", file.display()))?;
    serde_json::from_str(&text)
        .map_err(|e| CurveError::Failed(format!("{}: is not a report: {e}", file.display())))
}

fn read_file(file: &Path, what: &str) -> Result<String, CurveError> {
    std::fs::read_to_string(file).map_err(CurveError::io(what))
}

/// The program that counts instructions on this machine; `None` when they are not asked for.
///
/// # Errors
/// There is none.
pub fn counter(work: Work) -> Result<Option<Counter>, CurveError> {
    if work != Work::Instructions {
        return Ok(None);
    }
    let works = |program: &str, words: &[&str]| {
        let mut command = Command::new(program);
        command.args(words).stdout(Stdio::null()).stderr(Stdio::null());
        command.status().is_ok_and(|s| s.success())
    };
    // To stderr: the name of a file that others can guess may be theirs.
    let perf = Command::new("perf").args(["stat", "-x,", "-e", "instructions:u", "--", "true"]).output();
    let counts = perf.is_ok_and(|done| {
        done.status.success() && Counter::Perf.read(&String::from_utf8_lossy(&done.stderr)).is_some()
    });
    match (counts, works("valgrind", &["--version"])) {
        (true, _) => Ok(Some(Counter::Perf)),
        (_, true) => Ok(Some(Counter::Valgrind)),
        _ => Err(CurveError::Usage(
            "--work instructions: neither perf nor valgrind counts them here: install one, or use --work steps"
                .to_owned(),
        )),
    }
}

/// Runs that are not finished, and how many were made from another scene, input or program.
pub struct Open<'a> {
    pub jobs: Vec<&'a SweepRun>,
    /// Runs that are made again.
    pub outdated: usize,
    /// A program of the line before runs that are used again, which may read files that the line does not name.
    pub unknown: Option<String>,
}

/// Writes the script of every run that is not finished; `tools` is the folder of the programs.
///
/// # Errors
/// A folder that cannot be written to.
pub fn scripts<'a>(
    jobs: &'a [SweepRun],
    tools: &Path,
    work: Work,
    counter: Option<Counter>,
) -> Result<Open<'a>, CurveError> {
    let here = std::env::current_dir().map_err(CurveError::io("the current folder"))?;
    let is_other =
        |job: &&SweepRun| left(job).is_some_and(|(stamp, _)| stamp != job.stamp) || has_read_others(job);
    let outdated = jobs.iter().filter(is_other).count();
    let open: Vec<&SweepRun> = jobs.iter().filter(|job| !finished(job) || uncounted(job, work)).collect();
    for job in &open {
        let write = || {
            std::fs::create_dir_all(&job.folder)?;
            if job.file("made").exists() && has_read_others(job) {
                // Its stamp is the same: without this file the script makes it again.
                std::fs::remove_file(job.file("made"))?;
            }
            // Whole at once: another process may be running it.
            let new = job.file(&format!("run.sh.{}", std::process::id()));
            std::fs::write(&new, job.script(tools, &here, work, counter))?;
            std::fs::rename(&new, job.file("run.sh"))
        };
        let what = format!("{}: cannot write there: choose another --dir", job.folder.display());
        write().map_err(CurveError::io(what))?;
    }
    let known = |program: &str| tools.join(program).is_file();
    let used = jobs.iter().filter(|job| finished(job));
    let unknown = used.filter_map(|job| stream::reads_more(job.each.as_ref()?, known)).next();
    Ok(Open { jobs: open, outdated, unknown })
}

/// Whether instructions are asked for that were not counted.
fn uncounted(job: &SweepRun, work: Work) -> bool {
    work == Work::Instructions && !job.file("instructions").exists()
}

/// Runs the scripts, so many at a time; `begins` and `ends` are called with each run.
///
/// # Errors
/// A signal, a script that cannot be started.
pub fn run(
    jobs: &[&SweepRun],
    at_once: usize,
    stop: fn() -> bool,
    begins: &(dyn Fn(&SweepRun) + Sync),
    ends: &(dyn Fn() + Sync),
) -> Result<(), CurveError> {
    let (next, trouble) = (AtomicUsize::new(0), Mutex::new(None));
    let busy: Vec<AtomicBool> = jobs.iter().map(|_| AtomicBool::new(false)).collect();
    let ended = AtomicBool::new(false);
    let one = || {
        // First those that no other process makes; then the others are waited for.
        loop {
            let turn = next.fetch_add(1, SeqCst);
            let (now, at) = (turn < jobs.len(), turn % jobs.len().max(1));
            let Some(job) = jobs.get(at).filter(|_| turn < 2 * jobs.len() && !stop() && !ended.load(SeqCst))
            else {
                break;
            };
            if !now && !busy[at].load(SeqCst) {
                continue;
            }
            if now {
                begins(job);
            }
            let mut script = Command::new("bash");
            script.arg(job.file("run.sh")).args(now.then_some(NOW)).stdin(Stdio::null());
            match script.status() {
                Ok(status) if now && status.code() == Some(BUSY) => {
                    busy[at].store(true, SeqCst);
                    continue;
                }
                // A signal to all of them may end a run before it is noticed here.
                Ok(status) if StopCause::of_exit(status).is_some() => {
                    ended.store(true, SeqCst);
                }
                Ok(_) => {}
                Err(why) => {
                    if let Ok(mut trouble) = trouble.lock() {
                        *trouble = Some(CurveError::io("bash: cannot be started: install it")(why));
                    }
                }
            }
            ends();
        }
    };
    std::thread::scope(|threads| {
        for _ in 1..at_once {
            // Where there is no memory for a thread, fewer do.
            let _ = std::thread::Builder::new().spawn_scoped(threads, one);
        }
        one();
    });
    if let Ok(Some(trouble)) = trouble.into_inner() {
        return Err(trouble);
    }
    if stop() || ended.load(SeqCst) {
        let (done, all) = (jobs.iter().filter(|job| finished(job)).count(), jobs.len());
        let why =
            format!("stopped by a signal: {done} of {all} runs are finished: the same command continues");
        return Err(CurveError::Signal(why));
    }
    Ok(())
}

/// The result of a run.
///
/// # Errors
/// A run that left nothing, or that a signal ended.
pub fn read(job: &SweepRun, work: Work, counter: Option<Counter>) -> Result<Made, CurveError> {
    let words = std::fs::read_to_string(job.file("words")).unwrap_or_default();
    let lost =
        || CurveError::Failed(format!("{}: the run ended without a message: {words}", job.folder.display()));
    let (_, code) = left(job).filter(|(stamp, _)| *stamp == job.stamp).ok_or_else(lost)?;
    if code != "0" {
        let line = words.lines().rev().find(|l| !l.trim().is_empty()).unwrap_or("it gave no reason");
        return Ok(Made::Failed(if code == "each" { format!("--each: {line}") } else { line.to_owned() }));
    }
    let report = report(job)?;
    let number = |key: &str| {
        let why = || format!("{}: has no '{key}'", job.file("report.json").display());
        report[key].as_f64().ok_or_else(|| CurveError::Failed(why()))
    };
    let time = number("time")?;
    let (seconds, steps) = (number("seconds")? / time, number("steps")? / time);
    let work = match (work, counter) {
        (Work::Cpu, _) => cpu(job)? / time,
        (Work::Steps, _) => steps,
        (Work::Instructions, Some(counter)) => {
            let file = job.file("instructions");
            let text = read_file(&file, &file.display().to_string())?;
            let why = || CurveError::Failed(format!("{}: holds no count", file.display()));
            counter.read(&text).ok_or_else(why)? / time
        }
        _ => seconds,
    };
    Ok(Made::Done { work, seconds, steps, prepared: prepared(job) })
}

/// What the runs have warned of, and how many of them did: each text once, in the order of the runs.
pub fn warnings(jobs: &[SweepRun]) -> Vec<(String, usize)> {
    let mut all: Vec<(String, usize)> = Vec::new();
    for report in jobs.iter().filter_map(|job| report(job).ok()) {
        for text in report["warnings"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            match all.iter_mut().find(|known| known.0 == text) {
                Some(known) => known.1 += 1,
                None => all.push((text.to_owned(), 1)),
            }
        }
    }
    all
}

/// Processor time of the run [s]: of the program, and of the system for it.
fn cpu(job: &SweepRun) -> Result<f64, CurveError> {
    let file = job.file("cpu");
    let text = read_file(&file, &file.display().to_string())?;
    let parts: Option<Vec<f64>> =
        text.split_whitespace().map(|part| part.replace(',', ".").parse().ok()).collect();
    let why = || CurveError::Failed(format!("{}: holds no times: {text}", file.display()));
    parts.map(|parts| parts.iter().sum()).ok_or_else(why)
}

/// Wall time of the line that made the input [s].
fn prepared(job: &SweepRun) -> f64 {
    let time = |name: &str| -> Option<f64> {
        std::fs::read_to_string(job.file(name)).ok()?.trim().replace(',', ".").parse().ok()
    };
    let span = time("begun").zip(time("prepared")).map(|(begun, done)| done - begun);
    span.filter(|_| job.each.is_some()).unwrap_or(0.0)
}
