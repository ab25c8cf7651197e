//! LAS and LAZ, by the `las` and `laz` crates: claims are checked first, then chunks are read side by side.

mod crs;
mod epsg;
mod extra;
mod packed;
mod read;
mod units;

pub(super) use read::{matches, read};
