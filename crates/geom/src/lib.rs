//! Geometry for all other crates: vectors, the cell grid, shapes, planes, triangle meshes.

mod boxes;
pub mod cells;
pub mod grid;
mod inside;
pub mod mesh;
pub mod moments;
pub mod motion;
pub mod number;
mod numbers;
mod outside;
pub mod plane;
pub mod prism;
mod quadratic;
pub mod random;
pub mod shape;
mod shown;
pub mod sphere;
mod spread;
pub mod star;
mod tree;
pub mod triangle;
mod union;
pub mod units;

pub use boxes::Boxes;
pub use cells::Cells;
pub use grid::Grid;
pub use moments::Moments;
pub use motion::Motion;
pub use numbers::NumbersError;
pub use plane::Plane;
pub use quadratic::Quadratic;
pub use shape::Shape;
pub use shown::Shown;
pub use spread::least_axis;

/// Numbers beyond this are no measures: squares and cubes of what is below stay finite.
pub const LARGEST: f64 = 1e100;

/// A point or vector of three `f64` [m, m/s, …].
pub type Vec3 = nalgebra::Vector3<f64>;
