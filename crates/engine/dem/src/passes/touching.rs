//! What touched a particle in the step before, and with which force.

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::passes::zones::history::history_at;
use crate::setup::Touch;
use crate::state::State;
use geom::Vec3;
use laws::contact::SlotEnd;

/// Where particle `k` was before the last move [m].
pub fn position_before(model: &Model, state: &State, k: usize) -> Vec3 {
    let (row, a) = (&state.particles.rows[k], &state.particles.acceleration[k]);
    let (dt, square) = (model.dt, 0.5 * model.dt * model.dt);
    let back = |axis: usize| row[axis] - (dt * row[4 + axis] - square * a[axis]);
    Vec3::new(back(0), back(1), back(2))
}

/// Contacts of particle `k` in the step before the last move, with their forces on it.
pub fn touching(model: &Model, state: &State, lists: &NeighbourLists, k: usize) -> Vec<Touch> {
    // Lists that were rebuilt since then would have other slots: crossings are found before that.
    let slots = &lists.slots;
    let of = |&end: &SlotEnd| {
        let slot = end.slot();
        let force = state.contacts.force(slot);
        if force == Vec3::zeros() {
            return None;
        }
        let segment = slots.segment_of(slot);
        let before = |k: usize| position_before(model, state, k);
        let (partner, _) = lists.partner(&state.particles, segment, slot, before);
        let apart = before(slots.i[slot] as usize) - partner;
        let normal = apart.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        let force = if end.is_second() { -force } else { force };
        let along = normal * force.dot(&normal);
        let partner = (!segment.with.is_wall()).then(|| state.particles.id[slots.other(end) as usize]);
        let history = history_at(model, state, segment, end);
        let id = state.particles.id[k];
        Some(Touch { id, partner, normal: along, tangential: force - along, history })
    };
    slots.of_particle(k).iter().filter_map(of).collect()
}
