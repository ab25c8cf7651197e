//! What the points around a point say: distances, density, spacing, and which points are connected.

pub(crate) mod connected;
pub(crate) mod density;
pub(crate) mod distances;
mod smallest;
pub(crate) mod spacing;
