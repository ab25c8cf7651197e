//! What passes a plane as one: a sphere, or a rigid clump, whose members come and go together when its centre of mass does.

use crate::simulation::Simulation;
use geom::Vec3;

impl Simulation {
    /// Centre and radius [m] of what is tested in the name of particle `k`: its own, or those of the clump (radius 0: only centres of clumps
    /// are tested) that it is the first member of; `None` for the other members.
    pub(crate) fn tested(&self, k: usize) -> Option<(Vec3, f64)> {
        match self.bodies.place_at(k) {
            None => Some((self.particles.position(k), self.particles.rows[k][3])),
            Some((place, true)) => Some((place, 0.0)),
            Some((_, false)) => None,
        }
    }

    /// The like before the last move, for one that was not moved by a zone then.
    pub(crate) fn tested_before(&self, k: usize) -> (Vec3, f64) {
        match self.bodies.place_before_at(k) {
            None => (self.position_before(k), self.particles.rows[k][3]),
            Some(place) => (place, 0.0),
        }
    }

    /// Rows of all that passes together with particle `k`.
    pub(crate) fn together(&self, k: usize) -> Vec<u32> {
        self.bodies.members_with(k).map_or_else(|| vec![k as u32], <[u32]>::to_vec)
    }
}
