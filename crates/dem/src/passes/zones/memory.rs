//! What contacts remember across a cut: read where a particle passes a storage plane, given back where it is free downstream.
//!
//! The record is made at the passage of `id`, whose partner is free then, too: both feel the contact. So it is given back when `id` is
//! free behind the calculation plane, and the partner still on its way in; from then on the contact continues without the record.

use crate::model::Model;
use crate::model::kind::With;
use crate::model::limit::contact_between;
use crate::neighbours::NeighbourLists;
use crate::neighbours::contacts::Segment;
use crate::setup::{ContactHistory, Memory};
use crate::state::State;
use std::ops::Range;

/// Queues the history of a contact of two particles that come in: before the first of them is free, or it has no effect.
pub fn remember(model: &Model, state: &mut State, memory: Memory) {
    let Memory { id, partner, springs } = memory;
    if state.zones.is_entering(id, &model.setup) {
        state.zones.memories.insert((id, partner), springs);
    }
}

/// History of contact `place`, as its first particle sees it, or its second.
pub fn springs(
    model: &Model,
    lists: &NeighbourLists,
    segment: &Segment,
    place: usize,
    second: bool,
) -> ContactHistory {
    let kernel = &model.kinds[segment.kind].kernel;
    let columns = kernel.columns();
    let number = |c: usize| {
        let n = lists.contacts.history_of_slot(segment, place, c, columns);
        if second && kernel.flips(c) { -n } else { n }
    };
    let mut history = ContactHistory::default();
    for (listed, recorded) in history_places(model, segment) {
        for (from, to) in listed.zip(recorded) {
            history.numbers_mut()[to] = number(from);
        }
    }
    history
}

/// The columns of a kind of contact, in the kernel's order.
fn columns(model: &Model, segment: &Segment, history: &ContactHistory) -> Vec<f64> {
    let mut columns = vec![0.0; model.kinds[segment.kind].kernel.columns()];
    for (listed, recorded) in history_places(model, segment) {
        columns[listed].copy_from_slice(&history.numbers()[recorded]);
    }
    columns
}

/// Where each field of a kind of contact lies: in the lists, and in a record.
fn history_places(model: &Model, segment: &Segment) -> Vec<(Range<usize>, Range<usize>)> {
    let (a, b) = model.kinds[segment.kind].between;
    contact_between(&model.setup, a, b).map_or_else(|_| Vec::new(), ContactHistory::places)
}

/// Particle `k` is free from now on: its contacts with particles on their way in take their queued histories.
pub fn restore_history(model: &Model, state: &mut State, lists: &mut NeighbourLists, k: usize) {
    let id = state.particles.id[k];
    for (partner, springs) in state.zones.told(id) {
        let Some((place, second)) = slot_with(model, state, lists, k, partner) else { continue };
        let segment = lists.contacts.segment_of(place).clone();
        let kernel = &model.kinds[segment.kind].kernel;
        let mut columns = columns(model, &segment, &springs);
        for (_, number) in columns.iter_mut().enumerate().filter(|(c, _)| second && kernel.flips(*c)) {
            *number = -*number;
        }
        lists.contacts.set_history(&segment, place, &columns);
    }
}

/// Where particle `k` is listed with one that travels, and whether it is the second there.
fn slot_with(
    model: &Model,
    state: &State,
    lists: &NeighbourLists,
    k: usize,
    partner: u32,
) -> Option<(usize, bool)> {
    let c = &lists.contacts;
    let entries = &c.entries[*c.starts.get(k)? as usize..*c.starts.get(k + 1)? as usize];
    entries.iter().map(|&e| ((e >> 1) as usize, e & 1 == 1)).find(|&(place, second)| {
        let wall = matches!(model.kinds[c.segment_of(place).kind].with, With::Wall(_));
        let other = if second { c.i[place] } else { c.partner[place] } as usize;
        !wall && state.particles.id[other] == partner && state.zones.travels(other)
    })
}
