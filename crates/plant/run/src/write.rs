//! What a run writes on its way: walls, frames, paths, crossings.

use crate::error::{Ended, Result};
use crate::frames::{self, ParticleRows};
use crate::underway::{Before, FrameEnergy, Run, Written};
use crate::walls::{self, Interval};
use dem::setup::KeptContact;
use record::{FRAME, Watermark, json, topic};
use scene::input::history;
use stages::outlet::crossing::CrossingRow;
use stages::outlet::path::PathRow;
use stages::outlet::{bond, contact, crossing, path};
use std::io::Write;

/// Particles up to which a run holds the state of the last step that was written, to go back to: twice its memory. A larger run goes
/// back to the last checkpoint in its file.
const HELD: usize = 500_000;
/// Contact histories in one message: those of a large run together would be the most memory that it ever takes.
const HISTORIES: usize = 1 << 18;
/// Samples of paths that are held before they are written.
const SAMPLES_HELD: usize = 4096;

impl<W: Write> Run<W> {
    pub(crate) fn write_walls(&mut self, surfaces: &serde_json::Value, warnings: &[String]) -> Result<()> {
        let now = self.now();
        if let Some(table) = frames::wall_spheres(&self.sim, &self.written.walls) {
            self.writer.points(topic::WALLS, now, FRAME, table)?;
        }
        self.writer.bytes(topic::SURFACES, "json", now, json(surfaces).as_bytes())?;
        if let Some(chosen) = self.outcome.chosen_by.clone() {
            self.note(&chosen)?;
        }
        warnings.iter().try_for_each(|warning| self.note(warning))?;
        Ok(self.writer.flush_chunk()?)
    }

    /// Writes what is due after `step` steps. A run that was resumed does not repeat what it was resumed from.
    pub(crate) fn write_due(&mut self, step: u64) -> Result<(), Ended> {
        let resumed = step == self.first && self.begins_written;
        let (frame, checkpoint) = (self.schedule.is_frame(step), self.schedule.is_checkpoint(step));
        if resumed || frame || checkpoint {
            self.saved_at = self.sim.time();
            let held = self.sim.particle_count() <= HELD;
            let given = || self.supply.given.clone();
            self.before = held.then(|| Before { given: given(), state: self.sim.checkpoint().to_static() });
        }
        if resumed && frame {
            self.drop_sums()?;
        }
        if resumed || !(frame || checkpoint) {
            return Ok(());
        }
        self.write_crossings()?;
        self.write_cracks()?;
        // Before the frame, which computes forces that would then belong to the state.
        if checkpoint {
            self.write_checkpoint()?;
        }
        if frame {
            self.write_frame()?;
        }
        Ok(self.writer.flush_chunk()?)
    }

    /// Drops the sliding work and the sums of walls that the frame of this instant has: its checkpoint was saved before it, so that the first frame of the resumed run would
    /// have them once more.
    fn drop_sums(&mut self) -> Result<(), Ended> {
        let Written { output, wall_forces, .. } = &self.written;
        let (contacts, walls) = (output.contacts, *wall_forces);
        if contacts || walls {
            self.let_in()?;
        }
        if contacts {
            self.sim.record_contacts()?;
        }
        if walls {
            self.sim.take_wall_sums()?;
        }
        Ok(())
    }

    fn write_frame(&mut self) -> Result<(), Ended> {
        // What enters now belongs to this frame.
        self.let_in()?;
        self.sim.ready()?;
        self.write_cracks()?;
        let (now, precision) = (self.now(), self.written.output.precision);
        if self.written.walls_move
            && self.sim.steps() > 0
            && let Some(table) = frames::wall_spheres(&self.sim, &self.written.walls)
        {
            self.writer.points(topic::WALLS, now, FRAME, table)?;
        }
        // Before the particles, which lie in it.
        if let Some(range) = &self.written.domain {
            let message = frames::domain(self.sim.time(), range, self.sim.cell()?.as_ref());
            self.writer.bytes(topic::DOMAIN, "json", now, json(&message).as_bytes())?;
        }
        let clumps = (!self.written.masses.is_empty()).then(|| self.sim.clumps()).transpose()?;
        let (all, clumps_by_id) = (self.sim.snapshot()?, clumps.as_deref());
        let clusters = all.clusters();
        let rows = ParticleRows { all, precision, clumps: clumps_by_id, clusters };
        self.writer.rows(topic::PARTICLES, now, FRAME, &rows)?;
        if let Some(clumps) = clumps {
            self.writer.points(topic::BODIES, now, FRAME, frames::clump_rows(&clumps))?;
        }
        if self.sim.bond_count()[0] > 0 {
            let bonds = self.sim.bonds()?;
            self.writer.points(topic::BONDS, now, FRAME, frames::bonds(&bonds, precision))?;
        }
        if self.written.output.contacts {
            let contacts = self.sim.record_contacts()?;
            self.writer.points(topic::CONTACTS, now, FRAME, frames::contacts(&contacts, precision))?;
        }
        if self.sim.steps() == self.schedule.last {
            let mut kept = self.sim.contact_histories();
            loop {
                let some: Vec<KeptContact> = kept.by_ref().take(HISTORIES).collect();
                if some.is_empty() {
                    break;
                }
                self.writer.points(topic::HISTORY, now, FRAME, history::to_table(&some))?;
            }
        }
        self.outcome.frames += 1;
        self.write_wall_sums()?;
        self.write_settling()?;
        self.write_energy()
    }

    /// Writes what grains have done to walls since the frame before, and their forces of this instant.
    fn write_wall_sums(&mut self) -> Result<(), Ended> {
        if !self.written.wall_forces {
            return Ok(());
        }
        let (now, forces) = (self.now(), self.sim.wall_forces()?);
        let sums = self.sim.take_wall_sums()?;
        let interval =
            Interval { sums: &sums, about: self.sim.wall_references(), slides: self.written.ledger };
        let message = walls::forces(self.sim.time(), &forces, &self.written.walls, Some(&interval));
        self.writer.bytes(topic::WALL_FORCES, "json", now, json(&message).as_bytes())?;
        if self.written.wear {
            let table = walls::wear(&self.sim, &sums, self.written.output.precision);
            self.writer.points(topic::WALL_WEAR, now, FRAME, table)?;
        }
        Ok(())
    }

    /// Writes the ledger, and keeps the energies for progress reports.
    fn write_energy(&mut self) -> Result<(), Ended> {
        let ledger = self.written.output.energy;
        if !ledger && !self.written.watched {
            return Ok(());
        }
        let energy = self.sim.energy()?;
        let kinetic = energy.translation + energy.rotation;
        self.peak = self.peak.max(energy.held());
        self.frame_energy = Some(FrameEnergy { kinetic, balance: ledger.then(|| energy.balance()) });
        if ledger {
            let mut message = serde_json::to_value(energy).unwrap_or_default();
            message["time"] = self.sim.time().into();
            message["balance"] = energy.balance().into();
            self.writer.bytes(topic::ENERGY, "json", self.now(), json(&message).as_bytes())?;
        }
        Ok(())
    }

    /// Samples the paths of particles on their way to storage planes of recorded motion.
    pub(crate) fn sample(&mut self) -> Result<()> {
        let step = self.sim.steps();
        let new = self.sampled.replace(step) != Some(step);
        if new && self.written.sampling.is_some_and(|every| step.is_multiple_of(every)) {
            let (time, masses) = (self.sim.time(), &self.written.masses);
            self.paths.extend(self.sim.sample_paths().iter().map(|s| PathRow::new(time, s, masses)));
            if self.paths.len() >= SAMPLES_HELD {
                self.write_paths()?;
            }
        }
        Ok(())
    }

    fn write_paths(&mut self) -> Result<()> {
        let rows = std::mem::take(&mut self.paths);
        if !rows.is_empty() {
            self.writer.points(topic::PATHS, self.now(), FRAME, path::to_table(&rows))?;
        }
        Ok(())
    }

    /// Writes what broke since the last time, and notes bonds that were due and found no pair. What broke at the instant that a run is resumed from was written
    /// with the frame of that instant, which the end of a run writes whether it is due or not.
    fn write_cracks(&mut self) -> Result<()> {
        let told = if self.cracks_told { self.first as f64 * self.sim.dt() } else { f64::NEG_INFINITY };
        let mut cracks = self.sim.take_cracks();
        cracks.retain(|crack| crack.time > told);
        if !cracks.is_empty() {
            let table = frames::cracks(&cracks, self.written.output.precision);
            self.writer.points(topic::CRACKS, self.now(), FRAME, table)?;
        }
        for [a, b] in self.sim.take_idle_bonds() {
            self.note(&format!("bond {a}–{b}: no two grains were near enough when its bonds were due"))?;
        }
        Ok(())
    }

    pub(crate) fn write_crossings(&mut self) -> Result<()> {
        if !self.written.outlets {
            return Ok(());
        }
        self.write_paths()?;
        let now = self.now();
        let crossings = std::mem::take(&mut self.crossings);
        if !crossings.is_empty() {
            // Contacts and bonds first: a reader that passes rows on has them then.
            let contacts = contact::of_crossings(&crossings);
            if contacts.rows() > 0 {
                self.writer.points(topic::CROSSING_CONTACTS, now, FRAME, &contacts)?;
            }
            let bonds = bond::of_crossings(&crossings);
            if !bonds.is_empty() {
                self.writer.points(topic::CROSSING_BONDS, now, FRAME, bond::to_table(&bonds))?;
            }
            let masses = &self.written.masses;
            let rows: Vec<CrossingRow> = crossings.iter().map(|c| CrossingRow::new(c, masses)).collect();
            self.writer.points(topic::CROSSINGS, now, FRAME, crossing::to_table(&rows))?;
            self.outcome.crossings += rows.len() as u64;
        }
        let watermark = Watermark { until: self.sim.time() };
        Ok(self.writer.bytes(topic::WATERMARK, "json", now, &watermark.to_json())?)
    }
}
