//! Bonds of a setup: which particles they join, the beam of each, their stable step, and what is refused.

pub mod beam;
pub mod bonded_pair;
pub mod check;
pub mod find;
pub mod limit;
