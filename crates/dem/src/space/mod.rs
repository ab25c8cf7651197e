//! Positions and rotations: the search for neighbours, turning by a vector, spheres and periods.

#[cfg(not(target_arch = "nvptx64"))]
pub mod cell;
#[cfg(not(target_arch = "nvptx64"))]
pub mod rotation;
#[cfg(not(target_arch = "nvptx64"))]
pub mod search;
pub mod sphere;
