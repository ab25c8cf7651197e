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
//! device                 steps of a GPU over the same State: kernel/thread.rs is what it runs
//! simulation             Simulation { model, state, lists }: new, resume, step, observe, explain
//! ```

// A GPU runs `kernel/thread.rs`, and knows what that uses: laws, lanes and the contact loop.
#![cfg_attr(target_arch = "nvptx64", no_std, feature(core_intrinsics), expect(internal_features))]
#![cfg_attr(target_arch = "nvptx64", allow(dead_code, unused_imports, unused_mut))]

extern crate alloc;
#[cfg(target_arch = "nvptx64")]
extern crate core as std;

#[cfg(not(target_arch = "nvptx64"))]
pub mod device;
pub mod effects;
#[cfg(target_arch = "nvptx64")]
mod float;
#[cfg(not(target_arch = "nvptx64"))]
mod forces;
mod kernel;
#[cfg(not(target_arch = "nvptx64"))]
mod model;
#[cfg(not(target_arch = "nvptx64"))]
mod neighbours;
#[cfg(not(target_arch = "nvptx64"))]
mod observe;
#[cfg(not(target_arch = "nvptx64"))]
mod passes;
#[cfg(not(target_arch = "nvptx64"))]
pub mod setup;
pub mod simd;
#[cfg(not(target_arch = "nvptx64"))]
mod simulation;
mod space;
#[cfg(not(target_arch = "nvptx64"))]
mod state;
#[cfg(not(target_arch = "nvptx64"))]
mod threads;
#[cfg(not(target_arch = "nvptx64"))]
mod walls;

pub use kernel::{device_tables, lists, ported, thread};
#[cfg(not(target_arch = "nvptx64"))]
pub use model::bonds::find::bonds_at_start;
#[cfg(not(target_arch = "nvptx64"))]
pub use model::bonds::limit::entries as bonds_of;
#[cfg(not(target_arch = "nvptx64"))]
pub use model::bonds::now::bond_now;
#[cfg(not(target_arch = "nvptx64"))]
pub use model::in_range::magnitudes;
#[cfg(not(target_arch = "nvptx64"))]
pub use model::limit::critical_step;
#[cfg(not(target_arch = "nvptx64"))]
pub use model::servo::face_distance;
#[cfg(not(target_arch = "nvptx64"))]
pub use model::start::time_step;
#[cfg(not(target_arch = "nvptx64"))]
pub use model::{
    Allowed, BondedParticle, BreakMode, CriticalBonds, CriticalDrag, CriticalGrain, CriticalPair,
    CriticalPartner, Entrance, Halt, Limit, OutOfRange, Partner, Pull, Quantity, RepeatedMotion, SetupError,
    StateMismatch, StepCause, Stiffer, Subject,
};
#[cfg(not(target_arch = "nvptx64"))]
pub use observe::record::ContactRecord;
#[cfg(not(target_arch = "nvptx64"))]
pub use observe::snapshot::Snapshot;
#[cfg(not(target_arch = "nvptx64"))]
pub use observe::stiffen::{DeepImpact, Impacting, deep_impact};
#[cfg(not(target_arch = "nvptx64"))]
pub use passes::cell::CellReport;
#[cfg(not(target_arch = "nvptx64"))]
pub use passes::clumps::instant::ClumpState;
#[cfg(not(target_arch = "nvptx64"))]
pub use passes::servo::{ServoReport, WallForce};
#[cfg(not(target_arch = "nvptx64"))]
pub use setup::Setup;
#[cfg(not(target_arch = "nvptx64"))]
pub use simulation::{Checkpoint, ContactBytes, EffectCost, MatchedDamping, Simulation};
#[cfg(not(target_arch = "nvptx64"))]
pub use space::rotation::spun;
#[cfg(not(target_arch = "nvptx64"))]
pub use space::sphere::mass;
#[cfg(not(target_arch = "nvptx64"))]
pub use state::{BondState, Crack, Energy, Held, HeldBack, Returned};
