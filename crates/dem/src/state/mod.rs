//! State.

pub mod bonds;
pub mod checkpoint;
pub mod clump;
pub mod clumps;
pub mod ledger;
pub mod particles;
pub mod path;
pub mod returned;
pub mod zones;
