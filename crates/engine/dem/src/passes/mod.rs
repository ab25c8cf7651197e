//! What happens to particles beside contacts: a pass is a function of Model and of the parts of State and lists that it needs.
//!
//! `integrate` moves tiles; `clumps`, `bonds`, `drag`, `servo`, `sleep` and `zones` act only in scenes that ask for them; `ledger` adds up
//! energy where it is kept. `kept` carries contact history from one run to the next. `instant` has velocities of one instant, and gives particles that begin their first acceleration. Uses neighbours and below.

pub mod bonds;
pub mod cell;
pub mod clumps;
pub mod drag;
pub mod earlier_contacts;
pub mod instant;
pub mod integrate;
pub mod ledger;
pub mod local_damping;
pub mod mount;
#[cfg(test)]
mod operations;
pub mod servo;
pub mod sleep;
pub mod touching;
pub mod waking;
pub mod wall_sums;
pub mod zones;
