//! Sleep, as a setup asks for it ([`crate::passes::sleep`] says what it does).

use serde::{Deserialize, Serialize};

/// When particles sleep.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Sleep {
    /// Speed of the surface, |v| + r|ω|, below which a particle is at rest [m/s].
    pub speed: f64,
    /// How long it must have been [s].
    pub time: f64,
    /// Force that wakes it, over its weight [–].
    pub wake: f64,
}
