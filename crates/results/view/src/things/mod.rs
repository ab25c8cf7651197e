//! What is shown: spheres, clumps, surfaces, and what goes beside them.

pub(crate) mod bodies;
pub(crate) mod chains;
pub(crate) mod extras;
pub(crate) mod outline;
pub(crate) mod outlines;
pub(crate) mod sheet;
pub(crate) mod solid;
pub(crate) mod spheres;
pub(crate) mod surface;
pub(crate) mod wear_state;
