//! The cloud: positions, every other property as it came, and what looks wrong about them.

mod cloud;
mod crowds;
mod merge;
mod moved;
pub mod places;
pub mod units;

pub use cloud::{Cloud, LengthUnit, ReadWarning, TooFar, viewpoint};
pub(crate) use cloud::{SYSTEM, check_reach, is_viewpoint};
pub use crowds::without_crowds;
pub use merge::{SCAN, merge};
