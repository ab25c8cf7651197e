//! Point clouds with named columns: formats, crop, outliers, density, holes, ball pivoting, fill.

pub mod formats;
pub mod points;

pub use formats::{ReadError, from_bytes, read, read_mesh, write_mesh, write_ply};
pub use points::Cloud;
