//! Positions and rotations: the search for neighbours and their margins, turning by a vector, spheres, periods and images.

pub mod cell;
pub mod images;
pub mod margins;
#[cfg(not(target_arch = "nvptx64"))]
pub mod order;
#[cfg(not(target_arch = "nvptx64"))]
pub mod rotation;
#[cfg(not(target_arch = "nvptx64"))]
pub mod search;
pub mod sphere;
