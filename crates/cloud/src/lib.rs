//! Point clouds with named columns: formats, crop, outliers, density, holes, ball pivoting, fill.

mod cover;
pub mod crop;
pub mod crop_rows;
mod darts;
pub mod density;
mod enclosed;
mod examined;
mod few;
pub mod fill;
pub mod findable;
pub mod formats;
mod holes;
pub mod largest;
mod levels;
mod local_spacing;
mod loops;
mod near;
pub mod outer;
pub mod outliers;
mod patch;
pub mod pivot;
pub mod points;
mod raster;
pub mod regions;
mod sheet;
pub mod sparse;
mod surrounded;
pub mod units;
mod volume;

pub use cover::Mesher;
pub use crop::crop;
pub use darts::Method;
pub use fill::fill;
pub use formats::{ReadError, from_bytes, read, read_mesh, write_mesh, write_ply};
pub use points::{Cloud, TooFar};
pub use regions::shape;
