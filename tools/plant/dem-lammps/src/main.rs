//! Runs a scene on LAMMPS: the same scene, the same run MCAP.

mod args;

use anyhow::Context;
use args::Args;
use cli::{Report, Source, Stopped};
use geom::counted;
use lammps::{Engine, Inflow, LammpsError, Origin, Prepared, Settings, Start, Target, Version};
use run::{Progress, RunError};
use scene::{Input, Plan, Scene, SceneError};
use std::io::BufReader;
use std::num::NonZeroUsize;
use std::path::Path;
use std::process::ExitCode;

/// Steps of the bar.
const BAR: f64 = 1000.0;

fn main() -> ExitCode {
    cli::run("dem-lammps", dem_lammps)
}

fn dem_lammps(args: Args) -> anyhow::Result<Report> {
    args.check()?;
    let mut scene = read_scene(&args)?;
    cli::also_reads(scene.files())?;
    planned(&args, &mut scene).map_err(|error| match scene.place_in(error.as_ref()) {
        Some(place) => error.context(place),
        None => error,
    })
}

/// Plans the scene, and does with it what was asked for.
fn planned(args: &Args, scene: &mut Scene) -> anyhow::Result<Report> {
    let alone = lammps::sampled(scene);
    let mut inputs = Vec::new();
    for source in &args.inputs {
        inputs.push(Input::open(&source.to_string(), source.open()?)?);
    }
    let mut plan = scene.plan(inputs)?;
    plan.warnings.extend(alone(&plan.setup));
    plan.warnings.iter().for_each(|note| cli::warn(note));
    let engine = engine(args);
    let version = version(args, &engine, &plan)?;
    let target = Target { version, nearest: args.nearest };
    let allowed = lammps::allow(scene, &plan, target).with_context(|| args.scene.to_string())?;
    let inflow = Inflow::read(&mut plan, scene.keys.time.until.unwrap_or(0.0))?;
    let prepared = lammps::prepare(scene, &plan, &inflow, &allowed, engine.ranks)
        .with_context(|| args.scene.to_string())?;
    if args.nearest && prepared.deck.bent.is_empty() {
        cli::warn("--nearest changes nothing: LAMMPS has all that the scene asks for");
    }
    prepared.warnings().iter().for_each(|note| cli::warn(note));
    if args.check {
        let schedule = &prepared.schedule;
        return Ok(Report::new(format!(
            "LAMMPS can run the scene: {} of {:.3e} s",
            counted(schedule.last, "step"),
            schedule.dt
        )));
    }
    if let Some(folder) = &args.write_deck {
        prepared.write(folder)?;
        let folder = folder.display();
        return Ok(Report::new(format!(
            "{folder}: run.in, {} and batch.sh; run it there with lmp -in run.in",
            prepared.files().join(", ")
        )));
    }
    simulate(args, scene, &plan, &prepared, &engine)
}

fn read_scene(args: &Args) -> anyhow::Result<Scene> {
    let mut overrides = args.set.clone();
    // TOML writes nan and inf in small letters.
    overrides.extend(args.until.map(|s| format!("--until={s:?}").to_lowercase()));
    let folder = args.scene.path().and_then(Path::parent).unwrap_or(Path::new(""));
    let scene = Scene::new(&args.scene.to_string(), args.scene.read_text()?, &overrides, folder);
    scene.map_err(|error| match error {
        SceneError::Override { .. } => cli::usage(error.to_string()),
        other => other.into(),
    })
}

fn engine(args: &Args) -> Engine {
    let words = |given: &Option<String>, usual: &str| -> Vec<String> {
        given.as_deref().unwrap_or(usual).split_whitespace().map(str::to_owned).collect()
    };
    Engine {
        lmp: words(&args.lmp, "lmp"),
        ranks: args.ranks.map_or(1, NonZeroUsize::get),
        mpirun: words(&args.mpirun, "mpirun"),
    }
}

/// The version of the program. Where a deck is written, a dump read or a scene checked without one, a version that can run the scene.
fn version(args: &Args, engine: &Engine, plan: &Plan) -> anyhow::Result<Version> {
    let usual = Version::that_runs(&plan.setup);
    if args.read_dump.is_some() {
        return Ok(usual);
    }
    match (args.lmp.is_some(), args.check, args.write_deck.is_some()) {
        (false, true, _) => Ok(engine.version().unwrap_or(usual)),
        (false, _, true) => Ok(usual),
        _ => Ok(engine.version()?),
    }
}

/// Adds the name of the output to a write error.
fn written(error: LammpsError, args: &Args) -> anyhow::Error {
    match error {
        LammpsError::Run(RunError::Mcap(e)) => {
            anyhow::Error::new(e).context(format!("{}: cannot write", args.output.name()))
        }
        other => other.into(),
    }
}

/// A dump of frames, and the others, which lie beside it.
fn dumps<'a>(source: &Source, prepared: &Prepared) -> anyhow::Result<Origin<'a>> {
    let open =
        |path: &Path| lammps::open(path).with_context(|| format!("{}: cannot open it", path.display()));
    let frames = match source.path() {
        Some(path) => open(path)?,
        None => vec![Box::new(BufReader::new(source.open()?)) as Box<_>],
    };
    if let Some(Err(other)) = source.path().and_then(Path::parent).map(|folder| prepared.compare(folder)) {
        cli::warn(&format!("the dump may be of another scene: {other}"));
    }
    let mut all = vec![(lammps::FRAMES, frames)];
    for name in prepared.dumps() {
        let Some(path) = source.path() else {
            return Err(cli::usage(format!(
                "--read-dump -: the scene needs {name}, too: name the file beside which it lies"
            )));
        };
        all.push((name, open(&path.with_file_name(name))?));
    }
    Ok(Origin::Dumps(all))
}

/// Says how a run in a folder goes on.
fn told(start: &Start) {
    if let Some(words) = &start.warning {
        cli::warn(words);
    }
    let folder = start.folder.display();
    match start.state {
        _ if cli::quiet() => {}
        _ if start.finished => {
            cli::say(&format!("dem-lammps: {folder}: all steps are done: its frames are read"))
        }
        Some(state) => {
            cli::say(&format!("dem-lammps: {folder}: goes on from {state}, start {}", start.number))
        }
        None => {}
    }
}

fn simulate(
    args: &Args,
    scene: &Scene,
    plan: &Plan,
    prepared: &Prepared,
    engine: &Engine,
) -> anyhow::Result<Report> {
    let out = args.output.open_long()?;
    let (keep, part) = (out.keeper(), args.output.name_of_part(&out));
    let how = out.how();
    cli::stop_in_order();
    let settings =
        Settings { provenance: cli::provenance(plan.inputs.clone()), how, stop: cli::stop_requested };
    let start = args.dir.as_deref().map(|folder| prepared.start_in(folder)).transpose()?;
    start.iter().for_each(told);
    let origin = match (&args.read_dump, &start) {
        (Some(source), _) => dumps(source, prepared)?,
        (None, Some(start)) if start.finished => {
            dumps(&Source::File(start.folder.join(lammps::FRAMES)), prepared)?
        }
        (None, start) => Origin::Engine(engine, start.as_ref()),
    };
    let bar = (!args.progress).then(|| cli::Progress::new("run", BAR as u64));
    let mut saved = 0.0;
    let mut hear = |progress: &Progress| {
        keep.keep();
        saved = progress.saved;
        if let Some(bar) = &bar {
            bar.set((BAR * progress.share) as u64);
            bar.say(format!(
                "t = {:.4} of {:.4} s, {}",
                progress.time,
                progress.until,
                counted(progress.particles, "particle")
            ));
        } else if let Ok(line) = serde_json::to_string(progress) {
            cli::say(&line);
        }
    };
    let done =
        lammps::run(scene, plan, prepared, origin, out, settings, &mut hear).map_err(|e| written(e, args));
    let done = done.and_then(|(outcome, out)| out.commit().map(|()| outcome));
    drop(bar);
    let outcome = done.map_err(|e| {
        let part = part.as_deref().filter(|_| keep.kept());
        cli::with_part(e, part, saved, |_| "dem-view shows it".to_owned())
    })?;
    outcome.warnings.iter().for_each(|warning| cli::warn(warning));
    let summary = format!(
        "{} of {:.3e} s to {} s on LAMMPS, {}, {}",
        counted(outcome.steps, "step"),
        outcome.dt,
        geom::Shown(outcome.time),
        counted(outcome.particles, "particle"),
        counted(outcome.frames, "frame")
    );
    let report = Report::new(summary).with_all(&outcome);
    match outcome.stop {
        Some(cause) => {
            let time = geom::Shown(outcome.time);
            let again = if args.dir.is_some() { ": the same command continues" } else { "" };
            Err(Stopped::error(
                format!("stopped by a {} at t = {time} s{again}", cause.name()),
                Some(cause),
                report,
            ))
        }
        None => Ok(report),
    }
}
