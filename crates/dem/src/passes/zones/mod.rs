//! Zones.

pub mod cross;
pub mod enter;
pub mod ledger;
pub mod memory;
pub mod travel;
pub mod whole;
