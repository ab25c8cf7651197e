//! The bulk: how full space is of particles, where they are and of which kind.

pub mod porosity;
pub mod profile;
pub mod segregation;
