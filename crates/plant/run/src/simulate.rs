//! The loop of a run; `write.rs` writes what is due between its steps.

use crate::checkpoint::Checkpoint;
use crate::error::{Ended, Result};
use crate::fallen::Fallen;
use crate::integration::IntegrationError;
use crate::progress::Progress;
use crate::schedule::Schedule;
use crate::servos::ServoHeld;
use crate::settling::{self};
use crate::start::not_yet_over;
use crate::stop::Stopping;
use crate::underway::{Outcome, Run, Settings};
use dem::Halt;
use record::{LogMessage, json, nanoseconds, topic};
use scene::{Plan, Scene};
use stages::inlet::Arrival;
use std::io::Write;

/// Steps between searches for particles that zones have lost: in so few, no particle gets past the length of a zone.
const LOOK_BACK: u64 = 64;
/// Steps between reports of progress, or more where a device makes many at once.
const REPORT_EVERY: u64 = 256;
/// Steps that a device makes at once, at most.
const AT_ONCE: u64 = 1 << 16;

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
        if last || step / REPORT_EVERY != reported || wrote {
            report(&run.progress());
            reported = step / REPORT_EVERY;
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
        let outcome = run.step(step, stop, report);
        // Many steps at once: what the last of them would have let in is in the checkpoint, too.
        let last_begun = run.sim.last_begun();
        if last_begun > step {
            match run.let_in_by(last_begun as f64 * run.sim.dt()) {
                Err(_) if stop() => break Some(Stopping::signal()),
                other => other?,
            }
        }
        if let Err(halt) = outcome {
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
        let due = (step + 1..most).find(due).unwrap_or(most);
        if !self.sim.looks_back(due) {
            return due;
        }
        // Right after a step that is followed by a search, and before the next one.
        let search = step.next_multiple_of(LOOK_BACK).max(step + 1);
        due.min(search)
    }

    /// Lets in everything that the next step must know.
    pub(crate) fn let_in(&mut self) -> Result<()> {
        self.let_in_by(self.sim.time())
    }

    /// Lets in everything that a step at `time` [s] must know.
    fn let_in_by(&mut self, time: f64) -> Result<()> {
        // Where particles follow recorded paths, the next sample of each must be known.
        let horizon = time + self.sim.look_ahead() + self.supply.samples();
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
        let lines: Vec<String> = line
            .into_iter()
            .chain(servos)
            .chain(fallen)
            .chain(crate::removals(&self.outcome.returned))
            .collect();
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
        let skipped = outcome.returned.inserts.iter().map(|insert| insert.skipped).sum::<u64>();
        outcome.entered = supply.entered.saturating_sub(skipped + sim.still_to_come());
        Ok((outcome, writer.finish()?))
    }
}
