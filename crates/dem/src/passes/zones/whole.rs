//! What passes a plane as one: a sphere, or a rigid clump, whose members come and go together when its centre of mass does.

use crate::model::Model;
use crate::passes::touching::position_before;
use crate::state::State;
use geom::Vec3;

/// Centre and radius [m] of what is tested in the name of particle `k`: its own, or those of the clump (radius 0: only centres of clumps
/// are tested) that it is the first member of; `None` for the other members.
pub fn test_point(state: &State, k: usize) -> Option<(Vec3, f64)> {
    match state.bodies.place_at(k) {
        None => Some((state.particles.position(k), state.particles.rows[k][3])),
        Some((place, true)) => Some((place, 0.0)),
        Some((_, false)) => None,
    }
}

/// The same before the last move, for a particle that no zone moved then.
pub fn test_point_before(model: &Model, state: &State, k: usize) -> (Vec3, f64) {
    match state.bodies.place_before_at(k) {
        None => (position_before(model, state, k), state.particles.rows[k][3]),
        Some(place) => (place, 0.0),
    }
}

/// Rows of all that passes together with particle `k`.
pub fn rows_with(state: &State, k: usize) -> Vec<u32> {
    state.bodies.members_with(k).map_or_else(|| vec![k as u32], <[u32]>::to_vec)
}
