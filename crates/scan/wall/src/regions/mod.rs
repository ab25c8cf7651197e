//! What the surface is like, by region: roughness, material, velocity and wear.

pub mod attributes;
mod error;
pub mod steps;
mod table;
pub mod wear;

pub use error::RegionsError;
pub use table::{Regions, SurfaceAttributes};
