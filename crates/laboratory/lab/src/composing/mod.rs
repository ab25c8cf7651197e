//! From a sample to the scenes of its preparation and its test.

pub(crate) mod compose;
pub mod scenes;
pub(crate) mod walls;
