//! What was measured: data, targets and priors.

pub(crate) mod data;
pub(crate) mod prior;
pub(crate) mod sheet;
pub(crate) mod target;
