//! The run: steps, and what is written between them.

use crate::checkpoint::Checkpoint;
use crate::earlier::Earlier;
use crate::error::{Ended, Result};
use crate::fallen::Fallen;
use crate::frames::WallHead;
use crate::integration::IntegrationError;
use crate::progress::Progress;
use crate::schedule::Schedule;
use crate::servos::ServoHeld;
use crate::settling::{self, Settling};
use crate::start::not_yet_over;
use crate::stop::Stopping;
use crate::supply::Supply;
use dem::device::Device;
use dem::setup::Crossing;
use dem::{Halt, Simulation};
use record::{LogMessage, StopCause, json, nanoseconds, topic};
use scene::keys::Output;
use scene::{Below, Plan, Scene};
use serde::Serialize;
use stages::inlet::Arrival;
use stages::outlet::path::PathRow;
use std::io::Write;
use stream::mcap::{Provenance, StreamOptions, Writer};

/// Steps between searches for particles that zones have lost: in so few, no particle gets past the length of a zone.
const LOOK_BACK: u64 = 64;
/// Steps between reports of progress, or more where a device makes many at once.
const REPORTED: u64 = 256;
/// Steps that a device makes at once, at most.
const AT_ONCE: u64 = 1 << 16;

/// What was done.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Outcome {
    /// Why the run was stopped, as its log has it.
    pub stopped: Option<String>,
    /// What stopped the run, and the sentence about it without its time.
    #[serde(skip)]
    pub stop: Option<(StopCause, String)>,
    /// The guard that has stopped it.
    #[serde(skip)]
    pub halt: Option<Halt>,
    /// Why the run ended before its last step: the grains have come to rest.
    pub settled: Option<String>,
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
    /// Particles that crossed a storage plane.
    pub crossings: u64,
    /// Particles that went back through planes.
    pub returned: dem::Returned,
    /// Warnings about records that ended before the run.
    pub inflow: Vec<String>,
    /// Energy that the finite time step created, where the ledger is kept.
    pub integration: Option<IntegrationError>,
    /// How well servos held what they follow.
    pub servos: Vec<ServoHeld>,
    /// Contacts listed at the end.
    pub listed_contacts: usize,
    /// How often neighbour lists were rebuilt.
    pub listings: u64,
    /// Bonds at the start, and those that broke until the end.
    pub bonds: [usize; 2],
    /// Particles that sleep at the end.
    pub asleep: usize,
    /// Particles that have fallen past all walls.
    pub fallen: Option<Fallen>,
    /// Effects in force: name, pair, key.
    pub effects: Vec<String>,
    /// What made the steps, where this processor did not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub device: Option<String>,
}

/// How a run is written.
pub struct Settings<W> {
    /// What made the run.
    pub provenance: Provenance,
    /// How its file is written.
    pub how: StreamOptions<W>,
    /// The state that it goes on from; `None`: t = 0.
    pub resume: Option<Checkpoint>,
    /// What the run that goes on has written, to be written again; `None`: the file begins with the checkpoint.
    pub earlier: Option<Earlier>,
    /// Whether the energy of each frame is computed for progress reports.
    pub watched: bool,
    /// Called between steps: whether the run is to end here, with a checkpoint.
    pub stop: fn() -> bool,
    /// What makes the steps; `None`: this processor.
    pub device: Option<Box<dyn Device>>,
}

/// Refuses what would only be refused after the output was opened.
///
/// # Errors
/// What the engine refuses, an end that is missing, a checkpoint of another scene or of one that is over.
pub fn ready(scene: &Scene, plan: &Plan, resume: Option<&Checkpoint>) -> Result<()> {
    let Some(saved) = resume else {
        Schedule::new(scene, dem::time_step(&plan.setup)?)?;
        return Ok(());
    };
    saved.fits(&scene.text.toml, &plan.inputs)?;
    // Its step was checked when the run began; a guard that has changed since does not matter.
    let schedule = Schedule::new(scene, saved.state.dt())?;
    Ok(not_yet_over(saved.state.steps(), &schedule)?)
}

/// What of a scene and its setup decides what is written.
pub(crate) struct Written {
    /// Text of the scene.
    pub scene: String,
    /// Role and SHA-256 of its inputs.
    pub inputs: Vec<(String, String)>,
    pub walls: Vec<WallHead>,
    /// Whether wall spheres move, so that they are written with every frame.
    pub walls_move: bool,
    pub outlets: bool,
    /// Masses of clumps at scale 1 [kg]; empty where the scene has no clump.
    pub masses: Vec<f64>,
    /// As the scene asks for it.
    pub output: Output,
    /// Whether forces on walls are written: as the scene asks for it, and where a wall has a servo.
    pub wall_forces: bool,
    /// The periodic domain at the start, where a run cannot be read by its scene alone.
    pub domain: Option<[Option<(f64, f64)>; 3]>,
    /// How far walls reach, where particles can fall past them.
    pub below: Option<Below>,
    /// Steps between samples of paths, where any are recorded.
    pub sampling: Option<u64>,
    /// Whether the energy of each frame is computed for progress reports.
    pub watched: bool,
    /// Whether the energy ledger is kept.
    pub ledger: bool,
    /// At what the run ends before its last step.
    pub settling: Settling,
}

/// A state to go back to: what the sources had given, and the engine.
pub(crate) struct Before {
    pub given: Vec<u64>,
    pub state: dem::Checkpoint<'static>,
}

/// Energies of the frame that has just been written [J].
#[derive(Clone, Copy)]
pub(crate) struct FrameEnergy {
    pub kinetic: f64,
    /// Of the ledger, where it is kept.
    pub balance: Option<f64>,
}

/// A run in progress.
pub(crate) struct Run<W: Write> {
    pub sim: Simulation,
    pub supply: Supply,
    pub writer: Writer<W>,
    pub schedule: Schedule,
    pub written: Written,
    /// Step that the run began with.
    pub first: u64,
    /// Whether what is due in that step was written before the run was resumed.
    pub begins_written: bool,
    /// Whether what broke at that instant is in the file.
    pub cracks_told: bool,
    pub crossings: Vec<Crossing>,
    /// Step of the last sample of paths, or of the checkpoint that was resumed.
    pub sampled: Option<u64>,
    pub paths: Vec<PathRow>,
    pub outcome: Outcome,
    pub frame_energy: Option<FrameEnergy>,
    /// Most energy of motion and springs in a frame so far [J].
    pub peak: f64,
    /// The state when something was last written: a run whose numbers are lost is resumed from there.
    pub before: Option<Before>,
    /// When something was last written [s].
    pub saved_at: f64,
    pub checkpoints: u64,
}

/// Runs a scene to its end, or until a guard or a request stops it, and gives the output back.
///
/// `report` is called with the progress of the run every few steps and with each frame.
///
/// # Errors
/// What the engine refuses, an inlet that breaks off, output that cannot be written.
pub fn run<W: Write>(
    scene: &Scene,
    plan: Plan,
    out: W,
    settings: Settings<W>,
    report: &mut dyn FnMut(&Progress),
) -> Result<(Outcome, W)> {
    let stop = settings.stop;
    let mut run = Run::start(scene, plan, out, settings)?;
    let mut reported = u64::MAX;
    let reason = loop {
        let step = run.sim.steps();
        run.sample()?;
        match run.settle(step).and_then(|()| run.write_due(step)) {
            Err(Ended::Guard(halt)) => break Some(run.halted(scene, halt)?),
            Err(Ended::Failed(error)) => return Err(error),
            Ok(()) => {}
        }
        let last = step >= run.schedule.last;
        // With each frame and checkpoint: what the caller knows to be written decides what it keeps.
        let wrote = run.schedule.is_frame(step) || run.schedule.is_checkpoint(step);
        if last || step / REPORTED != reported || wrote {
            report(&run.progress());
            reported = step / REPORTED;
        }
        if last {
            break None;
        }
        // After the frame: a run that is resumed does not write it again.
        if stop() {
            break Some(Stopping::signal());
        }
        match run.let_in() {
            // The signal also ended the stage upstream; what had come in is in the checkpoint.
            Err(_) if stop() => break Some(Stopping::signal()),
            other => other?,
        }
        if let Err(halt) = run.step(step, stop, report) {
            break Some(run.halted(scene, halt)?);
        }
    };
    run.finish(reason)
}

impl<W: Write> Run<W> {
    /// A step; on a device all up to the next one in which something is due, or until it is asked to `stop`.
    fn step(&mut self, step: u64, stop: fn() -> bool, report: &mut dyn FnMut(&Progress)) -> Result<(), Halt> {
        let outcome = match self.outcome.device {
            None => self.sim.step(),
            Some(_) => {
                let mut so_far = self.progress();
                let (first, dt, due) = (self.first, self.schedule.dt, self.next_due(step));
                self.sim.advance(due, &mut |now| {
                    so_far.reach(now, first, dt);
                    report(&so_far);
                    !stop()
                })
            }
        };
        self.crossings.append(&mut self.sim.take_crossings());
        outcome?;
        if step.is_multiple_of(LOOK_BACK) { self.sim.look_back() } else { Ok(()) }
    }

    /// The next step in which anything but a step is to be done.
    fn next_due(&self, step: u64) -> u64 {
        let most = self.schedule.last.min(step + AT_ONCE);
        let settling = self.written.settling.any();
        let due = |k: &u64| {
            let schedule = &self.schedule;
            schedule.is_frame(*k)
                || schedule.is_checkpoint(*k)
                || settling && k.is_multiple_of(settling::EVERY)
        };
        (step + 1..most).find(due).unwrap_or(most)
    }

    /// Lets in everything that the next step must know.
    pub(crate) fn let_in(&mut self) -> Result<()> {
        // Where particles follow recorded paths, the next sample of each must be known.
        let horizon = self.sim.time() + self.sim.look_ahead() + self.supply.samples();
        while let Some(arrival) = self.supply.next_until(horizon)? {
            match arrival {
                Arrival::Enter(entry) => self.sim.enter(entry)?,
                Arrival::Guide { id, guide, .. } => self.sim.guide(id, guide)?,
                Arrival::History { pair, .. } => self.sim.enter_history(pair),
                Arrival::Bond { bond, .. } => self.sim.enter_bond(bond),
            }
        }
        Ok(())
    }

    /// What the time step made, by the ledger.
    fn integration(&mut self) -> Option<IntegrationError> {
        let energy = self.written.ledger.then(|| self.sim.energy().ok())??;
        IntegrationError::of(&energy, self.peak, self.sim.energy_of_rest())
    }

    pub(crate) fn now(&self) -> u64 {
        nanoseconds(self.sim.time())
    }

    pub(crate) fn log(&mut self, message: &LogMessage) -> Result<()> {
        Ok(self.writer.bytes(topic::LOG, "json", self.now(), json(message).as_bytes())?)
    }

    pub(crate) fn note(&mut self, text: &str) -> Result<()> {
        self.log(&LogMessage::note(self.sim.time(), text))
    }

    /// Writes the end of the file, with the `reason` of a run that was stopped.
    fn finish(mut self, reason: Option<Stopping>) -> Result<(Outcome, W)> {
        self.outcome.integration = self.integration();
        if reason.is_none() {
            self.supply.check_rest()?;
        }
        self.outcome.returned = self.sim.returned().clone();
        self.outcome.inflow = self.supply.ended(self.sim.time());
        self.outcome.servos = ServoHeld::all(&self.sim, &self.written.walls);
        // Where a guard has stopped the run there may be no state to count in.
        let fallen = self.written.below.map(|below| Fallen::count(&mut self.sim, &below));
        self.outcome.fallen = fallen.and_then(|counted| counted.ok().flatten());
        let servos =
            self.outcome.servos.iter().map(|servo| servo.warning().unwrap_or_else(|| servo.to_string()));
        let line = self.outcome.integration.map(|error| error.to_string());
        let fallen = self.outcome.fallen.map(|fallen| fallen.to_string());
        let lines: Vec<String> = line.into_iter().chain(servos).chain(fallen).collect();
        let notes = [crate::warnings(&self.outcome.returned), self.outcome.inflow.clone()].concat();
        notes.into_iter().chain(lines).try_for_each(|note| self.note(&note))?;
        reason.map_or(Ok(()), |reason| self.stop(reason))?;
        let Run { sim, supply, mut outcome, writer, first, .. } = self;
        outcome.steps = sim.steps() - first;
        outcome.time = sim.time();
        outcome.particles = sim.particle_count();
        (outcome.listed_contacts, outcome.asleep) = (sim.listed_contacts(), sim.asleep());
        (outcome.listings, outcome.bonds) = (sim.rebuilds(), sim.bond_count());
        let named =
            |e: &dem::EffectCost| format!("{} ({}–{}): {}", e.effect, e.between.0, e.between.1, e.because);
        outcome.effects = sim.explain().iter().map(named).collect();
        outcome.entered = supply.entered;
        Ok((outcome, writer.finish()?))
    }
}
