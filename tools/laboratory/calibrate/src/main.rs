//! Finds the parameters of a model from measured curves, with intervals that say what the data cannot tell.

mod args;
mod guess;
mod outputs;
mod watch;

use args::Args;
use calibration::session::{Session, Standing};
use calibration::{CalibrateError, judge, recipe, trial};
use cli::Report;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::run("calibrate", calibrate)
}

fn calibrate(args: Args) -> anyhow::Result<Report> {
    cli::stop_in_order();
    if args.guess {
        return guess::guess(&args);
    }
    if let Some(job) = &args.run {
        let ended = trial::pool::one(job, cli::stop_requested).map_err(refused)?;
        return outputs::ended(job, ended);
    }
    let path = args.recipe()?;
    args.check_names()?;
    let mut recipe = recipe::read(path, &args.data()).map_err(refused)?;
    recipe.settings.seed = args.seed.unwrap_or(recipe.settings.seed);
    recipe.warnings.iter().for_each(|w| cli::warn(w));
    let (dir, watch) = (args.dir(path), watch::Terminal::new());
    let (list, candidates) = (args.jobs_file.is_some(), args.design.is_some());
    let session = Session {
        recipe: &recipe,
        dir,
        jobs: args.jobs(),
        stop: cli::stop_requested,
        watch: &watch,
        list,
        candidates,
        verify: !args.no_verify,
    };
    let standing = if args.so_far { session.so_far() } else { session.run() };
    match standing.map_err(refused)? {
        Standing::Open(jobs) => outputs::jobs(&args, &jobs),
        Standing::Done { tried, steps } => {
            let judged = judge(&recipe, &tried, &steps);
            watch.end();
            if list {
                outputs::no_jobs(&args)?;
            }
            outputs::publish(&args, &recipe, &judged, (&steps, &tried))
        }
    }
}

/// The error of the library as one of the tool.
fn refused(error: CalibrateError) -> anyhow::Error {
    match error {
        CalibrateError::Usage(text) => cli::usage(text),
        signal @ CalibrateError::Signal { .. } => cli::stopped_by_signal(signal.to_string()),
        other => other.into(),
    }
}
