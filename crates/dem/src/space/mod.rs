//! Space.

pub mod rotation;
pub mod search;
