//! Space.

pub mod rotation;
pub mod search;
pub mod sphere;
