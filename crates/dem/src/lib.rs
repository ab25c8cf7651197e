//! The engine: particles, contacts, effects, integration, neighbours, zones, energy, checkpoints.
//!
//! Signs: the unit normal n of a contact points from j to i, an overlap δ > 0 is contact, repulsion is
//! positive. It knows nothing of files, TOML or the terminal.

pub mod effects;
mod forces;
mod kernel;
mod model;
mod neighbours;
mod observe;
mod passes;
pub mod setup;
pub mod simd;
mod simulation;
mod space;
mod state;
mod threads;
mod walls;

pub use model::bonds::limit::entries as bonds_of;
pub use model::error::SetupError;
pub use model::halt::Halt;
pub use model::limit::{Limit, critical_step};
pub use observe::explain::{ContactBytes, EffectCost};
pub use observe::record::ContactRecord;
pub use observe::snapshot::Snapshot;
pub use passes::clumps::instant::BodyState;
pub use passes::servo::WallForce;
pub use setup::Setup;
pub use simd as lane;
pub use simulation::{Checkpoint as State, CheckpointView as StateView, Simulation};
pub use space::rotation::spun;
pub use space::sphere::mass;
pub use state::bonds::BondState;
pub use state::energy::Energy;
pub use state::returned::Returned;
