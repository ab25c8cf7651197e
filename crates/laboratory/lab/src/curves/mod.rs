//! From tables to curves, and what they come to.

pub mod series;
pub mod summary;
