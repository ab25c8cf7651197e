//! Clumps.

pub mod advance;
pub mod instant;
pub mod zones;
