//! Walls on springs.

use geom::Vec3;
use serde::{Deserialize, Serialize};

/// A spring and a dashpot that hold a wall where it is drawn ([`crate::passes::mount`] says how it moves).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Mount {
    /// The direction in which the wall can move [–].
    pub direction: Vec3,
    /// Of the spring [N/m].
    pub stiffness: f64,
    /// Of the dashpot [N·s/m].
    pub damping: f64,
    /// Mass of the wall [kg].
    pub mass: f64,
    /// Largest speed [m/s]: the run stops beyond it.
    pub speed_limit: f64,
}
