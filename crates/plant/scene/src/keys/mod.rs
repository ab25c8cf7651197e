//! The keys of a scene, as they are written: one struct for each table, with defaults.
//!
//! Serde reads them ([`crate::text`]), [`crate::check`] checks their values, [`crate::plan`] turns them into a setup of the engine.

mod bond;
mod calculation;
mod contact;
mod contact_keys;
mod domain;
mod forms;
mod geometry;
mod grains;
mod particles;
mod place;
mod servo;
mod unit;
mod wall;

pub use bond::*;
pub use calculation::*;
pub use contact::*;
pub use domain::*;
pub use grains::*;
pub use particles::*;
pub use place::*;
pub use servo::*;
pub use wall::*;

use serde::Deserialize;

/// A scene; docs/reference/scene.md lists its keys. SI units.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SceneKeys {
    /// Acceleration of free fall [m/s²]; absent: none.
    #[serde(deserialize_with = "unit::metres_a_second_squared")]
    pub gravity: [f64; 3],
    /// Id of the first particle that the scene itself makes; particles of an inlet keep theirs.
    pub first_id: u32,
    /// In which precision contacts are computed.
    pub precision: Arithmetic,
    /// Time.
    pub time: Time,
    /// What is written, and when.
    pub output: Output,
    /// Extent.
    pub domain: Domain,
    /// The fluid around the particles; absent: none.
    pub drag: Option<Drag>,
    /// Damping of what is not in balance; absent: none.
    pub local_damping: Option<LocalDamping>,
    /// Search for neighbours.
    pub neighbours: Neighbours,
    /// When particles at rest are passed over; absent: never.
    pub sleep: Option<Sleep>,
    /// When the run is stopped.
    pub guards: Guards,
    /// Materials.
    pub material: Vec<Material>,
    /// Laws between materials.
    pub contact: Vec<Contact>,
    /// Bonds between particles that are close at t = 0.
    pub bond: Vec<Bond>,
    /// Shapes of rigid clumps.
    pub clump: Vec<Clump>,
    /// Rigid clumps at t = 0.
    pub body: Vec<Body>,
    /// Shapes filled with particles at t = 0.
    pub fill: Vec<Fill>,
    /// Particles from files.
    pub particles: Vec<Particles>,
    /// Insertions.
    pub insert: Vec<Insert>,
    /// Walls.
    pub wall: Vec<Wall>,
    /// Storage planes with their zones.
    pub outlet: Vec<Outlet>,
    /// Zones that recorded particles enter by.
    pub inlet: Vec<Inlet>,
}

impl SceneKeys {
    /// Whether the run keeps the energy ledger. Contacts are written with the work of sliding, which the ledger knows.
    pub fn keeps_ledger(&self) -> bool {
        self.output.energy || self.output.contacts || self.guards.energy_share().is_some()
    }

    /// Share of the energy exchanged that the time step may make [–]; none without the ledger, and where the guard is off.
    pub fn energy_limit(&self) -> Option<f64> {
        match self.guards.energy {
            Some(EnergyGuard::Share(share)) => Some(share),
            Some(EnergyGuard::Off) => None,
            None => self.keeps_ledger().then_some(self.time.contacts.most_energy()),
        }
    }
}

/// Default share of the critical step [–].
pub const SAFETY: f64 = 0.5;

/// The same where nothing rubs and a linear law has a restitution above [`ELASTIC`] [–].
pub const SAFETY_ELASTIC: f64 = 0.2;

/// Restitution above which grains of a linear law keep what the time step makes [–].
pub const ELASTIC: f64 = 0.9;
