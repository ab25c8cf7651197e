//! What contacts do at one instant, and the sliding work that they have done, for observers.

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::neighbours::contact_records::record;
use crate::state::{ContactRecord, State};
use geom::Vec3;

/// All contacts that carry a force, or have done work since the last call: first those that are no longer listed, then in the order of the lists.
pub fn record_contacts(model: &Model, state: &mut State, lists: &NeighbourLists) -> Vec<ContactRecord> {
    let mut out = std::mem::take(&mut state.ended);
    let mut work = std::mem::take(&mut state.contacts.work);
    for segment in &lists.slots.segments {
        for slot in segment.contacts() {
            // A particle that has left at the end of a zone is in the lists until the next rebuild.
            let (i, other) = lists.slots.ends(segment, slot);
            let gone = |k: u32| state.zones.is_gone(k as usize);
            let acts = !gone(i) && !other.is_some_and(gone) && !state.zones.is_idle((i, other));
            let force = if acts { state.contacts.force(slot) } else { Vec3::zeros() };
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
