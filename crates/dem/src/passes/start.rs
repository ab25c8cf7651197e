//! Particles that begin to move: velocity Verlet needs the acceleration of the step before.

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::passes::drag::body_acceleration;
use crate::simd::Row4;
use crate::state::State;

/// Gives particles without a past the acceleration of this instant as that of the step before; which they are.
pub fn give_acceleration(model: &Model, state: &mut State, lists: &NeighbourLists) -> Vec<u32> {
    let starting = std::mem::take(&mut state.starting);
    let loads = lists.contacts.sums();
    for k in starting.iter().map(|&k| k as usize) {
        let row = state.particles.rows[k];
        let (force, m) = loads.on(k, row[3]);
        let (mut a, body) = (Row4::default(), body_acceleration(model, state, k));
        for (axis, value) in a.iter_mut().enumerate().take(3) {
            *value = force[axis] * row[7] + body[axis];
        }
        state.particles.acceleration[k] = a;
        if state.particles.rotates() {
            let inverse_inertia = 2.5 * row[7] / (row[3] * row[3]);
            state.particles.turning[k].0 =
                [m[0] * inverse_inertia, m[1] * inverse_inertia, m[2] * inverse_inertia, 0.0];
        }
    }
    state.bodies.prime(&state.particles, &model.setup);
    starting
}
