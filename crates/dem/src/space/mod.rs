//! Positions and rotations: the search for neighbours, turning by a vector, spheres and periods.

pub mod cell;
pub mod rotation;
pub mod search;
pub mod sphere;
