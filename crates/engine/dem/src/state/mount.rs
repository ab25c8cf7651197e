//! Where springs let their walls move.

use serde::{Deserialize, Serialize};

/// Where a wall on a spring is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct MountState {
    /// How far it is shifted along its direction [m].
    pub shift: f64,
    /// Predicted rate of that [m/s].
    pub speed: f64,
    /// Acceleration of the step before [m/s²].
    pub acceleration: f64,
    /// Shift when neighbours were listed [m].
    pub listed: f64,
}
