//! A wall that follows a force, and where it is ([`crate::passes::servo`] moves it).

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
