//! What changes while a simulation runs, and what a checkpoint holds: nothing of it can be derived.
//!
//! A file a part. What lists keep in their slots (contact history, forces of this instant) is saved beside it
//! ([`crate::simulation::checkpoint`]). Uses model and setup.

pub mod bonds;
pub mod clump;
pub mod clumps;
pub mod energy;
pub mod ledger;
pub mod particles;
pub mod path;
pub mod returned;
pub mod servo;
pub mod sleepers;
pub mod zone_particle;
pub mod zones;

use crate::model::Model;
use crate::model::error::SetupError;
use crate::setup::{Particle, Setup};
use crate::state::servo::ServoState;
use bonds::Bonds;
use clumps::RigidClumps;
use ledger::LedgerSums;
use particles::Particles;
use serde::{Deserialize, Serialize};
use sleepers::Sleepers;
use zones::Zones;

/// What changes while a simulation runs.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct State {
    /// Time step that the run began with [s].
    pub dt: f64,
    /// Gap up to which neighbours are listed [m].
    pub skin: f64,
    /// Steps done.
    pub steps: u64,
    /// Step at which neighbours were listed.
    pub listed: u64,
    /// Whether a particle has left the margin that its neighbours were listed for.
    pub out: bool,
    /// Whether lists must be rebuilt whatever has moved.
    pub outdated: bool,
    /// Whether forces are those of this instant.
    pub current: bool,
    /// Particles whose acceleration of the step before is unknown.
    pub starting: Vec<u32>,
    /// Particles.
    pub particles: Particles,
    /// Zones and the particles in them.
    pub zones: Zones,
    /// Rigid clumps.
    pub bodies: RigidClumps,
    /// Bonds.
    pub bonds: Bonds,
    /// Particles that sleep, where the setup asks for it.
    pub sleepers: Option<Sleepers>,
    /// Servos, by wall; empty where no wall follows a force.
    pub servos: Vec<ServoState>,
    /// Sums of the energy ledger.
    pub ledger: LedgerSums,
    /// How often neighbours were listed.
    pub rebuilds: u64,
}

impl State {
    /// The state at t = 0.
    ///
    /// # Errors
    /// Bonds that join nothing.
    pub fn new(model: &Model) -> Result<State, SetupError> {
        let setup = &model.setup;
        let mut particles = Particles::new(model.rotates);
        let mut sorted: Vec<&Particle> = setup.particles.iter().collect();
        sorted.sort_unstable_by_key(|p| p.id);
        sorted.into_iter().for_each(|p| particles.push(p, &setup.materials));
        let bodies = RigidClumps::new(setup, &mut particles);
        let bonds = Bonds::new(setup, &particles)?;
        let sleepers = setup.sleep.map(|s| Sleepers::new(s, model.dt, setup.gravity.norm(), particles.len()));
        Ok(State {
            dt: model.dt,
            skin: model.skin,
            steps: 0,
            listed: 0,
            out: false,
            outdated: true,
            current: false,
            starting: (0..particles.len() as u32).collect(),
            zones: Zones::new(setup, &particles),
            bodies,
            bonds,
            sleepers,
            servos: servos(setup),
            ledger: LedgerSums::default(),
            rebuilds: 0,
            particles,
        })
    }

    /// Steps × Δt [s].
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.dt
    }

    /// Whether the wrench of each contact is wanted in each step: by servos, planes of zones, and sleepers.
    pub fn keeps_wrenches(&self) -> bool {
        !self.servos.is_empty() || !self.zones.none() || self.sleepers.is_some()
    }

    /// Whether anything makes torques besides those of tangential forces.
    pub fn torques(&self, model: &Model) -> bool {
        !self.bonds.none() || model.kinds.iter().any(|k| k.kernel.torques())
    }
}

/// A servo for each wall, or none where no wall follows a force.
fn servos(setup: &Setup) -> Vec<ServoState> {
    let any = setup.walls.iter().any(|w| w.motion.servo.is_some());
    vec![ServoState::default(); if any { setup.walls.len() } else { 0 }]
}
