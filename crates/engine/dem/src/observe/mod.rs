//! Observing: records of contacts, particles and energy of an instant, and guards.
//!
//! Functions of Model, State and lists whose forces are known; nothing that is observed changes. Uses passes and below.

pub mod guards;
pub mod record;
pub mod snapshot;
pub mod stiffen;
pub mod unbalanced;
