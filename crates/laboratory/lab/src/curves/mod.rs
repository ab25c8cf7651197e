//! From tables to curves, and what they come to.

pub(crate) mod room;
pub mod series;
pub mod state;
pub mod summary;
