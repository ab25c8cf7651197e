//! Holes: where they are, how wide, and how small ones could be found.

pub(crate) mod flat;
pub(crate) mod hole;
pub(crate) mod report;
pub(crate) mod search;
pub(crate) mod step;
pub(crate) mod surface;
