//! Passes.

pub mod bonds;
pub mod clumps;
pub mod drag;
pub mod instant;
pub mod integrate;
pub mod ledger;
pub mod servo;
pub mod sleep;
pub mod start;
pub mod touching;
pub mod zones;
