//! Bonds.

pub mod beam;
pub mod check;
pub mod find;
pub mod limit;
pub mod tie;
