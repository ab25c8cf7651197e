//! Which points are neighbours, and the radii that their distances and the roughness ask for.

pub mod dents;
pub mod equation;
pub mod pairs;
pub mod solve;
