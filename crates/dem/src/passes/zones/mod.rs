//! Zones: particles that move by a prescribed motion, feel nothing, and act on others.
//!
//! `enter` inserts what is due, `travel` moves zone particles, `cross` finds crossings of storage planes, `paths` follows and records paths,
//! `memory` carries contact history through a cut, `returned` counts what goes back, `ledger` books the energy.

pub mod advance;
pub mod cross;
pub mod enter;
pub mod ledger;
pub mod memory;
pub mod paths;
pub mod returned;
pub mod travel;
pub mod whole;
