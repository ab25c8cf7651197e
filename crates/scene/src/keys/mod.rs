//! The keys of a scene, as they are written: one struct for each table, with defaults.
//!
//! Serde reads them ([`crate::text`]), [`crate::check`] checks their values, [`crate::plan`] turns them into a setup of the engine.

mod calculation;
mod contact;
mod contact_keys;
mod forms;
mod particles;
mod wall;

pub use calculation::*;
pub use contact::*;
pub use particles::*;
pub use wall::*;

use serde::Deserialize;

/// A scene; see CLI.md of the project for an example. SI units.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneKeys {
    /// Acceleration of free fall [m/s²]; absent: none.
    #[serde(default)]
    pub gravity: [f64; 3],
    /// Id of the first particle that the scene itself makes; particles of an inlet keep theirs.
    #[serde(default)]
    pub first_id: u32,
    /// In which precision contacts are computed.
    #[serde(default)]
    pub precision: Arithmetic,
    /// Time.
    #[serde(default)]
    pub time: Time,
    /// What is written, and when.
    #[serde(default)]
    pub output: Output,
    /// Extent.
    #[serde(default)]
    pub domain: Domain,
    /// The fluid around the particles; absent: none.
    pub drag: Option<Drag>,
    /// Search for neighbours.
    #[serde(default)]
    pub neighbours: Neighbours,
    /// When particles at rest are passed over; absent: never.
    pub sleep: Option<Sleep>,
    /// When the run is stopped.
    #[serde(default)]
    pub guards: Guards,
    /// Materials.
    #[serde(default)]
    pub material: Vec<Material>,
    /// Laws between materials.
    #[serde(default)]
    pub contact: Vec<Contact>,
    /// Bonds between particles that are close at t = 0.
    #[serde(default)]
    pub bond: Vec<Bond>,
    /// Shapes of rigid clumps.
    #[serde(default)]
    pub clump: Vec<Clump>,
    /// Rigid clumps at t = 0.
    #[serde(default)]
    pub body: Vec<Body>,
    /// Shapes filled with particles at t = 0.
    #[serde(default)]
    pub fill: Vec<Fill>,
    /// Particles from files.
    #[serde(default)]
    pub particles: Vec<Particles>,
    /// Insertions.
    #[serde(default)]
    pub insert: Vec<Insert>,
    /// Walls.
    #[serde(default)]
    pub wall: Vec<Wall>,
    /// Storage planes with their zones.
    #[serde(default)]
    pub outlet: Vec<Outlet>,
    /// Zones that recorded particles enter by.
    #[serde(default)]
    pub inlet: Vec<Inlet>,
}

/// Default share of the critical step [–].
pub const SAFETY: f64 = 0.5;
