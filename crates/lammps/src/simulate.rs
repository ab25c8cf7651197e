//! A run on LAMMPS, written as it comes.

use crate::data::number_of;
use crate::deck::Deck;
use crate::dump::{Ended, Frame, Frames};
use crate::error::{LammpsError, Result};
use crate::process::{Engine, Running};
use crate::version::Version;
use dem::setup::Particle;
use geom::{Shown, Vec3};
use run::{Progress, RunError, RunFile, Schedule};
use scene::keys::Sampling;
use scene::{Plan, Scene};
use serde::Serialize;
use std::io::{BufRead, BufReader, Write};
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::ExitStatus;
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
    /// LAMMPS, which is started.
    Engine(&'a Engine),
    /// A dump that it wrote before.
    Dump(Box<dyn BufRead + 'a>),
}

/// What was done.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Outcome {
    /// Why it was stopped before its end.
    pub stopped: Option<String>,
    /// Time reached [s].
    pub time: f64,
    /// Time step [s].
    pub dt: f64,
    /// Steps.
    pub steps: u64,
    /// Frames written.
    pub frames: u64,
    /// Particles.
    pub particles: usize,
    /// Version of LAMMPS.
    pub lammps: Option<String>,
}

/// Makes a scene sample forces at instants, as LAMMPS does: the time step is chosen for that.
pub fn sampled(scene: &mut Scene) {
    scene.keys.time.contacts = Sampling::Sampled;
}

/// The deck of a scene, and the schedule of its run.
///
/// # Errors
/// What LAMMPS cannot do, what the engine refuses.
pub fn prepare(scene: &Scene, plan: &Plan, version: Version, ranks: usize) -> Result<(Deck, Schedule)> {
    run::ready(scene, plan, None)?;
    let dt = dem::time_step(&plan.setup).map_err(RunError::from)?;
    let schedule = Schedule::new(scene, dt)?;
    Ok((Deck::of(scene, &plan.setup, &schedule, version, ranks)?, schedule))
}

/// Runs a deck on LAMMPS, or reads its dump, and writes the run.
///
/// # Errors
/// LAMMPS that fails, a dump that breaks off, output that cannot be written.
pub fn run<W: Write>(
    scene: &Scene,
    plan: &Plan,
    (deck, schedule): (&Deck, &Schedule),
    origin: Origin,
    out: W,
    settings: Settings<W>,
    report: &mut dyn FnMut(&Progress),
) -> Result<(Outcome, W)> {
    let mut file = RunFile::begin(scene, plan, schedule, out, &settings.provenance, settings.how)?;
    file.note(0.0, "computed by LAMMPS; forces are sampled at instants, and the file has no checkpoint")?;
    let mut job = Job { setup: plan.setup.particles.clone(), schedule, last: None, report };
    job.setup.sort_by_key(|p| p.id);
    let reason = match origin {
        Origin::Dump(input) => {
            let ended = job.read(&mut file, Frames::new(input))?;
            job.whole(ended)?;
            None
        }
        Origin::Engine(engine) => {
            let folder = tempfile::tempdir().map_err(|error| LammpsError::Deck {
                folder: std::env::temp_dir().display().to_string(),
                error,
            })?;
            deck.write(&plan.setup, folder.path())?;
            job.live(&mut file, engine, folder.path(), settings.stop)?
        }
    };
    let step = job.last.unwrap_or(0);
    let time = step as f64 * schedule.dt;
    if let Some(reason) = &reason {
        file.stopped(time, reason)?;
    }
    let outcome = Outcome {
        stopped: reason,
        time,
        dt: schedule.dt,
        steps: step,
        frames: file.frames,
        particles: plan.setup.particles.len(),
        lammps: None,
    };
    Ok((outcome, file.finish()?))
}

/// Frames on their way to the file.
struct Job<'a> {
    /// Particles by id, as they were last.
    setup: Vec<Particle>,
    schedule: &'a Schedule,
    /// Step of the last frame.
    last: Option<u64>,
    report: &'a mut dyn FnMut(&Progress),
}

impl Job<'_> {
    fn time(&self) -> Shown {
        Shown(self.last.unwrap_or(0) as f64 * self.schedule.dt)
    }

    fn wrong(&self, what: impl Into<String>) -> LammpsError {
        LammpsError::Dump { time: self.time(), what: what.into() }
    }

    /// Runs LAMMPS; why it was stopped early.
    fn live<W: Write>(
        &mut self,
        file: &mut RunFile<W>,
        engine: &Engine,
        folder: &Path,
        stop: fn() -> bool,
    ) -> Result<Option<String>> {
        let (running, pipe) = Running::start(engine, folder, stop)?;
        // Its end closes the pipe: LAMMPS ends where the file cannot be written.
        let read = self.read(file, Frames::new(BufReader::with_capacity(1 << 18, pipe)));
        let (status, words) = running.end();
        let ended = read?;
        if self.last == Some(self.schedule.last) {
            return Ok(None);
        }
        if stop() {
            return Ok(Some(record::SIGNAL.to_owned()));
        }
        match (status, ended) {
            (Some(status), Ended::Broken(what)) if status.success() => Err(self.wrong(what)),
            (status, _) => Err(LammpsError::Died { how: how(status), time: self.time(), words }),
        }
    }

    /// Writes all frames.
    fn read<W: Write>(&mut self, file: &mut RunFile<W>, mut frames: Frames<impl BufRead>) -> Result<Ended> {
        loop {
            let frame = match frames.next_frame() {
                Ok(frame) => frame,
                Err(ended) => return Ok(ended),
            };
            self.take(&frame)?;
            self.last = Some(frame.step);
            file.frame(frame.step as f64 * self.schedule.dt, &self.setup)?;
            self.tell(file.frames, frame.step);
        }
    }

    /// Refuses a dump that is not whole.
    fn whole(&self, ended: Ended) -> Result<()> {
        match ended {
            Ended::Broken(what) => Err(self.wrong(what)),
            Ended::Over if self.last == Some(self.schedule.last) => Ok(()),
            Ended::Over => {
                let end = Shown(self.schedule.end());
                Err(self.wrong(format!("it ends there, and the scene ends at {end} s: it is of another scene, or of a run that broke off")))
            }
        }
    }

    fn take(&mut self, frame: &Frame) -> Result<()> {
        if frame.atoms.len() != self.setup.len() {
            let (found, all) = (frame.atoms.len(), self.setup.len());
            return Err(
                self.wrong(format!("step {}: {found} atoms, and the scene has {all} particles", frame.step))
            );
        }
        for (number, values) in &frame.atoms {
            let found = self.setup.binary_search_by_key(number, |p| number_of(p.id));
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
            let [x, y, z, vx, vy, vz, wx, wy, wz] = *values;
            let p = &mut self.setup[index];
            (p.position, p.velocity, p.spin) =
                (Vec3::new(x, y, z), Vec3::new(vx, vy, vz), Vec3::new(wx, wy, wz));
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
            particles: self.setup.len(),
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
