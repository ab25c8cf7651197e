//! A short run of a scene, to see what a step takes.

use crate::supply::Supply;
use dem::Simulation;
use dem::setup::Setup;
use rustix::time::{ClockId, clock_gettime};
use scene::advice::{explain_halt, explain_setup_error};
use scene::plan::Insertion;
use serde::Serialize;
use stages::inlet::Arrival;
use std::time::Instant;

/// Time that a scene runs before it is measured [s], so that grains come in, fall and touch.
const AHEAD: f64 = 0.5;
/// Time that a measurement takes at least [s].
const MEASURE: f64 = 0.15;
/// Steps that a measurement takes at most.
const MOST: u32 = 500;

/// What was measured.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Calibration {
    /// Steps before.
    pub steps: u64,
    /// Simulated time then [s].
    pub time: f64,
    /// Particles then.
    pub particles: usize,
    /// Contacts that carry a force then.
    pub touching: usize,
    /// Time of a step [s].
    pub seconds_per_step: f64,
    /// Processor time of a step, of all threads [s]: other work on the machine hardly disturbs it.
    pub processor_seconds_per_step: f64,
}

impl Calibration {
    /// Of a setup with its insertions, after at most so many steps.
    ///
    /// # Errors
    /// Why nothing can be measured: a guard stops it, no particle is there.
    pub(super) fn new(setup: Setup, insertions: &[Insertion], most: u64) -> Result<Calibration, String> {
        let mut trial = Trial::new(setup, insertions)?;
        let start = Instant::now();
        while trial.sim.steps() < most && start.elapsed().as_secs_f64() < AHEAD {
            trial.step()?;
        }
        trial.measured()
    }

    /// Processor time of a step [s] of another setup after as many steps; `None` where it does not get so far in twice the time.
    pub(super) fn compared(&self, setup: Setup, insertions: &[Insertion]) -> Option<f64> {
        let mut trial = Trial::new(setup, insertions).ok()?;
        let start = Instant::now();
        while trial.sim.steps() < self.steps {
            trial.step().ok()?;
            if start.elapsed().as_secs_f64() > 2.0 * AHEAD {
                return None;
            }
        }
        Some(trial.measured().ok()?.processor_seconds_per_step)
    }
}

struct Trial {
    sim: Simulation,
    supply: Supply,
}

impl Trial {
    fn new(setup: Setup, insertions: &[Insertion]) -> Result<Trial, String> {
        let sim = Simulation::new(setup).map_err(|e| explain_setup_error(&e))?;
        // A stream may wait for another program: it is left out.
        let supply = Supply::new(Vec::new(), insertions.to_vec()).map_err(|e| e.to_string())?;
        Ok(Trial { sim, supply })
    }

    fn step(&mut self) -> Result<(), String> {
        let horizon = self.sim.time() + self.sim.look_ahead();
        while let Some(arrival) = self.supply.next_until(horizon).map_err(|e| e.to_string())? {
            if let Arrival::Enter(entry) = arrival {
                self.sim.enter(entry).map_err(|e| explain_setup_error(&e))?;
            }
        }
        self.sim.step().map_err(|halt| explain_halt(&halt))?;
        drop(self.sim.take_crossings());
        Ok(())
    }

    fn measured(mut self) -> Result<Calibration, String> {
        let (steps, time) = (self.sim.steps(), self.sim.time());
        let particles = self.sim.particle_count();
        if particles == 0 {
            return Err("no particle is there".to_owned());
        }
        let touching = self.sim.record_contacts().map_err(|halt| explain_halt(&halt))?;
        let touching = touching.iter().filter(|c| c.force != geom::Vec3::zeros()).count();
        self.step()?;
        let (start, before, mut done) = (Instant::now(), processor_seconds(), 0);
        loop {
            self.step()?;
            done += 1;
            let passed = start.elapsed().as_secs_f64();
            if (passed > MEASURE && done >= 10) || done == MOST {
                return Ok(Calibration {
                    steps,
                    time,
                    particles,
                    touching,
                    seconds_per_step: passed / f64::from(done),
                    processor_seconds_per_step: (processor_seconds() - before) / f64::from(done),
                });
            }
        }
    }
}

/// Processor time of this process so far [s].
fn processor_seconds() -> f64 {
    let now = clock_gettime(ClockId::ProcessCPUTime);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}
