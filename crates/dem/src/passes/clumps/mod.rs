//! Clumps.

pub mod advance;
pub mod zones;
