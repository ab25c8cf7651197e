//! Forces.

pub mod resting;
pub mod sweep;
pub mod tile;
