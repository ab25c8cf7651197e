//! Geometry: how much of a ball or a line lies in a shape, in open and in periodic boxes.

pub mod ball;
pub(crate) mod cells;
pub(crate) mod chord;
pub(crate) mod cubic;
pub mod cylinder;
pub mod extent;
pub mod periodic;
pub mod region;
