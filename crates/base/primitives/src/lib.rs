//! Vectors, poses, cells, spheres, triangles, the search of trees, and numbers in messages, without the standard library: what a GPU knows, too.

#![deny(missing_docs)]
#![no_std]

extern crate alloc;

mod box_tree;
mod lattice;
mod pose;
mod shown;
mod sphere;
mod triangle;

pub use box_tree::BoxTree;
pub use lattice::Lattice;
pub use pose::{Pose, SurfaceMotion};
pub use shown::{Shown, counted, counted_as};
pub use sphere::volume;
pub use triangle::{Feature, closest_feature, closest_point};

/// A point or vector of three `f64` [m, m/s, …].
pub type Vec3 = nalgebra::Vector3<f64>;
