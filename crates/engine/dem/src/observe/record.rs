//! What contacts do at one instant, and the sliding work that they have done, for observers.

use crate::model::{Model, With};
use crate::neighbours::{NeighbourLists, Segment};
use crate::state::State;
use geom::Vec3;
use laws::space::sphere::FAR;

/// One contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactRecord {
    /// Where the two touch [m]; divides the distance of the centres as the radii do. The centre of i where it has left a mesh.
    pub point: Vec3,
    /// Unit normal from j to i; zero where i has left a mesh.
    pub normal: Vec3,
    /// Force on i [N].
    pub force: Vec3,
    /// Overlap [m]; negative where the two no longer touch.
    pub overlap: f64,
    /// Id of particle i.
    pub i: u32,
    /// Id of particle j, or the number of the wall.
    pub j: u32,
    /// Whether j is a wall.
    pub wall: bool,
    /// What sliding has dissipated in this contact since contacts were recorded last [J]; 0 without the ledger.
    pub work: f64,
}

/// All contacts that carry a force, or have done work since the last call, in the order of the lists.
pub fn record_contacts(model: &Model, state: &mut State, lists: &NeighbourLists) -> Vec<ContactRecord> {
    let mut work = std::mem::take(&mut state.contacts.work);
    let mut out = Vec::new();
    for segment in &lists.slots.segments {
        for slot in segment.contacts() {
            // A particle that has left at the end of a zone is in the lists until the next rebuild.
            let (i, other) = lists.slots.ends(segment, slot);
            let gone = |k: u32| state.zones.is_gone(k as usize);
            if gone(i) || other.is_some_and(gone) || state.zones.is_idle((i, other)) {
                continue;
            }
            let force = state.contacts.force(slot);
            let done = work.get_mut(slot).map_or(0.0, std::mem::take);
            if force != Vec3::zeros() || done != 0.0 {
                let record = record(model, state, lists, segment, slot);
                out.push(ContactRecord { force, work: done, ..record });
            }
        }
    }
    state.contacts.work = work;
    out
}

/// Where a contact is, without what it does.
fn record(
    model: &Model,
    state: &State,
    lists: &NeighbourLists,
    segment: &Segment,
    slot: usize,
) -> ContactRecord {
    let (p, i) = (&state.particles, lists.slots.i[slot] as usize);
    let (centre, mine) = (p.position(i), p.rows[i].radius());
    let (other, radius) = lists.partner(p, segment, slot, |k| p.position(k));
    // A mesh that the particle has left since has no point that is nearest to it: the record has the particle's centre.
    let gone = other.x.abs() >= FAR[0][0];
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
