//! Rows as vectors.

use super::number::{Layout, numbers_of_force};
use super::{Row, Row4};
use primitives::Vec3;

impl Row {
    /// Centre [m].
    #[inline(always)]
    pub fn position(&self) -> Vec3 {
        Vec3::new(self[0], self[1], self[2])
    }

    /// Velocity [m/s].
    #[inline(always)]
    pub fn velocity(&self) -> Vec3 {
        Vec3::new(self[4], self[5], self[6])
    }

    /// Radius [m].
    #[inline(always)]
    pub fn radius(&self) -> f64 {
        self[3]
    }

    /// 1/m [1/kg].
    #[inline(always)]
    pub fn inverse_mass(&self) -> f64 {
        self[7]
    }
}

impl Row4 {
    /// A vector, and 0.
    #[inline(always)]
    pub fn of(v: Vec3) -> Row4 {
        Row4([v.x, v.y, v.z, 0.0])
    }

    /// The vector.
    #[inline(always)]
    pub fn vector(&self) -> Vec3 {
        Vec3::new(self[0], self[1], self[2])
    }
}

impl Layout {
    /// The first three numbers of the force in `slot`.
    pub fn force_at(self, forces: &[f64], slot: usize) -> Vec3 {
        let first = slot * numbers_of_force(self.rotates);
        Vec3::new(self.get(forces, first), self.get(forces, first + 1), self.get(forces, first + 2))
    }
}
