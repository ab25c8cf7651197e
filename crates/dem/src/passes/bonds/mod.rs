//! Bonds.

pub mod pull;
pub mod zones;
