//! Rigid clumps: their shapes, and where they are at t = 0.

pub(in crate::plan) mod placement;
pub(in crate::plan) mod shapes;
