//! The run: steps, frames, crossings, checkpoints.

use crate::checkpoint::{Checkpoint, Pieces};
use crate::crossings::{self, CROSSINGS, ONLY_CLUMPS, Passage, SIZES, WATERMARK, Watermark};
use crate::error::SceneError;
use crate::feeds::{Item, Supply};
use crate::frames::{self, WallHead};
use crate::gate::Gate;
use crate::links::{self, LINKS};
use crate::material_info::{self, MATERIALS};
use crate::model::Precision;
use crate::moment::Moment;
use crate::paths::{self, PATHS, Waypoint};
use crate::schedule::{Schedule, nanoseconds};
use crate::touches::{self, TOUCHES};
use crate::{Plan, Scene, input::SCENE};
use dem::setup::{Crossing, ZoneMotion};
use dem::{Halt, SetupError, Simulation};
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::Write;
use stream::mcap::{Compression, McapError, Provenance, Writer};
use thiserror::Error;

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
pub struct Settings {
    /// What made it.
    pub provenance: Provenance,
    /// How chunks are packed.
    pub compression: Compression,
    /// Whether the energy of each frame is computed for who hears of progress.
    pub watched: bool,
    /// Asked between steps: whether the run is to end here, with a checkpoint.
    pub stop: fn() -> bool,
}

/// Refuses what would only be refused after the output was opened.
///
/// # Errors
/// What the engine refuses, an end that is missing.
pub fn ready(scene: &Scene, plan: &Plan) -> Result<(), RunError> {
    let limit = dem::critical_step(&plan.setup)?;
    let dt = match plan.setup.step {
        dem::setup::Step::Auto(share) => share * limit.dt,
        dem::setup::Step::Fixed(dt) if dt > limit.dt => {
            return Err(SetupError::StepTooLarge { dt, critical: limit.dt, pair: limit.pair }.into());
        }
        dem::setup::Step::Fixed(dt) => dt,
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
    settings: Settings,
    progress: &mut dyn FnMut(&Moment),
) -> Result<(Outcome, W), RunError> {
    let (stop, watched) = (settings.stop, settings.watched);
    let mut run = Run::start(scene, plan, resume, out, settings)?;
    run.watched = watched;
    let first = run.sim.steps();
    let reason = loop {
        let step = run.sim.steps();
        run.sample()?;
        if let Err(halt) = run.look(step, first)? {
            break Some(stopped(scene, step, halt)?);
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
    for note in crate::returned::words(&run.outcome.returned) {
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
    fn start(
        scene: &Scene,
        plan: Plan,
        resume: Option<Checkpoint>,
        out: W,
        settings: Settings,
    ) -> Result<Run<W>, RunError> {
        let mut supply = Supply::new(plan.feeds);
        if let Some(saved) = &resume {
            saved.fits(&scene.text.toml, &plan.inputs)?;
            supply.skip(&saved.given)?;
        }
        let walls = frames::heads(&plan.setup);
        let surfaces = frames::surfaces(&plan.setup.walls);
        let materials = material_info::to_map(&plan.setup.materials);
        let (zones, gravity) = (plan.setup.outlets.clone(), plan.setup.gravity);
        let moving = spheres_move(&plan.setup.walls);
        let shapes = frames::clumps(&plan.setup.clumps);
        let clumps = !shapes.is_empty();
        let only_clumps = clumps && plan.setup.particles.is_empty() && plan.setup.entry_materials.is_empty();
        let density = |m: u16| plan.setup.materials[m as usize].density;
        let masses = plan.setup.clumps.shapes.iter().map(|s| s.mass(1.0, density(s.material))).collect();
        let follows = plan.setup.walls.iter().any(|w| w.motion.servo.is_some());
        let wall_forces = scene.model.output.wall_forces || follows;
        let recorded = scene.model.output.contacts || wall_forces;
        // What a stage downstream has to know of them.
        let bonds = if zones.is_empty() { None } else { dem::bonds_of(&plan.setup)? };
        let mut sim = match resume {
            Some(saved) => Simulation::resume(plan.setup, saved.state)?,
            None => Simulation::new(plan.setup)?,
        };
        sim.record_loads(recorded);
        let schedule = Schedule::new(scene, sim.dt())?;
        if sim.steps() >= schedule.last {
            let why = format!(
                "the saved run has reached {} s, the scene ends at {} s",
                geom::Shown(sim.time()),
                geom::Shown(schedule.last as f64 * schedule.dt)
            );
            return Err(SceneError::file("--resume", why, "give a later --until").into());
        }
        let sampling = sampling(scene, sim.dt())?;
        let sampled = Some(sim.steps()).filter(|step| *step > 0);
        let every = sampling.map(|steps| steps as f64 * sim.dt());
        let gate = |(i, zone): (usize, &dem::setup::Zone)| {
            let plant = scene.model.outlet.get(i).and_then(|o| o.plant.clone());
            let samples = every.filter(|_| zone.motion == ZoneMotion::Recorded);
            let gate = Gate { zone: *zone, gravity: Some(gravity), plant, samples };
            (i.to_string(), json(&gate))
        };
        let outlets: Record = zones.iter().enumerate().map(gate).collect();
        let mut writer = Writer::compressed(out, &settings.provenance, settings.compression)?;
        for (name, mut record) in records(scene, &schedule, &sim, materials, plan.sizes, &outlets) {
            if name == SIZES && only_clumps {
                record.insert(ONLY_CLUMPS.to_owned(), "true".to_owned());
            }
            writer.metadata(name, record)?;
        }
        if clumps {
            writer.metadata(CLUMPS, shapes)?;
        }
        if let Some(bonds) = bonds {
            writer.metadata(links::BONDS, links::to_map(&bonds))?;
        }
        let mut run = Run {
            outcome: Outcome { dt: sim.dt(), chosen_by: plan.step, ..Outcome::default() },
            sim,
            supply,
            writer,
            schedule,
            scene: scene.text.toml.clone(),
            inputs: plan.inputs,
            walls,
            moving,
            outlets: !outlets.is_empty(),
            clumps,
            masses,
            energy: scene.model.output.energy,
            contacts: scene.model.output.contacts,
            wall_forces,
            precision: scene.model.output.precision,
            crossings: Vec::new(),
            sampling,
            sampled,
            paths: Vec::new(),
            looked: None,
            watched: false,
            before: None,
            looked_at: 0.0,
            checkpoints: 0,
        };
        run.write_walls(&surfaces, &plan.notes)?;
        Ok(run)
    }

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

    fn write_walls(&mut self, surfaces: &serde_json::Value, notes: &[String]) -> Result<(), RunError> {
        let now = self.now();
        if let Some(table) = frames::wall_spheres(&self.sim, &self.walls) {
            self.writer.points(WALLS, now, FRAME, table)?;
        }
        self.writer.bytes(SURFACES, "json", now, json(surfaces).as_bytes())?;
        if let Some(chosen) = self.outcome.chosen_by.clone() {
            self.log("note", &chosen)?;
        }
        for note in notes {
            self.log("note", note)?;
        }
        Ok(self.writer.flush_chunk()?)
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

    /// Writes what is due after `step` steps. A run that was resumed does not repeat what it was resumed from.
    fn look(&mut self, step: u64, first: u64) -> Result<Result<(), Halt>, RunError> {
        let resumed = step == first && step > 0;
        let (frame, checkpoint) = (self.schedule.is_frame(step), self.schedule.is_checkpoint(step));
        if resumed || frame || checkpoint {
            self.looked_at = self.sim.time();
            let held = self.sim.particle_count() <= HELD;
            self.before = held.then(|| (self.supply.given.clone(), self.sim.state().to_state()));
        }
        if resumed || !(frame || checkpoint) {
            return Ok(Ok(()));
        }
        self.write_crossings()?;
        // Before the frame: looking computes loads, which would then belong to the state.
        if checkpoint {
            self.write_checkpoint()?;
        }
        if frame && let Err(halt) = self.write_frame()? {
            return Ok(Err(halt));
        }
        self.writer.flush_chunk()?;
        Ok(Ok(()))
    }

    fn write_frame(&mut self) -> Result<Result<(), Halt>, RunError> {
        // What enters now belongs to this instant.
        self.feed()?;
        let particles = match self.sim.particles() {
            Ok(particles) => particles,
            Err(halt) => return Ok(Err(halt)),
        };
        let now = self.now();
        if self.moving
            && self.sim.steps() > 0
            && let Some(table) = frames::wall_spheres(&self.sim, &self.walls)
        {
            self.writer.points(WALLS, now, FRAME, table)?;
        }
        let bodies = match self.clumps.then(|| self.sim.bodies()).transpose() {
            Ok(bodies) => bodies,
            Err(halt) => return Ok(Err(halt)),
        };
        let table = frames::particles(&particles, self.precision, bodies.as_deref());
        // A large run has little room for both.
        drop(particles);
        self.writer.points(PARTICLES, now, FRAME, table)?;
        if let Some(bodies) = bodies {
            self.writer.points(BODIES, now, FRAME, frames::bodies(&bodies))?;
        }
        if self.sim.bond_count()[0] > 0 {
            let bonds = match self.sim.bonds() {
                Ok(bonds) => bonds,
                Err(halt) => return Ok(Err(halt)),
            };
            self.writer.points(BONDS, now, FRAME, frames::bonds(&bonds, self.precision))?;
        }
        if self.contacts {
            let contacts = match self.sim.record_contacts() {
                Ok(contacts) => contacts,
                Err(halt) => return Ok(Err(halt)),
            };
            self.writer.points(CONTACTS, now, FRAME, frames::contacts(&contacts, self.precision))?;
        }
        self.outcome.frames += 1;
        if self.wall_forces {
            let forces = match self.sim.wall_forces() {
                Ok(forces) => forces,
                Err(halt) => return Ok(Err(halt)),
            };
            let message = frames::wall_forces(self.sim.time(), &forces, &self.walls);
            self.writer.bytes(WALL_FORCES, "json", now, json(&message).as_bytes())?;
        }
        if self.energy || self.watched {
            let energy = match self.sim.energy() {
                Ok(energy) => energy,
                Err(halt) => return Ok(Err(halt)),
            };
            self.looked = Some((energy.translation + energy.rotation, self.energy.then(|| energy.balance())));
            if !self.energy {
                return Ok(Ok(()));
            }
            let mut message = serde_json::to_value(energy).unwrap_or_default();
            message["time"] = self.sim.time().into();
            message["balance"] = energy.balance().into();
            self.writer.bytes(ENERGY, "json", now, json(&message).as_bytes())?;
        }
        Ok(Ok(()))
    }

    /// Notes where grains are on their way to storage planes of recorded motion.
    fn sample(&mut self) -> Result<(), RunError> {
        let step = self.sim.steps();
        let new = self.sampled.replace(step) != Some(step);
        if new && self.sampling.is_some_and(|every| step.is_multiple_of(every)) {
            let time = self.sim.time();
            self.paths.extend(self.sim.sample_paths().iter().map(|s| Waypoint::new(time, s, &self.masses)));
            if self.paths.len() >= SAMPLES_HELD {
                self.write_paths()?;
            }
        }
        Ok(())
    }

    fn write_paths(&mut self) -> Result<(), RunError> {
        let rows = std::mem::take(&mut self.paths);
        if !rows.is_empty() {
            self.writer.points(PATHS, self.now(), FRAME, paths::to_table(&rows))?;
        }
        Ok(())
    }

    fn write_crossings(&mut self) -> Result<(), RunError> {
        if !self.outlets {
            return Ok(());
        }
        self.write_paths()?;
        let now = self.now();
        let crossings = std::mem::take(&mut self.crossings);
        if !crossings.is_empty() {
            // Contacts first: who passes rows on has them then.
            let touches = touches::of_crossings(&crossings);
            if touches.rows() > 0 {
                self.writer.points(TOUCHES, now, FRAME, &touches)?;
            }
            let links = links::of_crossings(&crossings);
            if !links.is_empty() {
                self.writer.points(LINKS, now, FRAME, links::to_table(&links))?;
            }
            let rows: Vec<Passage> = crossings.iter().map(|c| Passage::new(c, &self.masses)).collect();
            self.writer.points(CROSSINGS, now, FRAME, crossings::to_table(&rows))?;
            self.outcome.crossings += rows.len() as u64;
        }
        let watermark = Watermark { until: self.sim.time() };
        Ok(self.writer.bytes(WATERMARK, "json", now, &watermark.to_json())?)
    }

    fn write_checkpoint(&mut self) -> Result<(), RunError> {
        let checkpoint = Checkpoint {
            scene: self.scene.clone(),
            inputs: self.inputs.clone(),
            given: self.supply.given.clone(),
            state: self.sim.state(),
        };
        let now = nanoseconds(self.sim.time());
        save(&mut self.writer, now, &checkpoint)?;
        self.checkpoints += 1;
        Ok(())
    }

    /// The run is stopped: the file says why, and ends in a checkpoint.
    fn stop(&mut self, reason: String) -> Result<(), RunError> {
        match self.before.take() {
            Some(before) if !self.sim.is_finite() => self.go_back(reason, before),
            None if !self.sim.is_finite() => {
                let reason = format!(
                    "{reason}; nothing can go on from here: --resume goes on from the checkpoint before it (output.checkpoint)"
                );
                self.log("stopped", &reason)?;
                self.outcome.stopped = Some(reason);
                Ok(())
            }
            _ => {
                // What is saved was looked at: the run that goes on does not look again.
                self.sample()?;
                self.write_crossings()?;
                self.log("stopped", &reason)?;
                self.write_checkpoint()?;
                self.outcome.stopped = Some(reason);
                Ok(())
            }
        }
    }

    /// A state without numbers is no use to anyone: the checkpoint is that of the last instant that was looked at. What has
    /// crossed since then crosses again.
    fn go_back(&mut self, reason: String, before: (Vec<u64>, dem::State)) -> Result<(), RunError> {
        let (given, state) = before;
        let time = state.time();
        let reason = format!("{reason}; the checkpoint is of t = {time:.6e} s, before it");
        self.log("stopped", &reason)?;
        let (scene, inputs) = (self.scene.clone(), self.inputs.clone());
        save(&mut self.writer, nanoseconds(time), &Checkpoint { scene, inputs, given, state })?;
        self.outcome.stopped = Some(reason);
        Ok(())
    }
}

/// Writes a checkpoint.
fn save<W: Write>(writer: &mut Writer<W>, now: u64, checkpoint: &impl Serialize) -> Result<(), RunError> {
    let mut pieces = Pieces::new(writer, now);
    stream::state::encode_to(checkpoint, &mut pieces)?;
    Ok(pieces.finish()?)
}

type Record = BTreeMap<String, String>;

/// The metadata of a run: scene, materials, sizes, times, outlets.
fn records(
    scene: &Scene,
    schedule: &Schedule,
    sim: &Simulation,
    materials: Record,
    sizes: Option<crossings::Sizes>,
    outlets: &Record,
) -> Vec<(&'static str, Record)> {
    let times = [("dt", sim.dt()), ("start", sim.time()), ("end", schedule.last as f64 * schedule.dt)];
    let times = times.iter().map(|(k, v)| ((*k).to_owned(), v.to_string())).collect();
    let mut records = vec![
        (SCENE, Record::from([("toml".to_owned(), scene.text.toml.clone())])),
        (MATERIALS, materials),
        ("time", times),
    ];
    records.extend(sizes.map(|s| (SIZES, s.to_map())));
    if !outlets.is_empty() {
        records.push((OUTLETS, outlets.clone()));
    }
    records
}

/// Steps between samples of paths, where an outlet records them.
fn sampling(scene: &Scene, dt: f64) -> Result<Option<u64>, SceneError> {
    let mut least = None;
    for (i, outlet) in scene.model.outlet.iter().enumerate().filter(|(_, o)| o.motion == ZoneMotion::Recorded)
    {
        let steps = outlet.samples.map_or(paths::STEPS, |time| (time / dt).round().max(1.0));
        if steps > paths::MOST_STEPS {
            let check = crate::check::Check { text: &scene.text };
            let most = geom::Shown(paths::MOST_STEPS * dt);
            let value = format!("{} s", geom::Shown(outlet.samples.unwrap_or(0.0)));
            let (why, cure) =
                (format!("is more than {} steps", paths::MOST_STEPS), format!("use at most {most} s"));
            return Err(check.wrong(&format!("outlet.{i}.samples"), value, &why, &cure));
        }
        let steps = steps as u64;
        least = Some(least.map_or(steps, |other: u64| other.min(steps)));
    }
    Ok(least)
}

/// Whether wall spheres move, so that they are written with every frame.
fn spheres_move(walls: &[dem::setup::Wall]) -> bool {
    walls.iter().any(|w| matches!(w.shape, dem::setup::WallShape::Spheres(_)) && w.motion.moves())
}

/// JSON of what always is JSON: structs of numbers and text.
fn json(value: &impl Serialize) -> String {
    serde_json::to_string(value).unwrap_or_default()
}
