//! Fills holes, and with `for_spacing` also surface that is too sparse.
//!
//! ```text
//! apply    finds the holes and fills each
//! mesh     the surface over a hole
//! darts    points on it
//! sight    drops points that a scanner saw through
//! sparse   points where the scan is too thin
//! ```

mod apply;
mod darts;
mod mesh;
mod settings;
mod sight;
mod sparse;

pub use crate::holes::report::{RegionReport, ScaleReport};
pub use apply::{Filled, HoleReport, Report, fill};
pub use darts::Method;
pub use mesh::cover::Mesher;
pub use settings::{FillError, Settings};
pub use sight::SightReport;
pub use sparse::SparseReport;
