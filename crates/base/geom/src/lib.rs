//! Geometry for all other crates: vectors, the cell grid, shapes, planes, triangle meshes.

// A GPU knows vectors and poses.
#![cfg_attr(target_arch = "nvptx64", no_std, allow(dead_code))]

#[cfg(target_arch = "nvptx64")]
extern crate core as std;

#[cfg(not(target_arch = "nvptx64"))]
mod boxes;
#[cfg(not(target_arch = "nvptx64"))]
pub mod cells;
#[cfg(not(target_arch = "nvptx64"))]
pub mod digits;
#[cfg(not(target_arch = "nvptx64"))]
pub mod grid;
#[cfg(not(target_arch = "nvptx64"))]
pub mod hull;
#[cfg(not(target_arch = "nvptx64"))]
mod inside;
mod lattice;
#[cfg(not(target_arch = "nvptx64"))]
pub mod mesh;
#[cfg(not(target_arch = "nvptx64"))]
pub mod moments;
#[cfg(not(target_arch = "nvptx64"))]
pub mod motion;
#[cfg(not(target_arch = "nvptx64"))]
pub mod number;
#[cfg(not(target_arch = "nvptx64"))]
mod numbers;
#[cfg(not(target_arch = "nvptx64"))]
mod outside;
#[cfg(not(target_arch = "nvptx64"))]
mod parts;
#[cfg(not(target_arch = "nvptx64"))]
pub mod plane;
#[cfg(not(target_arch = "nvptx64"))]
pub mod prism;
#[cfg(not(target_arch = "nvptx64"))]
mod quadratic;
#[cfg(not(target_arch = "nvptx64"))]
pub mod quadrature;
#[cfg(not(target_arch = "nvptx64"))]
pub mod random;
#[cfg(not(target_arch = "nvptx64"))]
pub mod shape;
#[cfg(not(target_arch = "nvptx64"))]
mod shown;
#[cfg(not(target_arch = "nvptx64"))]
mod solid_bounds;
#[cfg(not(target_arch = "nvptx64"))]
pub mod sphere;
#[cfg(not(target_arch = "nvptx64"))]
mod spread;
#[cfg(not(target_arch = "nvptx64"))]
pub mod star;
#[cfg(not(target_arch = "nvptx64"))]
pub mod transform;
#[cfg(not(target_arch = "nvptx64"))]
mod tree;
#[cfg(not(target_arch = "nvptx64"))]
pub mod triangle;
#[cfg(not(target_arch = "nvptx64"))]
mod union;
#[cfg(not(target_arch = "nvptx64"))]
pub mod units;

#[cfg(not(target_arch = "nvptx64"))]
pub use boxes::Boxes;
#[cfg(not(target_arch = "nvptx64"))]
pub use cells::Cells;
#[cfg(not(target_arch = "nvptx64"))]
pub use grid::Grid;
pub use lattice::Lattice;
#[cfg(not(target_arch = "nvptx64"))]
pub use moments::Moments;
#[cfg(not(target_arch = "nvptx64"))]
pub use motion::Motion;
#[cfg(not(target_arch = "nvptx64"))]
pub use numbers::NumbersError;
#[cfg(not(target_arch = "nvptx64"))]
pub use parts::Parts;
#[cfg(not(target_arch = "nvptx64"))]
pub use plane::Plane;
#[cfg(not(target_arch = "nvptx64"))]
pub use quadratic::Quadratic;
#[cfg(not(target_arch = "nvptx64"))]
pub use shape::Shape;
#[cfg(not(target_arch = "nvptx64"))]
pub use shown::{Shown, counted, counted_as};
#[cfg(not(target_arch = "nvptx64"))]
pub use spread::{PrincipalAxes, least_axis};
#[cfg(not(target_arch = "nvptx64"))]
pub use transform::Transform;

#[cfg(target_arch = "nvptx64")]
#[path = "motion/pose.rs"]
mod pose;
#[cfg(target_arch = "nvptx64")]
pub mod motion {
    //! Where walls are.
    pub use crate::pose::{Pose, SurfaceMotion};
}

/// Numbers beyond this are no measures: squares and cubes of what is below stay finite.
pub const LARGEST: f64 = 1e100;

/// A point or vector of three `f64` [m, m/s, …].
pub type Vec3 = nalgebra::Vector3<f64>;
