//! Where a contact is, for records; and those with sliding work, before lists are rebuilt that may no longer hold them.

use crate::model::{Model, With};
use crate::neighbours::{NeighbourLists, Segment};
use crate::state::{ContactRecord, State};
use geom::Vec3;
use laws::space::sphere::FAR;

/// Where a contact is, without what it does.
pub fn record(
    model: &Model,
    state: &State,
    lists: &NeighbourLists,
    segment: &Segment,
    slot: usize,
) -> ContactRecord {
    let (p, i) = (&state.particles, lists.slots.i[slot] as usize);
    let (centre, mine) = (where_it_was(state, i), p.rows[i].radius());
    let (mut other, radius) = lists.partner(p, segment, slot, |k| where_it_was(state, k));
    if segment.with == With::Images {
        // Its row is that of the last forces, and particles may have moved since.
        let of = lists.slots.partner[slot] as usize;
        other = where_it_was(state, of) + state.cell(model).shift(&lists.slots.image[slot]);
    }
    // A mesh that the particle has left since has no point that is nearest to it: the record has the particle's centre.
    let gone = other.x.abs() >= FAR[0][0] || state.zones.is_gone(i);
    let apart = if gone { Vec3::zeros() } else { centre - other };
    let reach = mine + radius;
    let distance = if gone { 2.0 * reach } else { apart.norm() };
    let normal = apart.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
    let (j, wall) = match segment.with {
        With::Wall(w) => (w as u32, true),
        _ => (p.id[lists.slots.partner[slot] as usize], false),
    };
    let point = state.cell(model).wrapped(centre - normal * (mine * distance / reach));
    let (force, overlap) = (Vec3::zeros(), reach - distance);
    ContactRecord { point, normal, force, overlap, i: p.id[i], j, wall, work: 0.0 }
}

/// Where a particle is [m]; of one that has left the calculation since neighbours were listed, where it was then.
fn where_it_was(state: &State, k: usize) -> Vec3 {
    let left = || state.zones.left.iter().find(|(left, _)| *left as usize == k);
    match state.zones.is_gone(k).then(left).flatten() {
        Some((_, home)) => home.vector(),
        None => state.particles.position(k),
    }
}

/// Contacts with sliding work that has not been recorded, by slot, where it is to be; their forces are not known any more.
pub fn with_work(model: &Model, state: &State, lists: &NeighbourLists) -> Vec<(usize, ContactRecord)> {
    if !model.setup.record_sliding || state.contacts.work.is_empty() {
        return Vec::new();
    }
    let work = &state.contacts.work;
    let of = |segment| {
        let one = move |slot: usize| {
            (slot, ContactRecord { work: work[slot], ..record(model, state, lists, segment, slot) })
        };
        Segment::contacts(segment).filter(|&slot| work[slot] != 0.0).map(one)
    };
    lists.slots.segments.iter().flat_map(of).collect()
}
