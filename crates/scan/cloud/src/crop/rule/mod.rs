//! The rules of a crop beside shapes, each in its file.

pub mod filter;
pub mod grazing;
pub mod ground;
pub mod outer;
pub mod outliers;
pub mod scatter;
