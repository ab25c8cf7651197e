//! Contact history across a cut: read where a particle passes a storage plane, given back where it is free downstream.
//!
//! The record is made at the passage of `id`, whose partner is free then, too: both feel the contact. So it is given back when `id` is
//! free behind the calculation plane, and the partner still on its way in; from then on the contact continues without the record.

use crate::model::Model;
use crate::model::limit::contact_between;
use crate::neighbours::{NeighbourLists, Segment};
use crate::setup::ContactHistory;
use crate::state::State;
use laws::contact::SlotEnd;
use laws::simd::BLOCK;
use std::ops::Range;

/// History of a contact, as the particle at this end sees it.
pub fn history_at(model: &Model, state: &State, segment: &Segment, end: SlotEnd) -> ContactHistory {
    let composition = &model.kinds[segment.kind].composition;
    let columns = composition.columns();
    let number = |c: usize| {
        let n = state.contacts.history_of_slot(segment, end.slot(), c, columns);
        if end.is_second() && composition.flips(c) { -n } else { n }
    };
    let mut history = ContactHistory::default();
    for (listed, recorded) in history_columns(model, segment) {
        for (from, to) in listed.zip(recorded) {
            history.numbers_mut()[to] = number(from);
        }
    }
    history
}

/// The columns of a kind of contact, in the order of its composition.
pub fn columns(model: &Model, segment: &Segment, history: &ContactHistory) -> Vec<f64> {
    let mut columns = vec![0.0; model.kinds[segment.kind].composition.columns()];
    for (listed, recorded) in history_columns(model, segment) {
        columns[listed].copy_from_slice(&history.numbers()[recorded]);
    }
    columns
}

/// Where each field of a kind of contact lies: in the lists, and in a record.
fn history_columns(model: &Model, segment: &Segment) -> Vec<(Range<usize>, Range<usize>)> {
    let (a, b) = model.kinds[segment.kind].between;
    contact_between(&model.setup, a, b).map_or_else(|_| Vec::new(), ContactHistory::ranges)
}

/// Particle `k` is free from now on: its contacts with particles on their way in take their queued histories.
pub fn restore_history(model: &Model, state: &mut State, lists: &mut NeighbourLists, k: usize) {
    let id = state.particles.id[k];
    for (partner, history) in state.zones.take_histories(id) {
        let Some(end) = end_beside(state, lists, k, partner) else { continue };
        let segment = lists.slots.segment_of(end.slot()).clone();
        let composition = &model.kinds[segment.kind].composition;
        let mut columns = columns(model, &segment, &history);
        for (_, number) in
            columns.iter_mut().enumerate().filter(|(c, _)| end.is_second() && composition.flips(*c))
        {
            *number = -*number;
        }
        state.contacts.set_history(&segment, end.slot(), &columns);
        lists.step.active[end.slot() / BLOCK] = true;
    }
}

/// Where particle `k` is listed with a zone particle.
fn end_beside(state: &State, lists: &NeighbourLists, k: usize, partner: u32) -> Option<SlotEnd> {
    let slots = &lists.slots;
    slots.of_particle(k).iter().copied().find(|&end| {
        let wall = slots.segment_of(end.slot()).with.is_wall();
        let other = slots.other(end) as usize;
        !wall && state.particles.id[other] == partner && state.zones.is_prescribed(other)
    })
}
