//! Runs a scene: particles, contacts and walls through time, written as a run MCAP.

mod continued;
mod device;
mod keys;
mod misplaced;
mod new;
mod parts;
mod watch;

use anyhow::Context;
use clap::Parser;
use cli::{Output, Report, Source, Stopped};
use device::Accelerator;
use misplaced::MCAP;
use parts::Saved;
use record::StopCause;
use run::{Checkpoint, Earlier, Outcome, Progress, RunError, Settings, run};
use scene::{Input, Plan, Scene, SceneError};
use std::fs::File;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use watch::{Filling, Watch};

const EXAMPLES: &str = "Examples:\n\
    \x20 dem-run --new plant\n\
    \x20 dem-run scene.toml --explain\n\
    \x20 dem-run scene.toml -o run.mcap\n\
    \x20 dem-run lined.toml walls.mcap --set contact.0.restitution=0.3 -o lined.mcap\n\
    \x20 dem-run scene.toml --until 0.08 --resume run.mcap -o rest.mcap";

/// Run a DEM scene and write a run MCAP (walls, frames, crossings, checkpoints)
#[derive(Parser)]
#[command(after_help = EXAMPLES)]
struct Args {
    /// The scene (TOML), - for stdin
    #[arg(value_name = "SCENE.toml", required_unless_present_any = ["keys", "new"])]
    scene: Option<Source>,
    /// Walls and inlets (MCAP, detected by content), - for stdin
    #[arg(value_name = "WALLS|INLET.mcap")]
    inputs: Vec<Source>,
    /// Change a key of the scene, such as contact.0.restitution=0.3 (repeat for more)
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// End of the run [s], instead of time.until
    #[arg(long, value_name = "S")]
    until: Option<f64>,
    /// Take densities, moduli and Poisson's ratios that a [[material]] leaves out from the table of materials, by its name (docs/reference/scene.md)
    #[arg(long)]
    materials: bool,
    /// Print the active effects, the keys that switch them on, their cost, and the pair that limits the time step
    #[arg(long)]
    explain: bool,
    /// Print every key of a scene, with type, unit, range, default, meaning and an example
    #[arg(long, exclusive = true)]
    keys: bool,
    /// Make a folder with a commented scene that runs as it is
    #[arg(long, value_name = "FOLDER", exclusive = true)]
    new: Option<PathBuf>,
    /// Check the scene and its inputs without running
    #[arg(long)]
    check: bool,
    /// Resume a run from its last checkpoint
    #[arg(long, value_name = "RUN.mcap")]
    resume: Option<Source>,
    /// With --resume: begin the output with what that run has written until its checkpoint, so that it holds the whole run
    #[arg(long)]
    whole: bool,
    /// Compute the steps on a GPU, with the same bits as without: cuda, or cuda:1 for the second one; local runs the program of the GPU on the processor (docs/how-to/gpu.md)
    #[arg(long, value_name = "DEVICE")]
    device: Option<Accelerator>,
    /// Write one JSON line to stderr with each frame: time, rate, particles, energy, time left
    #[arg(long)]
    progress: bool,
    #[command(flatten)]
    output: Output,
}

fn main() -> ExitCode {
    cli::run("dem-run", |args: Args| {
        if let Some(folder) = &args.new {
            return new::write(folder);
        }
        let Some(scene) = args.scene.clone() else { return keys::print(&args.output) };
        dem_run(args, &scene)
    })
}

/// Adds the place of its cause in the scene to an error of the engine.
fn in_scene(error: anyhow::Error, scene: &Scene) -> anyhow::Error {
    match scene.place_in(error.as_ref()) {
        Some(place) => error.context(place),
        None => error,
    }
}

fn dem_run(args: Args, scene: &Source) -> anyhow::Result<Report> {
    Source::one_stdin([scene].into_iter().chain(&args.inputs).chain(&args.resume))?;
    misplaced::scene(scene)?;
    misplaced::inputs(scene, &args.inputs)?;
    let scene = read_scene(&args, scene)?;
    planned(args, &scene).map_err(|error| in_scene(error, &scene))
}

/// Plans the scene, and does with it what was asked for.
fn planned(args: Args, scene: &Scene) -> anyhow::Result<Report> {
    cli::also_reads(scene.files())?;
    if args.explain || args.check {
        without_run(&args)?;
    }
    let resumed = args.resume.as_ref().map(parts::resumed).transpose()?;
    let resume = match &resumed {
        Some(source) => Some(Checkpoint::last(&source.to_string(), source.open()?)?),
        None => None,
    };
    let earlier = earlier(&args, resumed.as_ref())?;
    misplaced::given_once(&args.inputs)?;
    let mut inputs = Vec::new();
    for source in &args.inputs {
        inputs.push(Input::open(&source.to_string(), source.open()?)?);
    }
    let filling = Filling::new();
    let plan = scene.plan_with(inputs, &|placing| filling.hear(placing))?;
    drop(filling);
    plan.warnings.iter().for_each(|note| cli::warn(note));
    if args.explain || args.check {
        return explain(&args, scene, plan, resume.as_ref());
    }
    run::ready(scene, &plan, resume.as_ref())?;
    parts::say(&args.output, resumed.as_ref());
    simulate(&args, scene, plan, resume, earlier)
}

/// What the resumed run has written, where the output is to begin with it.
fn earlier(args: &Args, resumed: Option<&Source>) -> anyhow::Result<Option<Earlier>> {
    match (args.whole, resumed) {
        (false, _) => Ok(None),
        (true, None) => Err(cli::usage("--whole has no effect without --resume: leave it out")),
        (true, Some(Source::Stdin)) => {
            Err(cli::usage("--whole reads the resumed run twice: give --resume a file instead of -"))
        }
        (true, Some(source)) => Ok(Some(Earlier::open(&source.to_string(), source.open()?)?)),
    }
}

/// Refuses options that change nothing where nothing runs, and a run as the output.
fn without_run(args: &Args) -> anyhow::Result<()> {
    let option = if args.explain { "--explain" } else { "--check" };
    let options = [
        (args.progress, "--progress"),
        (args.device.is_some(), "--device"),
        (args.whole && args.resume.is_some(), "--whole"),
    ];
    for (given, name) in options {
        if given {
            return Err(cli::usage(format!("{name}: {option} runs nothing: leave it out")));
        }
    }
    if args.explain && args.check {
        return Err(cli::usage("--check: --explain checks the scene as well: leave it out"));
    }
    if args.explain {
        return no_run(&args.output);
    }
    match args.output.path() {
        Some(path) => Err(cli::usage(format!("-o {}: --check writes nothing: leave it out", path.display()))),
        None => Ok(()),
    }
}

/// Refuses to write the text of `--explain` over a run or under the name of a run.
fn no_run(output: &Output) -> anyhow::Result<()> {
    let Some(path) = output.path() else { return Ok(()) };
    let mut head = [0; MCAP.len()];
    let holds = File::open(path).and_then(|mut file| file.read_exact(&mut head)).is_ok() && head == MCAP;
    if !holds && !output.has_extension("mcap") {
        return Ok(());
    }
    let (path, what) = (path.display(), if holds { "holds a run" } else { "is the name of a run" });
    Err(cli::usage(format!(
        "-o {path} {what}, and --explain writes text: leave -o out, or choose another name, such as FILE.txt"
    )))
}

/// Adds the name of the output to a write error.
fn written(error: RunError, args: &Args) -> anyhow::Error {
    match error {
        RunError::Mcap(e) => anyhow::Error::new(e).context(format!("{}: cannot write", args.output.name())),
        other => other.into(),
    }
}

fn read_scene(args: &Args, file: &Source) -> anyhow::Result<Scene> {
    let mut overrides = args.set.clone();
    // TOML writes nan and inf in small letters.
    overrides.extend(args.until.map(|s| format!("--until={s:?}").to_lowercase()));
    let folder = file.path().and_then(Path::parent).unwrap_or(Path::new(""));
    let (name, text) = (file.to_string(), file.read_text()?);
    let wrong = |error: SceneError| match error {
        SceneError::Override { .. } => cli::usage(error.to_string()),
        other => other.into(),
    };
    if !args.materials {
        return Scene::new(&name, text, &overrides, folder).map_err(wrong);
    }
    let (scene, taken) = Scene::with_materials(&name, text, &overrides, folder).map_err(wrong)?;
    if taken.is_empty() {
        return Err(cli::usage(
            "--materials has no effect: no [[material]] leaves out a number: leave it out",
        ));
    }
    if !cli::quiet() {
        taken.iter().for_each(|number| cli::say(&format!("dem-run: {number}")));
    }
    Ok(scene)
}

fn explain(args: &Args, scene: &Scene, plan: Plan, resume: Option<&Checkpoint>) -> anyhow::Result<Report> {
    if resume.is_some() {
        run::ready(scene, &plan, resume)?;
    }
    let from = resume.map(Checkpoint::time);
    let explained = run::explain::explain(scene, plan, args.explain)?;
    if args.explain {
        let mut out = args.output.open_text()?;
        for line in explained.text.lines() {
            writeln!(out, "{}", cli::escaped(line)).context("--explain")?;
        }
        out.commit()?;
    }
    let resumes = from.map_or(String::new(), |time| format!("; it resumes at {} s", geom::Shown(time)));
    let report = Report::new(format!("the scene can run: {}{resumes}", explained.summary));
    Ok(report.with("resumes_at_s", from).with_all(&explained.fields))
}

fn simulate(
    args: &Args,
    scene: &Scene,
    plan: Plan,
    resume: Option<Checkpoint>,
    earlier: Option<Earlier>,
) -> anyhow::Result<Report> {
    let device = args.device.map(Accelerator::open).transpose()?;
    let out = args.output.open_long()?;
    let (keep, part) = (out.keeper(), args.output.name_of_part(&out));
    let first = u64::from(resume.is_none());
    let (provenance, how) = (cli::provenance(plan.inputs.clone()), out.how());
    let (watched, ledger) = (args.progress, plan.setup.ledger);
    let settings = Settings { provenance, how, resume, earlier, watched, stop: cli::stop_requested, device };
    cli::stop_in_order();
    let (mut watch, mut saved) = (Watch::new(args.progress), Saved::default());
    // What is in the file before the first step can be had again at no cost.
    let mut hear = |progress: &Progress| {
        if progress.checkpoints > 0 || progress.frames > first {
            keep.keep();
            saved = Saved { time: progress.saved, resumes: progress.checkpoints > 0 };
        }
        watch.hear(progress);
    };
    let done = run(scene, plan, out, settings, &mut hear).map_err(|e| written(e, args));
    let done = done.and_then(|(outcome, out)| out.commit().map(|()| outcome));
    drop(watch);
    let outcome = done.map_err(|e| {
        let part = part.as_deref().filter(|_| keep.kept());
        cli::with_part(e, part, saved.time, |part| saved.use_of(part))
    })?;
    warn(&outcome);
    let report = Report::new(summary(&outcome, ledger)).with_all(&outcome);
    let report = report.with("until", scene.keys.time.until);
    match &outcome.stop {
        Some((cause, _)) => Err(Stopped::error(stopped(&args.output, scene, &outcome), Some(*cause), report)),
        None => Ok(report),
    }
}

/// Prints what the user should know of a run.
fn warn(outcome: &Outcome) {
    let large = outcome.integration.as_ref().and_then(run::IntegrationError::warning);
    run::warnings(&outcome.returned)
        .iter()
        .chain(&outcome.inflow)
        .chain(&large)
        .chain(&outcome.fallen.map(|fallen| fallen.to_string()))
        .chain(&outcome.servos.iter().filter_map(run::ServoHeld::warning).collect::<Vec<_>>())
        .for_each(|note| cli::warn(note));
}

/// A run in one line; with the `ledger` also its integration error.
fn summary(outcome: &Outcome, ledger: bool) -> String {
    let held = outcome.servos.iter().filter(|servo| servo.warning().is_none());
    let held: String = held.map(|servo| format!("; {servo}")).collect();
    let removed: String =
        run::removals(&outcome.returned).iter().map(|removed| format!("; {removed}")).collect();
    let unknown = if ledger { "" } else { UNMEASURED };
    let error = outcome.integration.as_ref().map_or(unknown.to_owned(), |error| format!(", {error}"));
    let settled = outcome.settled.as_ref().map_or(String::new(), |why| format!("; ended at rest: {why}"));
    let by = outcome.device.as_ref().map_or(String::new(), |name| format!(" on {name}"));
    format!(
        "{} of {:.3e} s to {} s{by}, {}, {}{error}{settled}{removed}{held}",
        geom::counted(outcome.steps, "step"),
        outcome.dt,
        geom::Shown(outcome.time),
        geom::counted(outcome.particles, "particle"),
        geom::counted(outcome.frames, "frame")
    )
}

/// Of a run without the ledger: only its books show what the time step made.
const UNMEASURED: &str = ", integration error not measured (output.energy = true measures it)";

/// Why a run stopped, and how to continue it.
fn stopped(output: &Output, scene: &Scene, outcome: &Outcome) -> String {
    let Some((cause, why)) = &outcome.stop else { return String::new() };
    let file = continued::file(output);
    let of = scene.keys.time.until.map_or(String::new(), |until| format!(" of {} s", geom::Shown(until)));
    let reached = format!("t = {} s{of}", geom::Shown(outcome.time));
    match cause {
        StopCause::Signal => {
            let how = file
                .map_or("continue with --resume FILE, the file that holds this output".to_owned(), |file| {
                    continued::sentence(&file, &[])
                });
            format!("stopped by a signal at {reached}; {how}")
        }
        StopCause::Device => {
            let on = file.map(|file| format!("; {}, without --device", continued::sentence(&file, &[])));
            format!(
                "stopped at {reached}: {}{}",
                outcome.stopped.as_ref().unwrap_or(why),
                on.unwrap_or_default()
            )
        }
        StopCause::Guard { .. } => {
            let wider = outcome.halt.as_ref().map_or(Vec::new(), continued::wider);
            let past = file.filter(|_| !wider.is_empty()).map(|file| continued::sentence(&file, &wider));
            let past = past.map_or(String::new(), |past| format!("; to go past the guard, {past}"));
            format!("stopped by a guard at {reached}: {why}{past}")
        }
    }
}
