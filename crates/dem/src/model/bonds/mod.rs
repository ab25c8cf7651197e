//! Bonds.

pub mod beam;
pub mod bonded_pair;
pub mod check;
pub mod find;
pub mod limit;
