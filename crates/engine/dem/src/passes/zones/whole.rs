//! What passes a plane as one: a sphere, or a rigid clump, whose members come and go together when its centre of mass does.

use crate::model::Model;
use crate::passes::touching::position_before;
use crate::state::{ClumpMotion, State};
use geom::Vec3;

/// Centre and radius [m] that are tested for particle `k`: its own, or for the first member of a clump the centre of the clump and a radius
/// of 0; `None` for other members.
pub fn test_point(state: &State, k: usize) -> Option<(Vec3, f64)> {
    match state.clumps.body_of(k) {
        None => Some((state.particles.position(k), state.particles.rows[k].radius())),
        Some(clump) => state.clumps.is_first(clump, k).then_some((clump.position, 0.0)),
    }
}

/// The same before the last move, for a particle that no zone moved then.
pub fn test_point_before(model: &Model, state: &State, k: usize) -> (Vec3, f64) {
    match state.clumps.body_of(k) {
        None => (position_before(model, state, k), state.particles.rows[k].radius()),
        Some(clump) => (clump.place_before, 0.0),
    }
}

/// Rows of all that passes together with particle `k`.
pub fn rows_with(state: &State, k: usize) -> Vec<u32> {
    let members = |clump: &ClumpMotion| state.clumps.members[clump.range()].to_vec();
    state.clumps.body_of(k).map_or_else(|| vec![k as u32], members)
}
