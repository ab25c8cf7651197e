//! A wall that follows a force, as a setup asks for it ([`crate::passes::servo`] says how).

use geom::Vec3;
use serde::{Deserialize, Serialize};

/// A force to be followed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Servo {
    /// Which way the wall pushes [–].
    pub direction: Vec3,
    /// Force of the wall on the particles along `direction` [N].
    pub force: f64,
    /// Largest speed [m/s].
    pub speed_limit: f64,
}
