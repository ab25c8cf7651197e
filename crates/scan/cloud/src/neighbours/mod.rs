//! Neighbourhoods of points: distances to neighbours, density, spacing, connected points.

pub(crate) mod connected;
pub(crate) mod density;
pub(crate) mod distances;
mod smallest;
pub(crate) mod spacing;
