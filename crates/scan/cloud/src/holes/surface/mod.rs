//! The surface at a coarse scale, where it ends, and loops of its ends.

pub(crate) mod levels;
pub(crate) mod loops;
pub(crate) mod sheet;
mod surrounded;
