//! Runs a standard laboratory test on a sample of grains.

mod args;
mod listed;
mod outputs;
mod words;

use anyhow::Context;
use args::Args;
use cli::{Progress, Report, Stopped};
use lab::lab::beside_this_program;
use lab::scenes::Which;
use lab::{Lab, LabError, Programs, Sample, Specimens};
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run("lab-test", lab_test)
}

fn lab_test(args: Args) -> anyhow::Result<Report> {
    args.check()?;
    let toml = args.sample.read_text()?;
    let lab = lay_out(&args, &toml, &args.seeds())?;
    lab.sample().grains.warnings.iter().for_each(|warning| cli::warn(warning));
    if args.print_scene || args.print_preparation {
        return print_scene(&args, &toml, &lab);
    }
    let kept = args.dir.as_ref().map(std::path::absolute).transpose()?;
    let own = tempfile::tempdir().context("cannot make a folder for the runs: give one with --dir")?;
    let folder = kept.as_deref().unwrap_or(own.path());
    if let Some(file) = &args.jobs_file {
        let open = lab.open(folder, &programs(1)?).map_err(refused)?;
        listed::write(file, &args, &lab, &open)?;
        if !open.is_empty() {
            return Ok(listed::report(&open));
        }
    }
    let specimens = run(&lab, folder, args.dir.is_some())?;
    specimens.list.iter().for_each(|(loading, outcome)| outputs::warn(&lab.name(loading), outcome));
    let summary = lab.summary(&specimens);
    outputs::write(&args, &lab, &specimens, &summary, folder)?;
    let report = outputs::report(&lab, &specimens, &summary);
    let stopped = lab.stopped(&specimens);
    match stopped.first() {
        None => Ok(report),
        Some(first) => {
            let (n, all) = (stopped.len(), specimens.list.len());
            Err(Stopped::error(
                format!("a guard has stopped {n} of {all} specimens, which the results leave out: {first}"),
                specimens.stop(),
                report,
            ))
        }
    }
}

fn lay_out(args: &Args, toml: &str, seeds: &[u64]) -> anyhow::Result<Lab> {
    let name = args.sample.to_string();
    let folder = args.sample.path().and_then(Path::parent).unwrap_or(Path::new("")).to_owned();
    let sample = Sample::new(&name, toml.to_owned(), &args.set, &folder).map_err(refused)?;
    cli::also_reads(sample.files.clone())?;
    let lab = Lab::new(args.test()?, sample, args.request(), seeds).map_err(refused)?;
    if !lab.is_random() {
        args.seed.none(&format!("{} with these grains", lab.recipe().name()))?;
    }
    if args.seeds == 1 && lab.is_random() && !args.print_scene && !args.print_preparation {
        cli::warn("one specimen for each stress gives no intervals: --seeds 3 gives them");
    }
    Ok(lab)
}

/// The error of a test as one of the tool.
fn refused(error: LabError) -> anyhow::Error {
    match error {
        LabError::Usage(text) => cli::usage(text),
        signal @ (LabError::Signal { .. } | LabError::Interrupted) => {
            cli::stopped_by_signal(signal.to_string())
        }
        // A program that the same signal has ended.
        other if cli::stop_requested() => cli::stopped_by_signal(format!("stopped by a signal: {other}")),
        other => other.into(),
    }
}

fn print_scene(args: &Args, toml: &str, lab: &Lab) -> anyhow::Result<Report> {
    let (which, name) = match args.print_scene {
        true => (Which::Test, "test"),
        false => (Which::Preparation, "preparation"),
    };
    let Some(scene) = lab.scene(which).map_err(refused)? else {
        let test = lab.recipe().name();
        return Err(cli::usage(format!(
            "--print-preparation: {test} prepares nothing with these grains: leave it out"
        )));
    };
    let other = lay_out(args, toml, &[args.seed.seed().wrapping_add(1)])?;
    if other.scene(which).map_err(refused)?.as_ref() == Some(&scene) {
        args.seed.none(&format!("the scene of the {name}"))?;
    }
    outputs::text(&args.output, &scene)?;
    Ok(Report::new(format!("the scene of the {name}; nothing was run")))
}

fn programs(threads: usize) -> anyhow::Result<Programs> {
    Ok(Programs { folder: beside_this_program().map_err(refused)?, threads, stop: cli::stop_requested })
}

fn run(lab: &Lab, folder: &Path, kept: bool) -> anyhow::Result<Specimens> {
    let threads = rayon::current_num_threads();
    let at_once = threads.min(lab.loadings().len());
    let programs = programs(threads / at_once)?;
    cli::stop_in_order();
    let progress = Progress::new("specimens", lab.loadings().len() as u64);
    let begins = |name: &str| progress.say(name.to_owned());
    lab.run(folder, &programs, at_once, &begins, &|| progress.add(1)).map_err(|error| match error {
        signal @ LabError::Signal { .. } => {
            let again = if kept { "the same command continues" } else { "with --dir they would be kept" };
            cli::stopped_by_signal(format!("{signal}: {again}"))
        }
        other => refused(other),
    })
}
