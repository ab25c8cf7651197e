//! Zones.

pub mod advance;
pub mod cross;
pub mod enter;
pub mod ledger;
pub mod memory;
pub mod paths;
pub mod returned;
pub mod travel;
pub mod whole;
