//! The engine: particles, contacts, effects, integration, neighbours, zones, energy, checkpoints.
//!
//! It knows nothing of files, TOML or the terminal. SI units throughout. Signs: the unit normal n of a contact points from j to i, an overlap
//! δ > 0 is contact, repulsion is positive.
//!
//! The folders are layers: each uses those above it in this list, and nothing below (`tests/tests/structure.rs` checks it).
//!
//! ```text
//! threads, simd, space   work shared out; lanes; searching, rotation, spheres
//! effects                what a contact does: one file an effect, which describes itself
//! setup                  plain data that a simulation is made of
//! kernel                 the contact loop: gather → geometry → effects → scatter; sums in fixed order
//! walls                  shape × motion → contact points
//! model                  what is fixed: resolved once from a setup, checked, with the step that is stable
//! state                  what changes: what a checkpoint holds
//! neighbours             lists, rebuildable from Model and State
//! passes                 integrate, clumps, bonds, drag, local damping, servos, springs of walls, sleep, zones, ledger
//! forces                 the sweep over tiles: forces, then the move
//! observe                records, snapshots, energy, guards
//! simulation             Simulation { model, state, lists }: new, resume, step, observe, explain
//! ```

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
pub use model::in_range::magnitudes;
pub use model::limit::critical_step;
pub use model::servo::face_distance;
pub use model::start::time_step;
pub use model::{
    Allowed, BondedParticle, BreakMode, CriticalBonds, CriticalDrag, CriticalGrain, CriticalPair,
    CriticalPartner, Halt, Limit, OutOfRange, Partner, Quantity, RepeatedMotion, SetupError, StateMismatch,
    StepCause, Stiffer, Subject,
};
pub use observe::record::ContactRecord;
pub use observe::snapshot::Snapshot;
pub use observe::stiffen::{DeepImpact, deep_impact};
pub use passes::cell::CellReport;
pub use passes::clumps::instant::ClumpState;
pub use passes::servo::{ServoReport, WallForce};
pub use setup::Setup;
pub use simulation::{Checkpoint, ContactBytes, EffectCost, MatchedDamping, Simulation};
pub use space::rotation::spun;
pub use space::sphere::mass;
pub use state::{BondState, Crack, Energy, Held, Returned};
