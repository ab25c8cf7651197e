//! Point clouds with named columns: formats, crop, outliers, density, holes, ball pivoting, fill.

pub mod crop;
pub mod fill;
pub mod formats;
mod holes;
mod neighbours;
pub mod points;

pub use crop::crop;
pub use fill::{Mesher, Method, fill};
pub use formats::{ReadError, TextColumns, from_bytes, read, read_mesh, write_mesh, write_ply};
pub use points::{Cloud, TooFar, merge};
