//! The simulation: particles, neighbours, walls, bonds, clumps, zones, integration, energy, checkpoints.
//!
//! It knows nothing of files, TOML or the terminal. SI units throughout. Signs: the unit normal n of a contact points from j to i, an overlap
//! δ > 0 is contact, repulsion is positive. Contact laws and the contact loop are in [`laws`].
//!
//! The folders are layers: each uses only those that stand before it in this list (`tests/tests/structure/` checks it).
//!
//! ```text
//! threads      work shared out
//! space        searching, rotation, the order of wall spheres
//! setup        plain data that a simulation is made of
//! walls        shape × motion → contact points
//! model        what is fixed: resolved once from a setup, checked, with the step that is stable
//! state        what changes: what a checkpoint holds
//! neighbours   lists; a rebuild sorts the particles, and every column follows (`state/row_order.rs`)
//! passes       integrate, clumps, bonds, drag, local damping, servos, springs of walls, sleep, zones, ledger
//! forces       the sweep over tiles: forces, then the move
//! observe      records, snapshots, energy, guards
//! device       steps of a GPU over the same State: the functions of its threads are in [`gpu`]
//! simulation   Simulation { model, state, lists }: new, resume, step, observe, explain
//! ```

#![deny(missing_docs)]

pub mod device;
mod forces;
mod model;
mod neighbours;
mod observe;
mod passes;
pub mod setup;
mod simulation;
mod space;
mod state;
mod threads;
mod walls;

pub use laws::{effects, simd};
pub use model::bonds::find::bonds_at_start;
pub use model::bonds::limit::entries as bonds_of;
pub use model::bonds::one_bond::bond_now;
pub use model::in_range::magnitudes;
pub use model::limit::critical_step;
pub use model::servo::face_distance;
pub use model::start::time_step;
pub use model::{
    Allowed, BondedParticle, BreakMode, CriticalBonds, CriticalDrag, CriticalGrain, CriticalPair,
    CriticalPartner, Entrance, Halt, Limit, OutOfRange, Partner, Pull, Quantity, RepeatedMotion, SetupError,
    StateMismatch, StepCause, Stiffer, Subject,
};
pub use observe::snapshot::Snapshot;
pub use observe::stiffen::{DeepImpact, Impacting, deep_impact};
pub use passes::cell::CellReport;
pub use passes::clumps::instant::ClumpState;
pub use passes::servo::{ServoReport, WallForce};
pub use setup::Setup;
pub use simulation::{Checkpoint, ContactBytes, EffectCost, MatchedDamping, Simulation};
pub use space::mass;
pub use space::rotation::spun;
pub use state::{
    BondState, ContactRecord, Crack, Energy, Held, HeldBack, NoRoom, PartSum, Returned, WallInterval, WallSum,
};
