//! Geometry for all other crates: vectors, the cell grid, shapes, planes, triangle meshes.

#![deny(missing_docs)]

mod boxes;
pub mod cells;
pub mod digits;
pub mod grid;
pub mod hull;
mod inside;
pub mod mesh;
pub mod moments;
pub mod motion;
pub mod number;
mod numbers;
mod outside;
mod parts;
pub mod plane;
pub mod prism;
mod quadratic;
pub mod quadrature;
pub mod random;
pub mod shape;
mod solid_bounds;
pub mod sphere;
mod spread;
pub mod star;
pub mod transform;
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
pub use parts::Parts;
pub use plane::Plane;
pub use primitives::{Lattice, Shown, Vec3, counted, counted_as};
pub use quadratic::Quadratic;
pub use shape::Shape;
pub use spread::{PrincipalAxes, least_axis};
pub use transform::Transform;

/// Numbers beyond this are no measures: squares and cubes of what is below stay finite.
pub const LARGEST: f64 = 1e100;
