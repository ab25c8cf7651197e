//! The surroundings of a hole, laid flat: a plane, a raster of it, and which of its cells are open.

pub(crate) mod enclosed;
pub(crate) mod frame;
pub(crate) mod raster;
pub(crate) mod surroundings;
pub(crate) mod thinned;
