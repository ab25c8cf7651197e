//! Table, text, samples and lists of jobs.

use crate::args::Args;
use anyhow::Context;
use calibration::session::{StepEnd, Tried};
use calibration::trial::run::Ended;
use calibration::{Judged, Recipe, draw, html, next_tests, samples, words};
use cli::{Output, Report};
use std::io::Write;
use std::path::{Path, PathBuf};
use stream::quoted;

/// Writes what was found.
pub fn publish(
    args: &Args,
    recipe: &Recipe,
    judged: &Judged,
    (steps, tried): (&[StepEnd], &[Tried]),
) -> anyhow::Result<Report> {
    write(&args.output, words::csv(judged).as_bytes())?;
    if let Some(file) = &args.words {
        write(&to(file), words::markdown(judged).as_bytes())?;
    }
    if let (Some(file), Some(last)) = (&args.samples, steps.last()) {
        write(&to(file), samples(recipe, last).as_bytes())?;
    }
    let next = match (&args.design, steps.last()) {
        (Some(file), Some(last)) => {
            let next = next_tests(recipe, last, tried);
            write(&to(file), words::design_csv(&next).as_bytes())?;
            next
        }
        _ => Vec::new(),
    };
    if let Some(file) = &args.plot {
        write(&to(file), &draw(file, recipe, judged, steps, tried)?)?;
    }
    if let Some(file) = &args.page {
        let picture = draw(Path::new("page.svg"), recipe, judged, steps, tried)?;
        write(&to(file), html(recipe, judged, &String::from_utf8_lossy(&picture)).as_bytes())?;
    }
    words::headline(judged).iter().chain(&words::warnings(judged)).for_each(|w| cli::warn(w));
    if !cli::quiet() {
        words::sentences(judged).iter().chain(&words::design_sentence(&next)).for_each(|line| cli::say(line));
    }
    let found = judged.findings.iter().filter(|f| f.determined).count();
    let trials: usize = judged.trials.iter().sum();
    let counted = |n: usize, what: &str| geom::counted(n, what);
    let summary = match words::headline(judged) {
        Some(_) => format!(
            "nothing fits; {}, {}",
            counted(judged.findings.len(), "parameter"),
            counted(trials, "trial")
        ),
        None => format!(
            "found {found} of {}, {}",
            counted(judged.findings.len(), "parameter"),
            counted(trials, "trial")
        ),
    };
    Ok(Report::new(summary).with("seed", recipe.settings.seed).with_all(judged).with("next", next))
}

/// Writes the open jobs.
pub fn jobs(args: &Args, jobs: &[PathBuf]) -> anyhow::Result<Report> {
    let program = std::env::current_exe().context("where this program is")?;
    let here = std::env::current_dir().context("the current folder")?;
    let line = |job: &PathBuf| {
        let job = here.join(job);
        format!(
            "{} -q --run {}\n",
            quoted(&program.display().to_string()),
            quoted(&job.display().to_string())
        )
    };
    let text: String = jobs.iter().map(line).collect();
    write(&Output { file: args.jobs_file.clone() }, text.as_bytes())?;
    let summary = geom::counted_as(jobs.len(), "run", ["is", "are"])
        + " open: run what is open, then give the same command again";
    Ok(Report::new(summary).with("open", jobs.len()))
}

/// Writes that no job is open.
pub fn no_jobs(args: &Args) -> anyhow::Result<()> {
    write(&Output { file: args.jobs_file.clone() }, b"")
}

/// Reports one run.
pub fn ended(job: &Path, ended: Option<Ended>) -> anyhow::Result<Report> {
    let exit = ended.as_ref().map_or(0, |e| e.exit);
    let summary = format!("{}: exit code {exit}", job.display());
    let report = Report::new(summary).with("run", ended);
    if exit != 0 && exit != 3 {
        anyhow::bail!("{}: exit code {exit}: see stderr in its folder", job.display());
    }
    Ok(report)
}

fn to(file: &Path) -> Output {
    Output { file: Some(file.into()) }
}

fn write(to: &Output, bytes: &[u8]) -> anyhow::Result<()> {
    let mut out = to.open_text()?;
    out.write_all(bytes).with_context(|| format!("{}: cannot write", to.name()))?;
    out.commit()
}
