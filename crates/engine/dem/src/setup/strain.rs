//! How the periodic cell is strained.

use crate::setup::Target;
use serde::{Deserialize, Serialize};

/// What one axis of the periodic cell follows ([`crate::passes::cell`] says how). Compression is positive.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Strain {
    /// Logarithmic strain ln(h₀/h) that grows at this rate [1/s].
    Rate(f64),
    /// Logarithmic strain over time [–], 0 at t = 0.
    Path(Target),
    /// Mean stress of contacts and bonds over time [Pa].
    Stress {
        /// [Pa].
        target: Target,
        /// Largest rate of strain [1/s].
        rate_limit: f64,
    },
}

impl Strain {
    /// Strain at `time` [s] where it is prescribed.
    pub fn prescribed(&self, time: f64) -> Option<f64> {
        match self {
            Strain::Rate(rate) => Some(rate * time),
            Strain::Path(path) => Some(path.at(time)),
            Strain::Stress { .. } => None,
        }
    }

    /// Stress that is wanted at `time` [Pa], and the largest rate [1/s].
    pub fn stress(&self, time: f64) -> Option<(f64, f64)> {
        match self {
            Strain::Stress { target, rate_limit } => Some((target.at(time), *rate_limit)),
            Strain::Rate(_) | Strain::Path(_) => None,
        }
    }
}
