//! Vectors, poses, cells and numbers in messages, without the standard library: what a GPU knows, too.

#![deny(missing_docs)]
#![no_std]

extern crate alloc;

mod lattice;
mod pose;
mod shown;

pub use lattice::Lattice;
pub use pose::{Pose, SurfaceMotion};
pub use shown::{Shown, counted, counted_as};

/// A point or vector of three `f64` [m, m/s, …].
pub type Vec3 = nalgebra::Vector3<f64>;
