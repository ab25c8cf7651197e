//! Observing: records of contacts, particles and energy of an instant, guards, and what a run takes.
//!
//! Functions of Model, State and lists whose forces are known; nothing that is observed changes. Uses passes and below.

pub mod energy;
pub mod explain;
pub mod guards;
pub mod record;
pub mod snapshot;
