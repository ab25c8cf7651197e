//! The engine: particles, contacts, effects, integration, neighbours, zones, energy, checkpoints.
//!
//! Signs: the unit normal n of a contact points from j to i, an overlap δ > 0 is contact, repulsion is
//! positive.

pub mod setup;
