//! What grains did to the spheres and triangles of walls, as a run adds it up over every step (topic `/wall_wear`).
//!
//! [`WallWear`] is a message, [`PartLoads`] sums messages up, [`WearField`] names what is known of a part,
//! [`of_spheres`] and [`of_triangles`] tell which area a part stands for, and [`Archard`] makes a depth of sliding work.
//! Measures list it, pictures colour walls by it: both read it here.

#![deny(missing_docs)]

mod archard;
mod area;
mod field;
mod load;
mod message;

pub use archard::{Archard, HOURS};
pub use area::{of_spheres, of_triangles};
pub use field::WearField;
pub use load::{PartLoad, PartLoads};
pub use message::{PartWear, WallWear};

/// Index of a wall (order of `/surfaces`), and number of a sphere or triangle in it.
pub type Part = (u64, u64);
