//! A run on LAMMPS, written as it comes.

use crate::arrivals::{self, Arrival};
use crate::data::number_of;
use crate::deck::{Deck, Source};
use crate::dump::{Ended, Frame, Frames};
use crate::error::{LammpsError, Result};
use crate::law::Target;
use crate::process::{Engine, Running};
use crate::refusal::Refusal;
use dem::setup::{Particle, Setup};
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

/// A scene that is ready for LAMMPS.
pub struct Prepared {
    /// The deck.
    pub deck: Deck,
    /// Which steps are frames.
    pub schedule: Schedule,
    setup: Setup,
    arrivals: Vec<Arrival>,
}

impl Prepared {
    /// What the nearest that LAMMPS can do was taken for.
    pub fn warnings(&self) -> Vec<String> {
        let one = |bent: &Refusal| format!("{}: {}: the nearest is taken", bent.what, bent.why);
        self.deck.bent.iter().map(one).collect()
    }

    /// Writes the deck into a folder.
    ///
    /// # Errors
    /// A folder that cannot be written to.
    pub fn write(&self, folder: &Path) -> Result<()> {
        self.deck.write(&self.setup, folder)
    }
}

/// Makes a scene ready.
///
/// # Errors
/// What LAMMPS cannot do, what the engine refuses.
pub fn prepare(scene: &Scene, plan: &Plan, target: Target, ranks: usize) -> Result<Prepared> {
    run::ready(scene, plan, None)?;
    let dt = dem::time_step(&plan.setup).map_err(RunError::from)?;
    let schedule = Schedule::new(scene, dt)?;
    let mut setup = plan.setup.clone();
    let arrivals = arrivals::add(&mut setup, &plan.insertions, schedule.end())?;
    let source = Source { scene, setup: &setup, arrivals: &arrivals, schedule: &schedule, target, ranks };
    Ok(Prepared { deck: Deck::of(source)?, setup, arrivals, schedule })
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
    let mut job =
        Job { particles: setup.particles.clone(), there: Vec::new(), arrivals, schedule, last: None, report };
    job.particles.sort_by_key(|p| p.id);
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
            prepared.write(folder.path())?;
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
        particles: job.there.len(),
        lammps: None,
    };
    Ok((outcome, file.finish()?))
}

/// What is wrong with a dump that was cut off.
const TORN: &str = "it ends inside a frame";

/// Frames on their way to the file.
struct Job<'a> {
    /// All particles by id, as they were last.
    particles: Vec<Particle>,
    /// Those that are in the frame.
    there: Vec<Particle>,
    /// Those that come in, by id.
    arrivals: &'a [Arrival],
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
        let read = self.read(file, Frames::new(BufReader::with_capacity(1 << 18, pipe)));
        let whole = matches!(read, Ok(Ended::Over));
        if !whole {
            running.abandon();
        }
        let (status, words) = running.end();
        let ended = read?;
        if self.last == Some(self.schedule.last) {
            return Ok(None);
        }
        if stop() {
            return Ok(Some(record::SIGNAL.to_owned()));
        }
        match (status, ended) {
            (_, Ended::Wrong(what)) => Err(self.wrong(what)),
            (Some(status), Ended::Torn) if status.success() => Err(self.wrong(TORN)),
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
            let time = frame.step as f64 * self.schedule.dt;
            self.enter(time);
            file.frame(time, &self.there)?;
            self.tell(file.frames, frame.step);
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

    /// Refuses a dump that is not whole.
    fn whole(&self, ended: Ended) -> Result<()> {
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

    fn take(&mut self, frame: &Frame) -> Result<()> {
        if frame.atoms.len() != self.particles.len() {
            let (found, all) = (frame.atoms.len(), self.particles.len());
            return Err(
                self.wrong(format!("step {}: {found} atoms, and the scene has {all} particles", frame.step))
            );
        }
        for (number, values) in &frame.atoms {
            let found = self.particles.binary_search_by_key(number, |p| number_of(p.id));
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
            let p = &mut self.particles[index];
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
