//! E57, by the `e57` crate: claims are checked first, then every scan is read in its pose.

mod claims;
mod color;
mod extra;
mod point;
mod read;
mod xml;

pub(super) use read::{matches, read};
