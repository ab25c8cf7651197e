//! Rigid clumps: a pass after the move, which treated their members as if they were free.
//!
//! `advance` moves clumps by the forces on their members and puts these in place; `instant` corrects velocities for observers; `zones` takes
//! clumps through cuts.

pub mod advance;
pub mod instant;
mod members;
pub mod zones;
