//! Shows what accuracy costs in time: a scene over a grid of settings, errors, a plot, a recommended setting.

mod args;
mod plot;
mod report;

use anyhow::Context;
use args::Args;
use cli::{Output, OutputStream, Progress, Report};
use curve::sweep::script::{Counter, SweepRun};
use curve::sweep::work::Open;
use curve::sweep::{Sweep, measure::Measure, work};
use curve::{CurveError, Judged, Study, Work, check_reference, csv, first_of_reference, judge};
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run("cost-curve", cost_curve)
}

fn cost_curve(args: Args) -> anyhow::Result<Report> {
    let measure = Measure::parse(&args.measure).map_err(refused)?;
    let study = args.study();
    let counter = work::counter(study.work).map_err(refused)?;
    if counter == Some(Counter::Valgrind) {
        cli::warn(
            "--work instructions: perf cannot count here: valgrind is used instead, which is 50 times slower",
        );
    }
    args.check()?;
    if args.norm.is_some() && measure.is_number() {
        return Err(cli::usage(format!("--norm: the {} of a run is one number: leave it out", measure.name)));
    }
    let sweep = lay_out(&study)?;
    let open = work::scripts(&sweep.jobs, &sweep.tools, study.work, counter).map_err(refused)?;
    let (runs, kept) = (sweep.jobs.len(), sweep.jobs.len() - open.jobs.len());
    if open.outdated > 0 {
        let (folder, old) = (study.folder.display(), open.outdated);
        cli::warn(&format!(
            "{folder}: {old} of {runs} runs there used another scene, input or program: they are run again"
        ));
    }
    if let Some(word) = &open.unknown {
        cli::warn(&format!(
            "{}: runs there are used again; --each has '{word}', which may read files that the line does not name: remove the folder where such a file has changed",
            study.folder.display()
        ));
    }
    if args.print_commands {
        write(Path::new("-"), report::commands(&open.jobs).as_bytes())?;
        let count = open.jobs.len();
        return Ok(Report::new(format!(
            "{} left, {} finished; nothing was run",
            geom::counted(count, "run"),
            geom::counted(kept, "run")
        )));
    }
    run(&args, &study, (&sweep, &open), counter)?;
    for (text, count) in work::warnings(&sweep.jobs) {
        cli::warn(&format!("{} of {runs} warned: {text}", geom::counted(count, "run")));
    }
    let judged = judge(&study, &sweep, &measure, counter).map_err(refused)?;
    if args.norm.is_some() && judged.points.iter().flat_map(|p| &p.samples).all(|s| s.value.len() == 1) {
        cli::warn(&format!("--norm changed nothing: the {} of a run is one number", measure.name));
    }
    publish(&args, &judged)?;
    Ok(report::report(&judged, runs, kept))
}

/// The error of a study as one of the tool.
fn refused(error: CurveError) -> anyhow::Error {
    match error {
        CurveError::Usage(text) => cli::usage(text),
        CurveError::Signal(why) => cli::stopped_by_signal(why),
        CurveError::At { what, source } => refused(*source).context(what),
        other => other.into(),
    }
}

fn lay_out(study: &Study) -> anyhow::Result<Sweep> {
    let sweep = Sweep::new(study).map_err(refused)?;
    cli::also_reads(sweep.files.clone())?;
    if sweep.one_seed {
        cli::warn("the result of this scene depends on random numbers: --repeat 3 gives intervals");
    }
    Ok(sweep)
}

fn run(
    args: &Args,
    study: &Study,
    (sweep, open): (&Sweep, &Open),
    counter: Option<Counter>,
) -> anyhow::Result<()> {
    let jobs = args.jobs.get();
    if jobs > 1 && study.work == Work::Seconds && !open.jobs.is_empty() {
        cli::warn(&format!("--jobs {jobs}: runs at the same time disturb each other's times"));
    }
    cli::stop_in_order();
    let progress = Progress::new("runs", open.jobs.len() as u64);
    let begins = |job: &SweepRun| progress.say(job.name.clone());
    let run = |some: &[&SweepRun]| {
        work::run(some, jobs, cli::stop_requested, &begins, &|| progress.add(1)).map_err(refused)
    };
    // Without the reference all others tell nothing: it is run first.
    let first = first_of_reference(sweep).map(|job| &job.folder);
    let (first, others): (Vec<&SweepRun>, Vec<&SweepRun>) =
        open.jobs.iter().partition(|job| Some(&job.folder) == first);
    run(&first)?;
    check_reference(study.work, sweep, counter).map_err(refused)?;
    run(&others)
}

/// Writes the table, the plot and the sentences.
fn publish(args: &Args, judged: &Judged) -> anyhow::Result<()> {
    write(Path::new("-"), csv(judged).as_bytes())?;
    if let Some(file) = &args.plot {
        let title = format!("{}: what accuracy costs", args.scene);
        write(file, &plot::draw(file, judged, &title)?)?;
    }
    let words = judged.words();
    if let Some(file) = &args.words {
        write(file, report::markdown(judged, &words).as_bytes())?;
    }
    if !cli::quiet() {
        words.iter().for_each(|line| cli::say(line));
    }
    Ok(())
}

fn write(file: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let mut out: OutputStream = Output { file: Some(file.into()) }.open_text()?;
    out.write_all(bytes).with_context(|| format!("{}: cannot write", file.display()))?;
    out.commit()
}
