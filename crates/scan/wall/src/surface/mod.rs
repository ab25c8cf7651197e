//! The surface that points and spheres make: its sides, how it bends, and where it leaks.

pub mod bulge;
pub(crate) mod curvature;
pub(crate) mod facing;
pub mod leak;
pub mod normals;
pub mod sheets;
