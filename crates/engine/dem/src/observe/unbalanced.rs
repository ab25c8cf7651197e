//! How far particles are from equilibrium.

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::passes::bonds;
use crate::passes::drag::body_acceleration;
use crate::state::{Sleepers, State};
use geom::Vec3;

/// Mean unbalanced force over mean contact force [–]: the mean of |F| over all free particles, a clump counting as one, with F the sum of contacts, bonds, weight
/// and fluid, over the mean of |f| over all contacts that carry a force and all whole bonds. Itasca's "ratio of mean unbalanced force to mean contact force"
/// (PFC). `None` where no contact carries a force. Forces of this instant are known, and the wrench of each contact is kept.
pub fn ratio(model: &Model, state: &State, lists: &NeighbourLists) -> Option<f64> {
    let (sums, p) = (state.contacts.sums(), &state.particles);
    let sleeps = |k: usize| state.sleepers.as_ref().is_some_and(|s: &Sleepers| s.sleeps(k));
    let (mut unbalanced, mut bodies) = (0.0, 0u64);
    for k in (0..p.len()).filter(|&k| state.zones.is_free(k) && !state.clumps.is_member(k) && !sleeps(k)) {
        let row = &p.rows[k];
        let force = sums.on(k, row.radius()).0 + body_acceleration(model, state, k) / row.inverse_mass();
        (unbalanced, bodies) = (unbalanced + force.norm(), bodies + 1);
    }
    for (_, clump) in state.clumps.driven_now(model, state, &sums) {
        (unbalanced, bodies) = (unbalanced + clump.forces[1].norm(), bodies + 1);
    }
    let (mut carried, mut contacts) = (0.0, 0u64);
    for segment in &lists.slots.segments {
        for slot in segment.contacts().filter(|&slot| !state.zones.is_idle(lists.slots.ends(segment, slot))) {
            let force = state.contacts.force(slot);
            if force != Vec3::zeros() {
                (carried, contacts) = (carried + force.norm(), contacts + 1);
            }
        }
    }
    for bond in bonds::bonds(model, state).iter().filter(|bond| bond.broken.is_none()) {
        (carried, contacts) = (carried + bond.force.norm(), contacts + 1);
    }
    (carried > 0.0 && bodies > 0).then(|| (unbalanced / bodies as f64) / (carried / contacts as f64))
}
