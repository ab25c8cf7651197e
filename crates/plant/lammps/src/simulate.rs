//! A run on LAMMPS, written as it comes.

use crate::arrival::Arrival;
use crate::arrivals;
use crate::bonds::Bonds;
use crate::clumps;
use crate::deck::{Deck, Source};
use crate::dump::Parts;
use crate::error::Refusal;
use crate::error::{LammpsError, Result};
use crate::files::{DUMPS, FRAMES};
use crate::folder::{self, Start};
use crate::inflow::Inflow;
use crate::job::Job;
use crate::process::{Engine, Place};
use crate::refusal::{self, Allowed};
use dem::setup::{Setup, WallShape};
use record::{SIGNAL, StopCause};
use run::{Progress, RunError, RunFile, Schedule};
use scene::keys::{Patches, Sampling};
use scene::{Plan, Scene};
use serde::Serialize;
use std::io::Write;
use std::path::Path;
use stream::mcap::{Provenance, StreamOptions};

/// How a run is written and when it is stopped.
pub struct Settings<W> {
    /// What made the run.
    pub provenance: Provenance,
    /// How its file is written.
    pub how: StreamOptions<W>,
    /// Whether the run is to end.
    pub stop: fn() -> bool,
}

/// Where frames come from.
pub enum Origin<'a> {
    /// LAMMPS, which is started; in a folder that keeps its states, if there is one.
    Engine(&'a Engine, Option<&'a Start>),
    /// The dumps of a deck that has run before, by their names.
    Dumps(Vec<(&'static str, Parts<'a>)>),
}

/// What was done.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Outcome {
    /// Why it was stopped before its end, as its log has it.
    pub stopped: Option<String>,
    #[serde(skip)]
    pub stop: Option<StopCause>,
    /// Time reached [s].
    pub time: f64,
    /// Time step [s].
    pub dt: f64,
    pub steps: u64,
    /// Frames written.
    pub frames: u64,
    pub particles: usize,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// Particles that crossed a storage plane.
    pub crossings: u64,
}

/// Makes a scene sample forces at instants, and each contact act by itself, as LAMMPS does: the time step is chosen for that.
///
/// What the user should know of a scene that asked for contacts that act together is given for the plan of it.
pub fn sampled(scene: &mut Scene) -> impl Fn(&Setup) -> Option<String> + use<> {
    let time = &mut scene.keys.time;
    time.contacts = Sampling::Sampled;
    let shared = std::mem::replace(&mut time.patch, Patches::Plain) == Patches::Shared;
    move |setup| alone(setup).filter(|_| shared)
}

/// Says that contacts of two bodies act by themselves, where two bodies may touch at several places.
fn alone(setup: &Setup) -> Option<String> {
    let spheres = |wall: &dem::setup::Wall| matches!(wall.shape, WallShape::Spheres(_));
    let of = match (setup.walls.iter().any(spheres), !setup.clumps.shapes.is_empty()) {
        (true, true) => "walls of spheres and of clumps",
        (true, false) => "walls of spheres",
        (false, true) => "clumps",
        (false, false) => return None,
    };
    Some(format!(
        "each contact of {of} acts by itself in LAMMPS, so that rebounds are weaker than those of dem-run: to compare, run dem-run with --set time.patch=plain"
    ))
}

/// A scene that is ready for LAMMPS.
pub struct Prepared {
    pub deck: Deck,
    /// Which steps are frames.
    pub schedule: Schedule,
    setup: Setup,
    arrivals: Vec<Arrival>,
    /// What the user should know of the inlets.
    notes: Vec<String>,
}

impl Prepared {
    /// What the nearest that LAMMPS can do was taken for, and what is noteworthy of inlets.
    pub fn warnings(&self) -> Vec<String> {
        let one = |bent: &Refusal| format!("{}: {}: the nearest is taken", bent.what, bent.why);
        self.deck.bent.iter().map(one).chain(self.notes.iter().cloned()).collect()
    }

    /// The dumps that a run of it leaves, apart from the frames.
    pub fn dumps(&self) -> impl Iterator<Item = &'static str> {
        DUMPS.into_iter().filter(|dump| *dump != FRAMES && self.deck.asked.has(dump))
    }

    /// Readies a folder that keeps what a later start goes on from.
    ///
    /// # Errors
    /// A folder of another run, one where another process works, or one that cannot be used.
    pub fn start_in(&self, folder: &Path) -> Result<Start> {
        folder::ready(&self.deck, &self.setup, folder)
    }

    /// Refuses a folder whose deck is that of another scene; one without a deck says nothing.
    ///
    /// # Errors
    /// Where they differ.
    pub fn compare(&self, folder: &Path) -> Result<()> {
        if folder::has_deck(folder) { folder::same(&self.deck, &self.setup, folder) } else { Ok(()) }
    }

    /// Files of the deck that its input script reads.
    pub fn files(&self) -> Vec<&'static str> {
        self.deck.files()
    }

    /// Writes the deck into a folder; into one where a deck has run, only if it is the same.
    ///
    /// # Errors
    /// A folder of another run, or one that cannot be written to.
    pub fn write(&self, folder: &Path) -> Result<()> {
        if folder::has_run(folder) {
            return folder::same(&self.deck, &self.setup, folder);
        }
        self.deck.write(&self.setup, folder)
    }
}

/// Makes a scene ready that is allowed, whose inlets bring `inflow`.
///
/// # Errors
/// Laws and particles that LAMMPS cannot have, what the engine refuses.
pub fn prepare(
    scene: &Scene,
    plan: &Plan,
    inflow: &Inflow,
    allowed: &Allowed,
    ranks: usize,
) -> Result<Prepared> {
    run::ready(scene, plan, None)?;
    let dt = dem::time_step(&plan.setup).map_err(RunError::from)?;
    let schedule = Schedule::new(scene, dt)?;
    let mut setup = plan.setup.clone();
    clumps::add_members(&mut setup);
    let arrivals = arrivals::add(&mut setup, plan, inflow, &schedule)?;
    let bonds = Bonds::of(&plan.setup)?;
    let source = Source {
        scene,
        setup: &setup,
        arrivals: &arrivals,
        bonds: &bonds,
        schedule: &schedule,
        allowed,
        ranks,
    };
    let notes = inflow.warnings(schedule.end(), refusal::has_springs(&setup));
    Ok(Prepared { deck: Deck::of(source)?, setup, arrivals, notes, schedule })
}

/// Runs a deck on LAMMPS, or reads its dump, and writes the run.
///
/// # Errors
/// LAMMPS that fails, a dump that breaks off, output that cannot be written.
pub fn run<W: Write>(
    scene: &Scene,
    plan: &Plan,
    prepared: &Prepared,
    origin: Origin,
    out: W,
    settings: Settings<W>,
    report: &mut dyn FnMut(&Progress),
) -> Result<(Outcome, W)> {
    let Prepared { schedule, setup, arrivals, .. } = prepared;
    let mut file = RunFile::begin(scene, plan, schedule, out, &settings.provenance, settings.how)?;
    file.note(0.0, "computed by LAMMPS; forces are sampled at instants, and the file has no checkpoint")?;
    prepared.warnings().iter().try_for_each(|warning| file.note(0.0, warning))?;
    let mut job = Job::new(setup, arrivals, schedule, &prepared.deck, report);
    let stop = match origin {
        Origin::Dumps(dumps) => {
            let ended = job.read(&mut file, dumps)?;
            job.whole(ended)?;
            None
        }
        Origin::Engine(engine, Some(start)) => {
            if start.number > 1 {
                file.note(0.0, &format!("LAMMPS was started {} times", start.number))?;
            }
            job.live(&mut file, engine, Place::Kept(start), settings.stop)?
        }
        Origin::Engine(engine, None) => {
            let folder = tempfile::tempdir().map_err(|error| LammpsError::Deck {
                folder: std::env::temp_dir().display().to_string(),
                error,
            })?;
            prepared.write(folder.path())?;
            job.live(&mut file, engine, Place::Passing(folder.path()), settings.stop)?
        }
    };
    let step = job.last.unwrap_or(0);
    let time = step as f64 * schedule.dt;
    if let Some(cause) = stop {
        file.stopped(time, SIGNAL, cause)?;
    }
    let outcome = Outcome {
        stopped: stop.map(|_| SIGNAL.to_owned()),
        stop,
        time,
        dt: schedule.dt,
        steps: step,
        frames: file.frames,
        particles: job.there.len(),
        warnings: job.warnings,
        crossings: job.crossings,
    };
    Ok((outcome, file.finish()?))
}
