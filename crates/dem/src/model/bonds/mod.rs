//! Bonds of a setup: which particles they join, the beam of each, their stable step, and what is refused.

pub mod beam;
pub mod find;
pub mod limit;
mod motions;

use beam::Beam;
use serde::{Deserialize, Serialize};

/// A bond between two particles.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct BondedPair {
    /// Rows of i and j; i has the lower id.
    pub(crate) ends: [u32; 2],
    pub(crate) beam: Beam,
    /// σ_c and τ_c [Pa].
    pub(crate) strength: [f64; 2],
    /// When it broke [s]; infinite while it is whole, `GONE` after one of both has left.
    pub(crate) broken: f64,
}

/// Time at which a bond broke that did not break.
pub const GONE: f64 = f64::NEG_INFINITY;

impl BondedPair {
    pub(crate) fn is_whole(&self) -> bool {
        self.broken == f64::INFINITY
    }
}
