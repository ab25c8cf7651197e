//! Geometry that every other crate stands on: vectors, the cell grid, shapes, planes, triangle meshes.

pub mod grid;

pub use grid::Grid;

/// A point or vector of three `f64` [m, m/s, …].
pub type Vec3 = nalgebra::Vector3<f64>;
