//! The keys of a scene, as they are written: one struct for each table, declared with all that people and programs know of each key ([`table`]).
//!
//! [`crate::text`] reads them, [`crate::check`] checks how they go together, [`crate::plan`] turns them into a setup of the engine; [`sections`]
//! lists them for people.

mod bond;
mod calculation;
mod clumps;
mod contact;
mod domain;
mod forms;
mod geometry;
mod grains;
mod material;
mod numbers;
mod particles;
mod place;
mod range;
mod sections;
mod servo;
mod table;
mod value;
mod wall;
mod whole;
mod zones;

pub use bond::*;
pub use calculation::*;
pub use clumps::*;
pub use contact::*;
pub use domain::*;
pub use forms::OneOrMore;
pub use geometry::{PlaneText, ShapeText};
pub use grains::*;
pub use material::*;
pub use particles::*;
pub use place::*;
pub use sections::{Section, reference, rows, sections, sizes};
pub use servo::*;
pub use table::Row;
pub(crate) use table::{Judge, Key, Range, Table};
pub(crate) use value::{KeyValue, TABLES};
pub use wall::*;
pub use zones::*;

use serde::de::{Deserialize, Deserializer};
use table::table;
use value::KeyUnit;

table! {
    /// A scene; docs/reference/scene.md lists its keys. SI units.
    #[derive(Default)]
    SceneKeys section {
        /// Acceleration of free fall.
        gravity: [f64; 3] = absent("none"), "m/s²", Finite, "[0, 0, -9.81]";
        /// Id of the first particle that the scene itself creates; particles of an inlet keep their ids.
        first_id: u32 = absent("0"), "", Within(0.0, 4e9), "1000";
        /// Precision of contacts; see below.
        precision: Arithmetic = absent("\"f64\""), "", Any, "\"mixed\"";
        /// Time.
        time: Time = absent("–"), "", Any, "";
        /// What is written, and when.
        output: Output = absent("–"), "", Any, "";
        /// Extent.
        domain: Domain = absent("–"), "", Any, "";
        /// Search for neighbours.
        neighbours: Neighbours = absent("–"), "", Any, "";
        /// When the run is stopped.
        guards: Guards = absent("–"), "", Any, "";
        /// When particles at rest are passed over.
        sleep: Option<Sleep> = absent("never"), "", Any, "";
        /// The fluid around the particles.
        drag: Option<Drag> = absent("none"), "", Any, "";
        /// Damping of what is not in balance.
        local_damping: Option<LocalDamping> = absent("none"), "", Any, "";
        /// Materials.
        material: Vec<Material> = absent("none"), "", Any, "";
        /// Laws between materials.
        contact: Vec<Contact> = absent("none"), "", Any, "";
        /// Shapes filled with particles at t = 0.
        fill: Vec<Fill> = absent("none"), "", Any, "";
        /// Particles from files.
        particles: Vec<Particles> = absent("none"), "", Any, "";
        /// Insertions.
        insert: Vec<Insert> = absent("none"), "", Any, "";
        /// Walls.
        wall: Vec<Wall> = absent("none"), "", Any, "";
        /// Storage planes with their zones.
        outlet: Vec<Outlet> = absent("none"), "", Any, "";
        /// Shapes that particles are taken out of.
        remove: Vec<Remove> = absent("none"), "", Any, "";
        /// Zones that recorded particles enter by.
        inlet: Vec<Inlet> = absent("none"), "", Any, "";
        /// Bonds between particles that are close at t = 0.
        bond: Vec<Bond> = absent("none"), "", Any, "";
        /// Shapes of rigid clumps.
        clump: Vec<Clump> = absent("none"), "", Any, "";
        /// Rigid clumps at t = 0.
        body: Vec<Body> = absent("none"), "", Any, "";
    }
}

impl<'de> Deserialize<'de> for SceneKeys {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<SceneKeys, D::Error> {
        SceneKeys::read(KeyUnit::of(""), from)
    }
}

impl SceneKeys {
    /// Whether the run keeps the energy ledger. Contacts and wear are written with the work of sliding, which the ledger knows.
    pub fn keeps_ledger(&self) -> bool {
        let Output { energy, contacts, wear, .. } = self.output;
        energy || contacts || wear || self.guards.energy_share().is_some()
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
