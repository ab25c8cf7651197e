//! Bonds of a setup: which particles they join, the springs and the strength of each, their stable step.
//!
//! `find` looks for pairs, `kinds` makes the numbers of each, `strength` draws what breaks it, `springs` has the law that all kinds follow, `limit` the step
//! (by the `motions` that springs resist).

pub mod find;
pub mod kinds;
pub mod limit;
mod motions;
pub mod springs;
mod strength;

use serde::{Deserialize, Serialize};
use springs::Springs;

/// A bond between two particles.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct BondedPair {
    /// Rows of i and j; i has the lower id.
    pub(crate) ends: [u32; 2],
    pub(crate) springs: Springs,
    /// When it broke [s]; infinite while it is whole, `GONE` after one of both has left.
    pub(crate) broken: f64,
    /// What broke it.
    pub(crate) mode: BreakMode,
}

/// What breaks a bond.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum BreakMode {
    /// Tension at its rim.
    #[default]
    Tension,
    /// Shear.
    Shear,
}

/// Time at which a bond broke that did not break.
pub const GONE: f64 = f64::NEG_INFINITY;

impl BondedPair {
    pub(crate) fn new(ends: [u32; 2], springs: Springs) -> BondedPair {
        BondedPair { ends, springs, broken: f64::INFINITY, mode: BreakMode::Tension }
    }

    pub(crate) fn is_whole(&self) -> bool {
        self.broken == f64::INFINITY
    }

    /// What breaks it at these stresses (tension at the rim, shear, mean tension) [Pa]: that which passes its strength by more.
    pub(crate) fn breaks(&self, [tension, shear, mean]: [f64; 3]) -> Option<BreakMode> {
        let [most, resists] = self.resists(mean);
        match (tension > most, shear > resists) {
            (false, false) => None,
            (true, true) if tension * resists < shear * most => Some(BreakMode::Shear),
            (true, _) => Some(BreakMode::Tension),
            (false, true) => Some(BreakMode::Shear),
        }
    }

    /// Tension and shear that it resists at a mean tension [Pa].
    pub(crate) fn resists(&self, mean: f64) -> [f64; 2] {
        let [tension, shear, friction] = self.springs.numbers.strength;
        [tension, (shear - mean * friction).max(0.0)]
    }
}
