//! Zones: particles that move by a prescribed motion, feel nothing, and act on others.
//!
//! `enter` inserts what is due where there is `room` for it, `travel` moves zone particles, `cross` finds crossings of storage planes, `paths` records paths,
//! `history` carries contact history through a cut, `returned` counts what goes back, `removed` takes it out, `removal` takes out what is in a region, `ledger` books the energy, `held_back` what a cut does to the stream.

pub mod cross;
pub mod enter;
pub mod held_back;
pub mod history;
pub mod idle_contacts;
pub mod ledger;
pub mod paths;
pub mod removal;
pub mod removed;
pub mod returned;
pub mod room;
pub mod travel;
pub mod whole;
