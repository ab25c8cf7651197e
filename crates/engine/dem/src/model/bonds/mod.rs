//! Bonds of a setup: which particles they join, the springs and the strength of each, their stable step.
//!
//! `find` looks for pairs, `kinds` makes the numbers of each, `strength` draws what breaks it, `springs` keeps them, `law` has what all kinds do, `now` what one does, `limit` the step
//! (by the `motions` that springs resist).

pub mod find;
pub mod kinds;
pub mod law;
pub mod limit;
mod motions;
pub mod one_bond;
pub mod springs;
mod strength;

use crate::setup::BondNumbers;
use serde::{Deserialize, Serialize};

/// A bond that is made.
#[derive(Debug, Clone, Copy)]
pub struct NewBond {
    /// Rows of i and j; i has the lower id.
    pub(crate) ends: [u32; 2],
    /// What it is.
    pub(crate) numbers: BondNumbers,
}

/// Two particles that are or were bonded.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct BondedPair {
    /// Rows of i and j; i has the lower id.
    pub(crate) ends: [u32; 2],
    /// When their bond broke [s]; infinite while it is whole, `GONE` after one of both has left.
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
    /// Of these rows.
    pub(crate) fn new(ends: [u32; 2]) -> BondedPair {
        BondedPair { ends, broken: f64::INFINITY, mode: BreakMode::Tension }
    }

    pub(crate) fn is_whole(&self) -> bool {
        self.broken == f64::INFINITY
    }
}
