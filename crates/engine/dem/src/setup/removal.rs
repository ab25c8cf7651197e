//! Regions out of which particles are taken.

use geom::{Shape, Vec3};
use serde::{Deserialize, Serialize};

/// A region with an end: a free particle whose centre is in it at the end of a step is taken out of the calculation; of a rigid clump, its
/// centre of mass counts.
#[derive(Debug, Clone)]
pub struct Removal {
    /// Where.
    pub shape: Shape,
    /// Lowest and highest corner of the shape [m].
    pub bounds: (Vec3, Vec3),
}

impl Removal {
    /// Whether a point [m] is in it.
    pub fn holds(&self, point: &Vec3) -> bool {
        let (low, high) = &self.bounds;
        (0..3).all(|axis| low[axis] <= point[axis] && point[axis] <= high[axis]) && self.shape.contains(point)
    }
}

/// What a region has taken out.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Removed {
    /// How many; a clump counts as one.
    pub count: u64,
    /// Their mass [kg].
    pub mass: f64,
}
