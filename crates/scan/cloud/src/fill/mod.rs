//! Fill: points on the surface that spans the holes of a cloud, and where it is sparse.

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
