//! Shape: the surface of heaps, beds and burdens.

pub mod bed;
pub mod radial;
pub mod repose;
mod sector;
