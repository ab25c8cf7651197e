//! The mesh over a hole: ball pivoting or a field of signed distances, under a smooth height.

pub(crate) mod cover;
mod pivot;
mod spline;
mod volume;
