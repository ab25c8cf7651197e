//! The bound on the time step: safe for every configuration, and not wasteful for those that it is meant for.
//! Derived in docs/theory/time-step.md.

mod crystals;
mod dense;
mod few;
mod refused;
mod trial;
mod vibrating;
