//! Makes the points that are not finished, one after another, and reads what became of them.

use crate::args::{Args, Work};
use crate::line::{Counter, Job};
use crate::sweep::Sweep;
use anyhow::{Context, anyhow, bail};
use cli::Progress;
use serde_json::Value;
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};
use std::time::SystemTime;

/// What became of a run.
#[derive(Debug, Clone)]
pub enum Made {
    /// It came to its end: its cost, and wall time, time for its input [s], steps for each simulated second.
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
    /// It was refused or stopped by a guard: what was said.
    Failed(String),
}

/// The stamp and exit code that a run has left.
fn left(job: &Job) -> Option<(String, String)> {
    let text = std::fs::read_to_string(job.file("made")).ok()?;
    let (stamp, code) = text.trim().split_once(' ')?;
    Some((stamp.to_owned(), code.to_owned()))
}

/// Whether a run came to an end that it would come to again: done, or stopped by a guard.
fn finished(job: &Job) -> bool {
    let by_signal = || report(job).is_ok_and(|r| r["stopped"].as_str() == Some(::run::SIGNAL));
    left(job).is_some_and(|(stamp, code)| stamp == job.stamp && (code == "0" || code == "3" && !by_signal()))
}

fn report(job: &Job) -> anyhow::Result<Value> {
    let file = job.file("report.json");
    let text =
        std::fs::read_to_string(&file).with_context(|| format!("{}: cannot read it", file.display()))?;
    serde_json::from_str(&text).with_context(|| format!("{}: is no report", file.display()))
}

/// What counts instructions here.
///
/// # Errors
/// Nothing does.
pub fn counter(work: Work) -> anyhow::Result<Option<Counter>> {
    if work != Work::Instructions {
        return Ok(None);
    }
    let works = |program: &str, words: &[&str]| {
        let mut command = Command::new(program);
        command.args(words).stdout(Stdio::null()).stderr(Stdio::null());
        command.status().is_ok_and(|s| s.success())
    };
    let file = std::env::temp_dir().join(format!("cost-curve.{}", std::process::id()));
    let out = file.display().to_string();
    let counts = works("perf", &["stat", "-x,", "-e", "instructions:u", "-o", &out, "--", "true"])
        && std::fs::read_to_string(&file).is_ok_and(|text| Counter::Perf.read(&text).is_some());
    let _ = std::fs::remove_file(&file);
    match (counts, works("valgrind", &["--version"])) {
        (true, _) => Ok(Some(Counter::Perf)),
        (_, true) => {
            cli::warn("--work instructions: perf cannot count here: valgrind does, 50 times slower");
            Ok(Some(Counter::Valgrind))
        }
        _ => Err(cli::usage(
            "--work instructions: neither perf nor valgrind counts them here: install one, or use --work steps",
        )),
    }
}

/// Writes the script of every run that is not finished; gives these runs.
///
/// # Errors
/// A folder that cannot be written to.
pub fn scripts<'a>(args: &Args, sweep: &'a Sweep, counter: Option<Counter>) -> anyhow::Result<Vec<&'a Job>> {
    let here = std::env::current_dir().context("the folder that this was started in")?;
    let old = sweep.jobs.iter().filter(|job| left(job).is_some_and(|(stamp, _)| stamp != job.stamp)).count();
    if old > 0 {
        cli::warn(&format!(
            "{}: {old} of {} runs there were made from another scene, input or program: they are made again",
            args.folder().display(),
            sweep.jobs.len()
        ));
    }
    let open: Vec<&Job> =
        sweep.jobs.iter().filter(|job| !finished(job) || uncounted(job, args.work)).collect();
    for job in &open {
        let write = || {
            std::fs::create_dir_all(&job.folder)?;
            std::fs::write(job.file("run.sh"), job.script(&sweep.tools, &here, args.work, counter))
        };
        write()
            .with_context(|| format!("{}: cannot write there: choose another --dir", job.folder.display()))?;
    }
    Ok(open)
}

/// Whether instructions are asked for that were not counted.
fn uncounted(job: &Job, work: Work) -> bool {
    work == Work::Instructions && !job.file("instructions").exists()
}

/// Runs the scripts.
///
/// # Errors
/// A signal, a script that cannot be started.
pub fn run(args: &Args, jobs: &[&Job]) -> anyhow::Result<()> {
    if args.jobs.get() > 1 && args.work == Work::Seconds && !jobs.is_empty() {
        cli::warn(&format!("--jobs {}: runs at the same time disturb each other's times", args.jobs));
    }
    cli::stop_in_order();
    let progress = Progress::new("runs", jobs.len() as u64);
    let (next, trouble) = (AtomicUsize::new(0), Mutex::new(None));
    let one = || {
        while let Some(job) = jobs.get(next.fetch_add(1, SeqCst)).filter(|_| !cli::stop_requested()) {
            progress.say(job.name.clone());
            let status = Command::new("bash").arg(job.file("run.sh")).stdin(Stdio::null()).status();
            if let (Err(why), Ok(mut trouble)) = (status, trouble.lock()) {
                *trouble = Some(anyhow::Error::new(why).context("bash: cannot be started: install it"));
            }
            progress.add(1);
        }
    };
    std::thread::scope(|threads| {
        for _ in 0..args.jobs.get() {
            threads.spawn(one);
        }
    });
    if let Ok(Some(trouble)) = trouble.into_inner() {
        return Err(trouble);
    }
    if cli::stop_requested() {
        let done = jobs.iter().filter(|job| finished(job)).count();
        bail!(
            "stopped by a signal: {done} of {} runs were made: the same line goes on from there",
            jobs.len()
        );
    }
    Ok(())
}

/// What became of a run.
///
/// # Errors
/// A run that left nothing, or that a signal ended.
pub fn read(job: &Job, work: Work, counter: Option<Counter>) -> anyhow::Result<Made> {
    let words = std::fs::read_to_string(job.file("words")).unwrap_or_default();
    let lost = || anyhow!("{}: its run ended without a word: {words}", job.folder.display());
    let (_, code) = left(job).filter(|(stamp, _)| *stamp == job.stamp).ok_or_else(lost)?;
    if code != "0" {
        let line = words.lines().rev().find(|l| !l.trim().is_empty()).unwrap_or("no word of why");
        return Ok(Made::Failed(if code == "each" { format!("--each: {line}") } else { line.to_owned() }));
    }
    let report = report(job)?;
    let number = |key: &str| {
        report[key].as_f64().ok_or_else(|| anyhow!("{}: has no '{key}'", job.file("report.json").display()))
    };
    let time = number("time")?;
    let (seconds, steps) = (number("seconds")? / time, number("steps")? / time);
    let work = match (work, counter) {
        (Work::Cpu, _) => cpu(job)? / time,
        (Work::Steps, _) => steps,
        (Work::Instructions, Some(counter)) => {
            let file = job.file("instructions");
            let text = std::fs::read_to_string(&file).with_context(|| file.display().to_string())?;
            counter.read(&text).ok_or_else(|| anyhow!("{}: holds no count", file.display()))? / time
        }
        _ => seconds,
    };
    Ok(Made::Done { work, seconds, steps, prepared: prepared(job) })
}

/// Processor time of the run [s]: of the program, and of the system for it.
fn cpu(job: &Job) -> anyhow::Result<f64> {
    let file = job.file("cpu");
    let text = std::fs::read_to_string(&file).with_context(|| file.display().to_string())?;
    let parts: Option<Vec<f64>> =
        text.split_whitespace().map(|part| part.replace(',', ".").parse().ok()).collect();
    parts.map(|parts| parts.iter().sum()).ok_or_else(|| anyhow!("{}: holds no times: {text}", file.display()))
}

/// Wall time of the line that made the input [s].
fn prepared(job: &Job) -> f64 {
    let time = |name: &str| std::fs::metadata(job.file(name)).and_then(|m| m.modified()).ok();
    let (begun, done): (Option<SystemTime>, _) = (time("begun"), time("prepared"));
    let span = begun.zip(done).and_then(|(begun, done)| done.duration_since(begun).ok());
    span.filter(|_| job.each.is_some()).map_or(0.0, |span| span.as_secs_f64())
}
