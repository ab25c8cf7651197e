//! The engine: particles, contacts, effects, integration, neighbours, zones, energy, checkpoints.
//!
//! Signs: the unit normal n of a contact points from j to i, an overlap δ > 0 is contact, repulsion is
//! positive. It knows nothing of files, TOML or the terminal.

mod account;
mod advance;
mod aligned;
mod bodies;
mod bonds;
mod check;
mod contacts;
mod crowd;
mod drag;
pub mod effects;
mod energy;
mod error;
mod explain;
mod guards;
mod images;
mod kernel;
pub mod lane;
mod limit;
mod look;
mod motion;
mod neighbours;
mod number;
mod part;
mod particles;
mod record;
mod relist;
mod seams;
mod servo;
pub mod setup;
mod simulation;
mod sleep;
mod start;
mod state;
mod sums;
mod sweep;
mod touching;
mod walls;
mod zones;

pub use bodies::{BodyState, spun};
pub use bonds::{BondState, entries as bonds_of};
pub use energy::Energy;
pub use error::{Halt, SetupError};
pub use explain::{ContactBytes, EffectCost};
pub use limit::{Limit, critical_step};
pub use look::Snapshot;
pub use particles::mass;
pub use record::ContactRecord;
pub use servo::WallForce;
pub use setup::Setup;
pub use simulation::Simulation;
pub use state::{State, StateView};
pub use zones::Returned;
