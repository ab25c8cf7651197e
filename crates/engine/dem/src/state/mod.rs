//! What changes while a simulation runs, and what a checkpoint holds: nothing of it can be derived.
//!
//! One file for each part. `contacts` are columns by slot of the neighbour lists, so they are saved apart
//! ([`contacts::SavedColumns`]). Uses model, setup and laws.

pub mod bonds;
pub mod cell;
pub mod clump;
pub mod clumps;
pub mod contact_record;
pub mod contacts;
pub mod energy;
pub mod kinematics;
pub mod ledger;
pub mod mount;
pub mod particles;
pub mod path;
pub mod returned;
pub mod row_order;
pub mod servo;
pub mod sleepers;
pub mod validity;
pub mod wall_sums;
pub mod zone_particle;
pub mod zones;

pub use bonds::{BondState, Bonds, Crack};
pub use cell::CellState;
pub use clump::ClumpMotion;
pub use clumps::{FREE, RigidClumps};
pub use contact_record::ContactRecord;
pub use contacts::{ContactColumns, SavedColumns, WrenchColumns};
pub use energy::Energy;
pub use kinematics::Kinematics;
pub use ledger::{DrivenBody, LedgerSums};
pub use mount::MountState;
pub use particles::{Particles, SpareColumns};
pub use path::{EARLY, Path, PathEnd};
pub use returned::{HeldBack, NoRoom, ReturnCounts, Returned};
pub use servo::{Governor, Held, ServoState};
pub use sleepers::{SleepMap, SleeperSlices, Sleepers};
pub use wall_sums::{PartSum, WallInterval, WallSum, WallSums};
pub use zone_particle::{Direction, ZoneParticle};
pub use zones::{LOOK_AHEAD, Zones};

use crate::model::{Model, SetupError};
use crate::setup::{Particle, Setup};
use serde::{Deserialize, Serialize};

/// What changes while a simulation runs.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct State {
    /// Time step that the run began with [s].
    pub dt: f64,
    /// Steps done.
    pub steps: u64,
    /// When and how neighbours were listed.
    pub listing: Listing,
    /// Whether forces of this instant are known.
    pub forces: Forces,
    /// Particles that start: they have no acceleration of the step before.
    pub starting: Vec<u32>,
    /// Particles.
    pub particles: Particles,
    /// Zones and the particles in them.
    pub zones: Zones,
    /// Rigid clumps.
    pub clumps: RigidClumps,
    /// Bonds.
    pub bonds: Bonds,
    /// Clusters of particles by id, in their order.
    pub clusters: Vec<(u32, u32)>,
    /// Particles that sleep, where the setup asks for it.
    pub sleepers: Option<Sleepers>,
    /// The periodic cell, where it is strained.
    pub strained: Option<CellState>,
    /// Servos, by wall; empty where no wall follows a force.
    pub servos: Vec<ServoState>,
    /// Walls on springs, by wall; empty where there is none.
    pub mounts: Vec<MountState>,
    /// Sums of the energy ledger.
    pub ledger: LedgerSums,
    /// Sums of what particles do to walls.
    pub wall_sums: WallSums,
    /// Contacts with sliding work that are no longer listed, until they are recorded.
    pub ended: Vec<ContactRecord>,
    /// History and wrenches of contacts.
    #[serde(skip)]
    pub contacts: ContactColumns,
}

/// Whether forces of this instant are known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Forces {
    /// They must be computed.
    Due,
    /// They have been computed, or resumed.
    Known,
}

/// Whether neighbour lists hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum ListStatus {
    /// No particle has left its margin; walls are checked separately.
    Valid,
    /// A particle has left its margin.
    MarginLeft,
    /// They must be rebuilt whatever has moved.
    Outdated,
}

/// The record of the last rebuild of neighbour lists.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Listing {
    /// Gap up to which neighbours are listed [m].
    pub skin: f64,
    /// Step of the last rebuild.
    pub step: u64,
    /// Number of rebuilds.
    pub rebuilds: u64,
    /// Whether the lists hold.
    pub status: ListStatus,
}

impl Listing {
    /// Lists no longer hold, for this reason or a stronger one.
    pub fn outdate(&mut self, why: ListStatus) {
        self.status = self.status.max(why);
    }
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
        particles.reserve(sorted.len());
        sorted.into_iter().for_each(|p| particles.push(p, &setup.materials));
        let clumps = RigidClumps::new(setup, &mut particles);
        let bonds = Bonds::new(setup, &particles)?;
        let sleepers = setup.sleep.map(|s| Sleepers::new(s, model.dt, setup.gravity.norm(), particles.len()));
        Ok(State {
            dt: model.dt,
            steps: 0,
            listing: Listing { skin: model.skin, step: 0, rebuilds: 0, status: ListStatus::Outdated },
            forces: Forces::Due,
            starting: (0..particles.len() as u32).collect(),
            zones: Zones::new(setup, &particles),
            clumps,
            bonds,
            clusters: setup.clusters.clone(),
            sleepers,
            strained: CellState::new(setup, model.dt),
            servos: servos(setup),
            mounts: mounts(setup),
            ledger: LedgerSums::default(),
            wall_sums: WallSums::new(model),
            ended: Vec::new(),
            contacts: ContactColumns::default(),
            particles,
        })
    }

    /// A copy of all but the columns of contacts, which are saved apart.
    pub fn without_contacts(&self) -> State {
        State {
            dt: self.dt,
            steps: self.steps,
            listing: self.listing,
            forces: self.forces,
            starting: self.starting.clone(),
            particles: self.particles.clone(),
            zones: self.zones.clone(),
            clumps: self.clumps.clone(),
            bonds: self.bonds.clone(),
            clusters: self.clusters.clone(),
            sleepers: self.sleepers.clone(),
            strained: self.strained.clone(),
            servos: self.servos.clone(),
            mounts: self.mounts.clone(),
            ledger: self.ledger,
            wall_sums: self.wall_sums.clone(),
            ended: self.ended.clone(),
            contacts: ContactColumns::default(),
        }
    }

    /// Steps × Δt [s].
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.dt
    }

    /// Whether the wrench of each contact is wanted in each step: by servos, walls on springs, a strained cell, planes of zones, and sleepers.
    pub fn keeps_wrenches(&self) -> bool {
        let moved = !self.servos.is_empty() || !self.mounts.is_empty() || self.strained.is_some();
        moved || !self.zones.none() || self.sleepers.is_some()
    }

    /// Whether anything makes torques besides those of tangential forces.
    pub fn torques(&self, model: &Model) -> bool {
        !self.bonds.none() || model.kinds.iter().any(|k| k.composition.torques())
    }
}

/// A servo for each wall, or none where no wall follows a force.
fn servos(setup: &Setup) -> Vec<ServoState> {
    let any = setup.walls.iter().any(|w| w.servo.is_some());
    vec![ServoState::default(); if any { setup.walls.len() } else { 0 }]
}

/// A state for each wall, or none where no wall is on a spring.
fn mounts(setup: &Setup) -> Vec<MountState> {
    let any = setup.walls.iter().any(|w| w.mount.is_some());
    vec![MountState::default(); if any { setup.walls.len() } else { 0 }]
}
