//! Bonds.

pub mod beam;
pub mod find;
pub mod limit;
