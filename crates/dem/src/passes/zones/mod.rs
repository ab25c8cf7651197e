//! Zones: particles that move by a prescribed motion, feel nothing, and act on others.
//!
//! `enter` inserts what is due, `travel` moves zone particles, `cross` finds crossings of storage planes, `paths` records paths,
//! `history` carries contact history through a cut, `returned` counts what goes back, `removed` takes it out, `ledger` books the energy.

pub mod cross;
pub mod enter;
pub mod history;
pub mod ledger;
pub mod muted;
pub mod paths;
pub mod removed;
pub mod returned;
pub mod travel;
pub mod whole;
