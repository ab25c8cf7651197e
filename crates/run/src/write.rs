//! What a run writes on its way: walls, frames, paths, crossings.

use super::{
    BODIES, BONDS, CONTACTS, ENERGY, FRAME, HELD, PARTICLES, Run, RunError, SAMPLES_HELD, SURFACES,
    WALL_FORCES, WALLS, json,
};
use crate::crossings::{self, CROSSINGS, Passage, WATERMARK, Watermark};
use crate::frames::{self, ParticleRows};
use crate::links::{self, LINKS};
use crate::paths::{self, PATHS, Waypoint};
use crate::touches::{self, TOUCHES};
use dem::Halt;
use std::io::Write;

/// What ends a look before it is whole.
pub(super) enum Ended {
    /// A guard of the engine.
    Guard(Halt),
    /// An input or an output.
    Failed(RunError),
}

impl From<Halt> for Ended {
    fn from(halt: Halt) -> Ended {
        Ended::Guard(halt)
    }
}

impl<E: Into<RunError>> From<E> for Ended {
    fn from(error: E) -> Ended {
        Ended::Failed(error.into())
    }
}

impl<W: Write> Run<W> {
    pub(super) fn write_walls(
        &mut self,
        surfaces: &serde_json::Value,
        notes: &[String],
    ) -> Result<(), RunError> {
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

    /// Writes what is due after `step` steps. A run that was resumed does not repeat what it was resumed from.
    pub(super) fn look(&mut self, step: u64, first: u64) -> Result<(), Ended> {
        let resumed = step == first && step > 0;
        let (frame, checkpoint) = (self.schedule.is_frame(step), self.schedule.is_checkpoint(step));
        if resumed || frame || checkpoint {
            self.looked_at = self.sim.time();
            let held = self.sim.particle_count() <= HELD;
            self.before = held.then(|| (self.supply.given.clone(), self.sim.state().to_state()));
        }
        if resumed || !(frame || checkpoint) {
            return Ok(());
        }
        self.write_crossings()?;
        // Before the frame: looking computes loads, which would then belong to the state.
        if checkpoint {
            self.write_checkpoint()?;
        }
        if frame {
            self.write_frame()?;
        }
        Ok(self.writer.flush_chunk()?)
    }

    fn write_frame(&mut self) -> Result<(), Ended> {
        // What enters now belongs to this instant.
        self.feed()?;
        self.sim.ready()?;
        let now = self.now();
        if self.moving
            && self.sim.steps() > 0
            && let Some(table) = frames::wall_spheres(&self.sim, &self.walls)
        {
            self.writer.points(WALLS, now, FRAME, table)?;
        }
        let bodies = self.clumps.then(|| self.sim.bodies()).transpose()?;
        let (all, precision) = (self.sim.snapshot()?, self.precision);
        let rows = ParticleRows { all, precision, bodies: bodies.as_deref() };
        self.writer.rows(PARTICLES, now, FRAME, &rows)?;
        if let Some(bodies) = bodies {
            self.writer.points(BODIES, now, FRAME, frames::bodies(&bodies))?;
        }
        if self.sim.bond_count()[0] > 0 {
            let bonds = self.sim.bonds()?;
            self.writer.points(BONDS, now, FRAME, frames::bonds(&bonds, self.precision))?;
        }
        if self.contacts {
            let contacts = self.sim.record_contacts()?;
            self.writer.points(CONTACTS, now, FRAME, frames::contacts(&contacts, self.precision))?;
        }
        self.outcome.frames += 1;
        if self.wall_forces {
            let forces = self.sim.wall_forces()?;
            let message = frames::wall_forces(self.sim.time(), &forces, &self.walls);
            self.writer.bytes(WALL_FORCES, "json", now, json(&message).as_bytes())?;
        }
        self.write_energy()
    }

    /// The ledger, and what those who watch hear of it.
    fn write_energy(&mut self) -> Result<(), Ended> {
        if !self.energy && !self.watched {
            return Ok(());
        }
        let energy = self.sim.energy()?;
        self.looked = Some((energy.translation + energy.rotation, self.energy.then(|| energy.balance())));
        if self.energy {
            let mut message = serde_json::to_value(energy).unwrap_or_default();
            message["time"] = self.sim.time().into();
            message["balance"] = energy.balance().into();
            self.writer.bytes(ENERGY, "json", self.now(), json(&message).as_bytes())?;
        }
        Ok(())
    }

    /// Notes where grains are on their way to storage planes of recorded motion.
    pub(super) fn sample(&mut self) -> Result<(), RunError> {
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

    pub(super) fn write_crossings(&mut self) -> Result<(), RunError> {
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
}
