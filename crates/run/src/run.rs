//! The run: steps, frames, crossings, checkpoints.

mod start;
mod stop;
mod write;

use crate::checkpoint::Checkpoint;
use crate::error::SceneError;
use crate::feeds::{Item, Supply};
use crate::frames::WallHead;
use crate::model::Precision;
use crate::moment::Moment;
use crate::paths::Waypoint;
use crate::schedule::{Schedule, nanoseconds};
use crate::{Plan, Scene};
use dem::setup::{Crossing, Step};
use dem::{Halt, SetupError, Simulation};
use serde::Serialize;
use std::io::Write;
use stream::mcap::{How, McapError, Provenance, Writer};
use thiserror::Error;
use write::Ended;

/// Topic of frames.
pub const PARTICLES: &str = "/particles";
/// Topic of rigid clumps.
pub const BODIES: &str = "/bodies";
/// Topic of bonds.
pub const BONDS: &str = "/bonds";
/// Topic of contacts.
pub const CONTACTS: &str = "/contacts";
/// Topic of wall spheres.
pub const WALLS: &str = "/walls";
/// Topic of planes, meshes and motions of walls.
pub const SURFACES: &str = "/surfaces";
/// Topic of the energy ledger.
pub const ENERGY: &str = "/energy";
/// Topic of the forces on walls.
pub const WALL_FORCES: &str = "/wall_forces";
/// Topic of what happened.
pub const LOG: &str = "/log";
/// Metadata record with the shapes of clumps: JSON by index, the column `clump` of [`BODIES`].
pub const CLUMPS: &str = "clumps";
/// Metadata record with the outlets of a run.
pub const OUTLETS: &str = "outlets";

/// Why a run was stopped that [`Settings::stop`] ended.
pub const SIGNAL: &str = "by a signal";

const FRAME: &str = "world";

/// Particles up to which a run holds the state of the last instant that was looked at, to go back to: twice its memory. A larger run goes
/// back to the last checkpoint in its file.
const HELD: usize = 500_000;
/// Samples of paths that are held before they are written.
const SAMPLES_HELD: usize = 4096;

/// Steps between looks for grains that zones have lost: no grain gets past the length of a zone in so few.
const LOOK_BACK: u64 = 64;

/// Why a run failed.
#[derive(Debug, Error)]
#[allow(missing_docs)]
pub enum RunError {
    #[error("{0}")]
    Scene(#[from] SceneError),
    #[error("{0}")]
    Setup(#[from] SetupError),
    #[error("{0}")]
    Mcap(#[from] McapError),
    #[error("{0}")]
    State(#[from] stream::state::StateError),
}

/// What was done.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Outcome {
    /// Why the run was stopped: what a guard says, or [`SIGNAL`].
    pub stopped: Option<String>,
    /// Time reached [s].
    pub time: f64,
    /// Time step [s].
    pub dt: f64,
    /// Which measured curve the time step relies on, when the scene asks for an accuracy.
    pub chosen_by: Option<String>,
    /// Steps done in this run.
    pub steps: u64,
    /// Frames written.
    pub frames: u64,
    /// Particles at the end.
    pub particles: usize,
    /// Particles that entered.
    pub entered: u64,
    /// Particles that passed a storage plane.
    pub crossings: u64,
    /// Particles that went back through planes.
    pub returned: dem::Returned,
    /// What is to be said of records that ended before the run.
    pub inflow: Vec<String>,
    /// Contacts listed at the end.
    pub listed_contacts: usize,
    /// How often neighbours were listed.
    pub listings: u64,
    /// Bonds at the start, and those that broke until the end.
    pub bonds: [usize; 2],
    /// Particles that sleep at the end.
    pub asleep: usize,
    /// Effects in force: name, pair, key.
    pub effects: Vec<String>,
}

/// How a run is written.
pub struct Settings<W> {
    /// What made it.
    pub provenance: Provenance,
    /// How its file is written.
    pub how: How<W>,
    /// Whether the energy of each frame is computed for who hears of progress.
    pub watched: bool,
    /// Asked between steps: whether the run is to end here, with a checkpoint.
    pub stop: fn() -> bool,
}

/// Refuses what would only be refused after the output was opened.
///
/// # Errors
/// What the engine refuses, an end that is missing.
pub fn ready(scene: &Scene, plan: &Plan, resume: Option<&Checkpoint>) -> Result<(), RunError> {
    let limit = dem::critical_step(&plan.setup)?;
    let dt = match (resume, plan.setup.step) {
        // It was checked when the run began; a guard that has changed since says nothing of it.
        (Some(checkpoint), _) => checkpoint.dt(),
        (None, Step::Auto(share)) => share * limit.dt,
        (None, Step::Fixed(dt)) if dt > limit.dt => {
            return Err(SetupError::StepTooLarge { dt, critical: limit.dt, pair: limit.pair }.into());
        }
        (None, Step::Fixed(dt)) => dt,
    };
    if dt.is_finite() {
        Schedule::new(scene, dt)?;
    }
    Ok(())
}

struct Run<W: Write> {
    sim: Simulation,
    supply: Supply,
    writer: Writer<W>,
    schedule: Schedule,
    scene: String,
    inputs: Vec<(String, String)>,
    walls: Vec<WallHead>,
    moving: bool,
    outlets: bool,
    clumps: bool,
    /// Masses of clumps at scale 1 [kg].
    masses: Vec<f64>,
    energy: bool,
    contacts: bool,
    wall_forces: bool,
    precision: Precision,
    crossings: Vec<Crossing>,
    /// Steps between samples of paths, where any are recorded.
    sampling: Option<u64>,
    /// After how many steps they were sampled last, or saved.
    sampled: Option<u64>,
    paths: Vec<Waypoint>,
    outcome: Outcome,
    /// Kinetic energy and balance [J] of the frame that has just been written.
    looked: Option<(f64, Option<f64>)>,
    watched: bool,
    /// What the feeds had given and the state when something was last written: a run whose numbers are lost goes on from there.
    before: Option<(Vec<u64>, dem::State)>,
    /// When that was, whether or not it is held [s].
    looked_at: f64,
    checkpoints: u64,
}

/// Runs a scene to its end, or until a guard or a request stops it, and gives the output back.
///
/// `progress` hears where the run is, every few steps and with each frame.
///
/// # Errors
/// What the engine refuses, an inlet that breaks off, output that cannot be written.
pub fn run<W: Write>(
    scene: &Scene,
    plan: Plan,
    resume: Option<Checkpoint>,
    out: W,
    settings: Settings<W>,
    progress: &mut dyn FnMut(&Moment),
) -> Result<(Outcome, W), RunError> {
    let (stop, watched) = (settings.stop, settings.watched);
    let mut run = Run::start(scene, plan, resume, out, settings)?;
    run.watched = watched;
    let first = run.sim.steps();
    let reason = loop {
        let step = run.sim.steps();
        run.sample()?;
        match run.look(step, first) {
            Err(Ended::Guard(halt)) => break Some(stopped(scene, step, halt)?),
            Err(Ended::Failed(error)) => return Err(error),
            Ok(()) => {}
        }
        if step >= run.schedule.last {
            progress(&run.moment(first));
            break None;
        }
        if step % 256 == 0 || run.looked.is_some() {
            progress(&run.moment(first));
        }
        // After the frame: a run that is resumed does not write it again.
        if stop() {
            break Some(SIGNAL.to_owned());
        }
        match run.feed() {
            // The signal also ended what feeds this run; what had come in is in the checkpoint.
            Err(_) if stop() => break Some(SIGNAL.to_owned()),
            other => other?,
        }
        let outcome = run.sim.step();
        run.crossings.append(&mut run.sim.take_crossings());
        let outcome = outcome.and_then(|()| if step % LOOK_BACK == 0 { run.sim.look_back() } else { Ok(()) });
        if let Err(halt) = outcome {
            break Some(stopped(scene, step, halt)?);
        }
    };
    run.outcome.returned = run.sim.returned().clone();
    run.outcome.inflow = run.supply.ended(run.sim.time());
    let notes = [crate::returned::words(&run.outcome.returned), run.outcome.inflow.clone()].concat();
    for note in notes {
        run.log("note", &note)?;
    }
    if let Some(reason) = reason {
        run.stop(reason)?;
    }
    run.outcome.steps = run.sim.steps() - first;
    run.outcome.time = run.sim.time();
    run.outcome.particles = run.sim.particle_count();
    (run.outcome.listed_contacts, run.outcome.asleep) = (run.sim.listed_contacts(), run.sim.asleep());
    (run.outcome.listings, run.outcome.bonds) = (run.sim.listings(), run.sim.bond_count());
    let named =
        |e: &dem::EffectCost| format!("{} ({}–{}): {}", e.effect, e.between.0, e.between.1, e.because);
    run.outcome.effects = run.sim.explain().iter().map(named).collect();
    run.outcome.entered = run.supply.entered;
    let out = run.writer.finish()?;
    Ok((run.outcome, out))
}

/// What a guard says. What overlaps before the first step is no matter of the calculation: the scene is wrong.
pub(crate) fn stopped(scene: &Scene, step: u64, halt: Halt) -> Result<String, SceneError> {
    match halt {
        Halt::Overlap { id, partner, overlap, .. } if step == 0 => {
            Err(SceneError::Inside { name: scene.text.name.clone(), id, partner, overlap })
        }
        other => Ok(other.to_string()),
    }
}

impl<W: Write> Run<W> {
    /// Where the run is, that began at step `first`.
    fn moment(&mut self, first: u64) -> Moment {
        let (step, steps) = (self.sim.steps(), self.schedule.last);
        let (kinetic, balance) = self.looked.take().unzip();
        Moment {
            time: self.sim.time(),
            until: steps as f64 * self.schedule.dt,
            step,
            steps,
            share: (step - first) as f64 / (steps - first).max(1) as f64,
            particles: self.sim.particle_count(),
            asleep: self.sim.asleep(),
            kinetic,
            balance: balance.flatten(),
            frames: self.outcome.frames,
            checkpoints: self.checkpoints,
            saved: self.looked_at,
        }
    }

    fn now(&self) -> u64 {
        nanoseconds(self.sim.time())
    }

    fn log(&mut self, kind: &str, text: &str) -> Result<(), RunError> {
        let message = serde_json::json!({"time": self.sim.time(), "kind": kind, "text": text});
        Ok(self.writer.bytes(LOG, "json", self.now(), json(&message).as_bytes())?)
    }

    /// Everything that enters before the next step must know of it.
    fn feed(&mut self) -> Result<(), RunError> {
        // Where grains follow recorded paths, the next sample of each must be known.
        let horizon = self.sim.time() + self.sim.look_ahead() + self.supply.samples();
        while let Some(item) = self.supply.next_until(horizon)? {
            match item {
                Item::Enter(entry) => self.sim.enter(entry)?,
                Item::Guide { id, guide, .. } => self.sim.guide(id, guide)?,
                Item::Remember { memory, .. } => self.sim.remember(memory),
                Item::Link { link, .. } => self.sim.link(link),
            }
        }
        Ok(())
    }
}

/// JSON of what always is JSON: structs of numbers and text.
fn json(value: &impl Serialize) -> String {
    serde_json::to_string(value).unwrap_or_default()
}
