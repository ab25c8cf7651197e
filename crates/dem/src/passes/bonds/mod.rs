//! Bonds.

pub mod zones;
