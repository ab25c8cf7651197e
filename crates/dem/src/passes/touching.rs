//! What touched a particle in the step before, and with which force.

use crate::model::Model;
use crate::model::kind::With;
use crate::neighbours::NeighbourLists;
use crate::neighbours::contacts::Segment;
use crate::neighbours::ends::partner;
use crate::passes::zones::memory::springs;
use crate::setup::Touch;
use crate::state::State;
use geom::Vec3;

/// Where particle `k` was before the last move [m].
pub fn position_before(model: &Model, state: &State, k: usize) -> Vec3 {
    let (row, a) = (&state.particles.rows[k], &state.particles.acceleration[k]);
    let (dt, square) = (model.dt, 0.5 * model.dt * model.dt);
    let back = |axis: usize| row[axis] - (dt * row[4 + axis] - square * a[axis]);
    Vec3::new(back(0), back(1), back(2))
}

/// Contacts of particle `k` in the step before the last move, with their forces on it.
pub fn touching(model: &Model, state: &State, lists: &NeighbourLists, k: usize) -> Vec<Touch> {
    // A listing since then would have other places: crossings are found before it.
    let c = &lists.contacts;
    let (Some(&from), Some(&to)) = (c.starts.get(k), c.starts.get(k + 1)) else {
        return Vec::new();
    };
    let of = |&entry: &u32| {
        let (place, second) = ((entry >> 1) as usize, entry & 1 == 1);
        let force = c.force(place);
        if force == Vec3::zeros() {
            return None;
        }
        let segment = c.segment_of(place);
        let normal = normal(model, state, lists, segment, place);
        let force = if second { -force } else { force };
        let along = normal * force.dot(&normal);
        let partner = match model.kinds[segment.kind].with {
            With::Wall(_) => None,
            _ if second => Some(c.i[place]),
            _ => Some(c.partner[place]),
        };
        let partner = partner.map(|p| state.particles.id[p as usize]);
        let springs = springs(model, lists, segment, place, second);
        let id = state.particles.id[k];
        Some(Touch { id, partner, normal: along, tangential: force - along, springs })
    };
    c.entries[from as usize..to as usize].iter().filter_map(of).collect()
}

fn normal(model: &Model, state: &State, lists: &NeighbourLists, segment: &Segment, place: usize) -> Vec3 {
    let i = position_before(model, state, lists.contacts.i[place] as usize);
    let (j, _) = partner(model, state, lists, segment, place, |k| position_before(model, state, k));
    (i - j).try_normalize(0.0).unwrap_or_else(Vec3::zeros)
}
