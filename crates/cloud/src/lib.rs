//! Point clouds with named columns: formats, crop, outliers, density, holes, ball pivoting, fill.

pub mod points;

pub use points::Cloud;
