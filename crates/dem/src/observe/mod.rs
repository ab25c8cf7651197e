//! Looking.

pub mod energy;
pub mod explain;
pub mod guards;
pub mod record;
pub mod snapshot;
