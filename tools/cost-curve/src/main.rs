//! Shows what accuracy costs in time: a scene over a grid of settings, errors, a plot, a recommended setting.

mod args;
mod grid;
mod judge;
mod knob;
mod line;
mod observe;
mod plot;
mod sweep;
mod table;
mod work;

use anyhow::Context;
use args::Args;
use cli::{Output, OutputStream, Report};
use judge::Judged;
use line::{Job, quoted};
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run("cost-curve", cost_curve)
}

fn cost_curve(args: Args) -> anyhow::Result<Report> {
    let measure = observe::Measure::parse(&args.measure)?;
    let counter = work::counter(args.work)?;
    args.check()?;
    let sweep = sweep::Sweep::new(&args)?;
    let open = work::scripts(&args, &sweep, counter)?;
    let (runs, kept) = (sweep.jobs.len(), sweep.jobs.len() - open.len());
    if args.print_commands {
        return print_commands(&open, runs);
    }
    work::run(&args, &open)?;
    let judged = judge::judge(&args, &sweep, &measure, counter)?;
    write(Path::new("-"), table::csv(&judged).as_bytes())?;
    if let Some(file) = &args.plot {
        let title = format!("{}: what accuracy costs", args.scene);
        write(file, &plot::draw(file, &judged, &title)?)?;
    }
    let words = judged.words();
    if let Some(file) = &args.words {
        let bold = |line: &String| match Some(line) == judged.advice().as_ref() {
            true => format!("- **{line}**\n"),
            false => format!("- {line}\n"),
        };
        let list: String = words.iter().map(bold).collect();
        write(file, list.as_bytes())?;
    }
    if !cli::quiet() {
        words.iter().for_each(|line| eprintln!("{line}"));
    }
    Ok(report(&judged, &words, runs, kept))
}

fn write(file: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let mut out: OutputStream = Output { file: Some(file.to_owned()) }.open_text()?;
    out.write_all(bytes).with_context(|| format!("{}: cannot write", file.display()))?;
    out.commit()
}

fn print_commands(open: &[&Job], runs: usize) -> anyhow::Result<Report> {
    let line = |job: &&Job| {
        let script = job.file("run.sh");
        let script = quoted(&std::path::absolute(&script).unwrap_or(script).display().to_string());
        format!("bash {script}  # {}\n", job.dem_run())
    };
    write(Path::new("-"), open.iter().map(line).collect::<String>().as_bytes())?;
    let done = runs - open.len();
    Ok(Report::new(format!("{} runs to make, {done} are finished; nothing was run", open.len())))
}

fn report(judged: &Judged, words: &[String], runs: usize, kept: usize) -> Report {
    let failed = judged.points.iter().filter(|p| p.failed.is_some()).count();
    let summary = format!(
        "{} points, {runs} runs, {kept} of them made before, {failed} points failed",
        judged.points.len()
    );
    let setting = |k: usize| {
        judged.points[k].setting.iter().cloned().collect::<std::collections::BTreeMap<String, String>>()
    };
    let recommended = match judged.choice {
        Some(curve::Choice::Point(k)) => Some(setting(k)),
        _ => None,
    };
    Report::new(summary)
        .with("points", judged.points.len())
        .with("runs", runs)
        .with("kept", kept)
        .with("failed", failed)
        .with("reference", judged.marks.0.map(setting))
        .with("in_use", judged.marks.1.map(setting))
        .with("recommended", recommended)
        .with("words", words)
}
