//! Walls: forces on them, their wear, and impacts.

mod filter;
pub mod impact;
pub mod wall_force;
pub mod wear;
