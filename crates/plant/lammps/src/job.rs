//! Frames, and crossings between them, on their way from LAMMPS to the run file.

use crate::arrival::Arrival;
use crate::clumps::Tracker;
use crate::deck::Deck;
use crate::dump::{Block, Dump, Ended, Parts};
use crate::error::{LammpsError, Result};
use crate::files::{DUMPS, FRAMES, OF_BONDS, PAIRS, TOUCHES, ZONE};
use crate::folder;
use crate::instant::Now;
use crate::joined::Joined;
use crate::loads::{self, Loads};
use crate::outlet::{Found, Search};
use crate::places::number_of;
use crate::process::{Engine, Place, Running};
use dem::setup::{Particle, Setup};
use geom::{Shown, Vec3};
use nalgebra::{Quaternion, UnitQuaternion};
use record::StopCause;
use run::{Progress, RunFile, Schedule};
use std::collections::{BTreeMap, HashSet};
use std::io::{BufReader, Write};
use std::os::unix::process::ExitStatusExt;
use std::process::ExitStatus;
use std::sync::{Mutex, PoisonError};

/// What is wrong with a dump that was cut off.
const TORN: &str = "it ends inside a frame";

/// Buffer of a pipe from LAMMPS.
const BUFFER: usize = 1 << 18;

/// Frames on their way to the file.
pub struct Job<'a> {
    setup: &'a Setup,
    /// All particles by id, as they were last.
    particles: Vec<Particle>,
    /// Those that are in the frame.
    pub there: Vec<Particle>,
    /// Those that come in, by id.
    arrivals: &'a [Arrival],
    schedule: &'a Schedule,
    deck: &'a Deck,
    /// How each particle has turned, where there are bonds.
    turns: Vec<UnitQuaternion<f64>>,
    /// Clumps from frame to frame.
    clumps: Tracker<'a>,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// Step of the last frame.
    pub last: Option<u64>,
    /// How many crossed a storage plane.
    pub crossings: u64,
    report: &'a mut dyn FnMut(&Progress),
}

impl<'a> Job<'a> {
    /// A job at its start.
    pub fn new(
        setup: &'a Setup,
        arrivals: &'a [Arrival],
        schedule: &'a Schedule,
        deck: &'a Deck,
        report: &'a mut dyn FnMut(&Progress),
    ) -> Job<'a> {
        let mut particles = setup.particles.clone();
        particles.sort_by_key(|p| p.id);
        Job {
            setup,
            there: Vec::new(),
            arrivals,
            schedule,
            turns: vec![UnitQuaternion::identity(); particles.len()],
            particles,
            deck,
            clumps: Tracker::new(setup),
            warnings: Vec::new(),
            last: None,
            crossings: 0,
            report,
        }
    }
}

impl Job<'_> {
    fn time(&self) -> Shown {
        Shown(self.last.unwrap_or(0) as f64 * self.schedule.dt)
    }

    fn wrong(&self, what: impl Into<String>) -> LammpsError {
        LammpsError::Dump { time: self.time(), what: what.into() }
    }

    /// Runs LAMMPS; what stopped it early.
    ///
    /// # Errors
    /// LAMMPS that fails, output that cannot be written.
    pub fn live<W: Write>(
        &mut self,
        file: &mut RunFile<W>,
        engine: &Engine,
        place: Place,
        stop: fn() -> bool,
    ) -> Result<Option<StopCause>> {
        let (running, pipes) = Running::start(engine, &place, stop)?;
        let mut dumps: Vec<(&str, Parts)> = Vec::new();
        for (name, pipe) in DUMPS.into_iter().zip(pipes) {
            dumps.push((name, vec![Box::new(BufReader::with_capacity(BUFFER, pipe))]));
        }
        if let Place::Kept(start) = place {
            for name in DUMPS.into_iter().filter(|name| self.deck.asked.has(name)) {
                let parts = folder::followed(start, name, running.ended(), BUFFER);
                let folder = || start.folder.display().to_string();
                dumps.push((name, parts.map_err(|error| LammpsError::Folder { folder: folder(), error })?));
            }
        }
        let read = self.read_then(file, dumps, |read| {
            if !matches!(read, Ok(Ended::Over)) {
                running.abandon();
            }
        });
        let (status, words) = running.end();
        let ended = read?;
        if self.last == Some(self.schedule.last) {
            return Ok(None);
        }
        if stop() {
            return Ok(Some(StopCause::Signal));
        }
        match (status, ended) {
            (_, Ended::Wrong(what)) => Err(self.wrong(what)),
            (Some(status), Ended::Torn) if status.success() => Err(self.wrong(TORN)),
            (status, _) => Err(LammpsError::Died { how: how(status), time: self.time(), words }),
        }
    }

    /// Writes all frames, what contacts bear, and the crossings in the samples near outlets, from dumps by their names.
    ///
    /// # Errors
    /// Frames of another scene, output that cannot be written.
    pub fn read<W: Write>(&mut self, file: &mut RunFile<W>, dumps: Vec<(&str, Parts)>) -> Result<Ended> {
        self.read_then(file, dumps, |_| ())
    }

    /// The same; `then` is called when the frames are over, and must see to it that the samples are.
    fn read_then<W: Write>(
        &mut self,
        file: &mut RunFile<W>,
        dumps: Vec<(&str, Parts)>,
        then: impl FnOnce(&Result<Ended>),
    ) -> Result<Ended> {
        let mut dumps: BTreeMap<&str, Parts> =
            dumps.into_iter().filter(|(name, _)| self.deck.asked.has(name)).collect();
        let frames = Dump::new(dumps.remove(FRAMES).unwrap_or_default(), &self.deck.asked.of_frames());
        let zone = dumps.remove(ZONE);
        let mut loads = Loads::new(&self.deck.asked, self.setup, [PAIRS, TOUCHES].map(|d| dumps.remove(d)));
        let mut joined = Joined::new(&self.deck.bonds().made, dumps.remove(OF_BONDS));
        let found = Mutex::new(Found::default());
        let search = Search::new(self.setup, self.arrivals, self.schedule.dt);
        std::thread::scope(|scope| {
            let outlets = zone.is_some();
            let add = |more: Found| {
                let mut all = found.lock().unwrap_or_else(PoisonError::into_inner);
                all.crossings.extend(more.crossings);
                all.until = all.until.max(more.until);
                all.wrong = more.wrong;
            };
            let searching = zone.map(|zone| scope.spawn(move || search.read(zone, add)));
            let found = outlets.then_some(&found);
            let read = self.frames(file, (frames, &mut loads, &mut joined), found);
            then(&read);
            if let Some(searching) = searching {
                let _ = searching.join();
            }
            let ended = read?;
            found.map_or(Ok(()), |found| self.cross(file, found))?;
            Ok(ended)
        })
    }

    /// Writes all frames, each after the crossings before it.
    fn frames<W: Write>(
        &mut self,
        file: &mut RunFile<W>,
        (mut frames, loads, joined): (Dump, &mut Loads, &mut Joined),
        found: Option<&Mutex<Found>>,
    ) -> Result<Ended> {
        loop {
            let frame = match frames.next_block() {
                Ok(frame) => frame,
                Err(ended) => return Ok(ended),
            };
            self.follows(frame.step)?;
            self.take(&frame)?;
            self.last = Some(frame.step);
            let time = frame.step as f64 * self.schedule.dt;
            self.enter(time);
            let (setup, arrivals) = (self.setup, self.arrivals);
            let now = Now { setup, arrivals, step: frame.step, time, particles: &self.particles };
            let contacts = match loads.at(&now) {
                Ok(contacts) => contacts,
                Err(ended) => return Ok(ended),
            };
            let (bonds, cracks) = match joined.at(&now, &self.turns) {
                Ok(both) => both,
                Err(ended) => return Ok(ended),
            };
            found.map_or(Ok(()), |found| self.cross(file, found))?;
            file.cracks(time, &cracks)?;
            let bodies = self.clumps.at(time, &self.particles);
            if let Some(warning) = self.clumps.warning.take() {
                file.note(time, &warning)?;
                self.warnings.push(warning);
            }
            file.frame(time, &self.there, &bodies)?;
            file.bonds(time, &bonds)?;
            if self.deck.asked.contacts {
                file.contacts(time, &contacts)?;
            }
            if self.deck.asked.walls {
                file.wall_forces(time, &loads::on_walls(&contacts, self.setup, time))?;
            }
            self.tell(file.frames, frame.step);
        }
    }

    /// Refuses a frame that does not follow the last one.
    fn follows(&self, step: u64) -> Result<()> {
        let next = self.last.map_or(0, |last| self.schedule.frame_after(last));
        // Sums of LAMMPS may round to the step beside.
        if step.abs_diff(next) <= 1 {
            return Ok(());
        }
        Err(self.wrong(format!(
            "the next frame is that of step {step}, and that of step {next} is missing: a file is cut off, or of another run"
        )))
    }

    /// Writes the crossings that were found.
    fn cross<W: Write>(&mut self, file: &mut RunFile<W>, found: &Mutex<Found>) -> Result<()> {
        let mut found = found.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(what) = &found.wrong {
            return Err(self.wrong(format!("samples near outlets: {what}")));
        }
        let crossings = std::mem::take(&mut found.crossings);
        let until = found.until;
        drop(found);
        self.crossings += crossings.len() as u64;
        Ok(file.crossings(until, &crossings)?)
    }

    /// Refuses a dump that is not whole.
    ///
    /// # Errors
    /// How it ended.
    pub fn whole(&self, ended: Ended) -> Result<()> {
        match ended {
            Ended::Wrong(what) => Err(self.wrong(what)),
            Ended::Torn => Err(self.wrong(TORN)),
            Ended::Over if self.last == Some(self.schedule.last) => Ok(()),
            Ended::Over => {
                let end = Shown(self.schedule.end());
                Err(self.wrong(format!("it ends there, and the scene ends at {end} s: it is of another scene, or of a run that broke off")))
            }
        }
    }

    /// Leaves those out of the frame that have not come in yet.
    fn enter(&mut self, time: f64) {
        let later = |p: &Particle| {
            let found = self.arrivals.binary_search_by_key(&p.id, |a| a.id);
            found.is_ok_and(|index| self.arrivals[index].enters > time)
        };
        self.there.clear();
        self.there.extend(self.particles.iter().filter(|p| !later(p)));
    }

    fn take(&mut self, frame: &Block) -> Result<()> {
        if !self.setup.outlets.is_empty() {
            // Those behind an outlet are taken out.
            let numbers: HashSet<u64> = frame.rows().map(|row| row[0] as u64).collect();
            self.particles.retain(|p| numbers.contains(&number_of(p.id)));
        }
        if frame.len() != self.particles.len() {
            let (found, all) = (frame.len(), self.particles.len());
            return Err(
                self.wrong(format!("step {}: {found} atoms, and the scene has {all} particles", frame.step))
            );
        }
        for row in frame.rows() {
            let (number, values) = (row[0] as u64, &row[1..]);
            let found = self.particles.binary_search_by_key(&number, |p| number_of(p.id));
            let Ok(index) = found else {
                return Err(
                    self.wrong(format!("step {}: atom {number} is no particle of the scene", frame.step))
                );
            };
            if let Some(bad) = values.iter().find(|value| !value.is_finite()) {
                let id = number - 1;
                return Err(self.wrong(format!(
                    "step {}: particle {id} has the value {bad}: use a shorter time.dt",
                    frame.step
                )));
            }
            let three = |k: usize| Vec3::new(values[k], values[k + 1], values[k + 2]);
            let p = &mut self.particles[index];
            p.position = three(0);
            // At the start those of the scene hold: clumps may have been given a kick.
            if frame.step > 0 {
                (p.velocity, p.spin) = (three(3), three(6));
            }
            if let [w, i, j, k] = values[9..] {
                self.turns[index] = UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k));
            }
        }
        Ok(())
    }

    fn tell(&mut self, frames: u64, step: u64) {
        let Schedule { dt, last, .. } = *self.schedule;
        let time = step as f64 * dt;
        (self.report)(&Progress {
            time,
            until: self.schedule.end(),
            step,
            steps: last,
            share: step as f64 / last as f64,
            particles: self.there.len(),
            asleep: 0,
            kinetic: None,
            balance: None,
            frames,
            checkpoints: 0,
            saved: time,
        });
    }
}

/// How a process ended.
fn how(status: Option<ExitStatus>) -> String {
    match status {
        None => "was lost".to_owned(),
        Some(status) => match (status.code(), status.signal()) {
            (Some(0), _) => "ended before its last frame".to_owned(),
            (Some(code), _) => format!("failed (exit code {code})"),
            (None, Some(signal)) => format!("was killed (signal {signal})"),
            (None, None) => "failed".to_owned(),
        },
    }
}
