//! A contact as observers see it.

use geom::Vec3;
use serde::{Deserialize, Serialize};

/// One contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ContactRecord {
    /// Where the two touch [m]; divides the distance of the centres as the radii do. The centre of i where it has left a mesh or the calculation.
    pub point: Vec3,
    /// Unit normal from j to i; zero where i has left a mesh or the calculation.
    pub normal: Vec3,
    /// Force on i [N].
    pub force: Vec3,
    /// Overlap [m]; negative where the two no longer touch.
    pub overlap: f64,
    /// Id of particle i.
    pub i: u32,
    /// Id of particle j, or the number of the wall.
    pub j: u32,
    /// Whether j is a wall.
    pub wall: bool,
    /// What sliding has dissipated in this contact since contacts were recorded last [J]; 0 without the ledger.
    pub work: f64,
}
