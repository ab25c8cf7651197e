//! The file of a run that another engine computes: the same head, walls, frames and end as [`crate::run`] writes.

use crate::error::Result;
use crate::frames::{self, ParticleRows, WallHead};
use crate::schedule::Schedule;
use crate::start::{Head, in_file};
use crate::walls;
use dem::setup::{Crossing, Particle, Wall, WallShape};
use dem::{BondState, ClumpState, ContactRecord, Crack, WallForce};
use geom::Vec3;
use record::{FRAME, LogMessage, StopCause, Watermark, json, nanoseconds, topic};
use scene::keys::Precision;
use scene::{Plan, Scene};
use stages::outlet::crossing::{self, CrossingRow};
use std::io::Write;
use stream::mcap::{Provenance, StreamOptions, Writer};

/// A run file in the making.
pub struct RunFile<W: Write> {
    writer: Writer<W>,
    heads: Vec<WallHead>,
    walls: Vec<Wall>,
    walls_move: bool,
    precision: Precision,
    clusters: Vec<(u32, u32)>,
    /// Whether the scene has clumps.
    clumps: bool,
    /// Frames written.
    pub frames: u64,
}

impl<W: Write> RunFile<W> {
    /// Begins the file of a scene that runs by a schedule: metadata, walls, and the warnings of the plan.
    ///
    /// # Errors
    /// A scene whose head cannot be written, a write that fails.
    pub fn begin(
        scene: &Scene,
        plan: &Plan,
        schedule: &Schedule,
        out: W,
        provenance: &Provenance,
        how: StreamOptions<W>,
    ) -> Result<RunFile<W>> {
        let setup = &plan.setup;
        let head = Head::new(scene, setup, plan.sizes)?;
        let mut writer = Writer::compressed(out, provenance, how)?;
        for (name, record) in head.records([schedule.dt, 0.0], schedule, None) {
            writer.metadata(name, record)?;
        }
        let spheres_move = |w: &Wall| matches!(w.shape, WallShape::Spheres(_)) && w.moves();
        let mut file = RunFile {
            writer,
            heads: frames::heads(setup),
            walls_move: setup.walls.iter().any(spheres_move),
            walls: setup.walls.clone(),
            precision: scene.keys.output.precision,
            clusters: setup.clusters.clone(),
            clumps: !setup.clumps.shapes.is_empty(),
            frames: 0,
        };
        file.write_walls(0.0)?;
        let surfaces = frames::surfaces(&setup.walls);
        file.writer.bytes(topic::SURFACES, "json", 0, json(&surfaces).as_bytes())?;
        let chosen = plan.step.iter().cloned();
        let warnings = plan.warnings.iter().map(|text| in_file(scene, text));
        chosen.chain(warnings).try_for_each(|text| file.note(0.0, &text))?;
        file.writer.flush_chunk()?;
        Ok(file)
    }

    /// Writes wall spheres as they are at a time [s].
    fn write_walls(&mut self, time: f64) -> Result<()> {
        let spheres = |index: usize| -> Vec<(Vec3, f64)> {
            let wall = &self.walls[index];
            let pose = wall.motion.pose(time);
            match &wall.shape {
                WallShape::Spheres(all) => all.iter().map(|(c, r)| (pose.position(c), *r)).collect(),
                _ => Vec::new(),
            }
        };
        match frames::wall_table(&self.heads, spheres) {
            Some(table) => Ok(self.writer.points(topic::WALLS, nanoseconds(time), FRAME, table)?),
            None => Ok(()),
        }
    }

    /// Writes a frame, and sends it on; `clumps` by id.
    ///
    /// # Errors
    /// A write that fails.
    pub fn frame(&mut self, time: f64, particles: &[Particle], clumps: &[ClumpState]) -> Result<()> {
        if self.walls_move && time > 0.0 {
            self.write_walls(time)?;
        }
        let (precision, clusters) = (self.precision, &self.clusters[..]);
        let rows =
            ParticleRows { all: particles, precision, clumps: self.clumps.then_some(clumps), clusters };
        self.writer.rows(topic::PARTICLES, nanoseconds(time), FRAME, &rows)?;
        if self.clumps {
            self.writer.points(topic::BODIES, nanoseconds(time), FRAME, frames::clump_rows(clumps))?;
        }
        self.frames += 1;
        Ok(self.writer.flush_chunk()?)
    }

    /// Writes the contacts of the last frame.
    ///
    /// # Errors
    /// A write that fails.
    pub fn contacts(&mut self, time: f64, contacts: &[ContactRecord]) -> Result<()> {
        let table = frames::contacts(contacts, self.precision);
        self.writer.points(topic::CONTACTS, nanoseconds(time), FRAME, table)?;
        Ok(self.writer.flush_chunk()?)
    }

    /// Writes the bonds of the last frame, if there are any.
    ///
    /// # Errors
    /// A write that fails.
    pub fn bonds(&mut self, time: f64, bonds: &[BondState]) -> Result<()> {
        if bonds.is_empty() {
            return Ok(());
        }
        let table = frames::bonds(bonds, self.precision);
        self.writer.points(topic::BONDS, nanoseconds(time), FRAME, table)?;
        Ok(self.writer.flush_chunk()?)
    }

    /// Writes bonds that broke, if any did, before the frame that shows it.
    ///
    /// # Errors
    /// A write that fails.
    pub fn cracks(&mut self, time: f64, cracks: &[Crack]) -> Result<()> {
        if cracks.is_empty() {
            return Ok(());
        }
        let table = frames::cracks(cracks, self.precision);
        Ok(self.writer.points(topic::CRACKS, nanoseconds(time), FRAME, table)?)
    }

    /// Writes the forces on walls at the last frame.
    ///
    /// # Errors
    /// A write that fails.
    pub fn wall_forces(&mut self, time: f64, forces: &[WallForce]) -> Result<()> {
        let message = walls::forces(time, forces, &self.heads, None);
        self.writer.bytes(topic::WALL_FORCES, "json", nanoseconds(time), json(&message).as_bytes())?;
        Ok(self.writer.flush_chunk()?)
    }

    /// Writes crossings of storage planes, and that no more come before a time [s].
    ///
    /// # Errors
    /// A write that fails.
    pub fn crossings(&mut self, until: f64, crossings: &[Crossing]) -> Result<()> {
        let now = nanoseconds(until);
        if !crossings.is_empty() {
            let rows: Vec<CrossingRow> = crossings.iter().map(|c| CrossingRow::new(c, &[])).collect();
            self.writer.points(topic::CROSSINGS, now, FRAME, crossing::to_table(&rows))?;
        }
        let watermark = Watermark { until };
        self.writer.bytes(topic::WATERMARK, "json", now, &watermark.to_json())?;
        Ok(self.writer.flush_chunk()?)
    }

    /// Writes a note to the log.
    ///
    /// # Errors
    /// A write that fails.
    pub fn note(&mut self, time: f64, text: &str) -> Result<()> {
        self.log(&LogMessage::note(time, text))
    }

    /// Writes why the run was stopped.
    ///
    /// # Errors
    /// A write that fails.
    pub fn stopped(&mut self, time: f64, reason: &str, cause: StopCause) -> Result<()> {
        self.log(&LogMessage::stopped(time, reason, cause))
    }

    fn log(&mut self, message: &LogMessage) -> Result<()> {
        let time = nanoseconds(message.time);
        Ok(self.writer.bytes(topic::LOG, "json", time, json(message).as_bytes())?)
    }

    /// Ends the file and gives the output back.
    ///
    /// # Errors
    /// A write that fails.
    pub fn finish(self) -> Result<W> {
        Ok(self.writer.finish()?)
    }
}
