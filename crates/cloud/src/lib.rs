//! Point clouds with named columns: formats, crop, outliers, density, holes, ball pivoting, fill.

pub mod crop;
pub mod density;
pub mod formats;
pub mod largest;
pub mod outliers;
pub mod pivot;
pub mod points;
pub mod regions;
mod sheet;

pub use crop::crop;
pub use formats::{ReadError, from_bytes, read, read_mesh, write_mesh, write_ply};
pub use points::Cloud;
pub use regions::shape;
