//! Where a servo is.

use serde::{Deserialize, Serialize};

/// Where a servo is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct ServoState {
    /// Way since t = 0 along the direction [m].
    pub way: f64,
    /// Its rate [m/s].
    pub speed: f64,
    /// Way when neighbours were listed [m].
    pub listed: f64,
}

impl ServoState {
    /// Whether it is anywhere.
    pub fn is_finite(&self) -> bool {
        self.way.is_finite() && self.speed.is_finite()
    }
}
