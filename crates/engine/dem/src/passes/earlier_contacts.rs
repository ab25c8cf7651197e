//! Contact history from one run to the next: read at the end of a run, given back where another starts from its particles.

use crate::model::{Model, With};
use crate::neighbours::{NeighbourLists, Segment};
use crate::passes::zones::history::{columns, history_at};
use crate::setup::{ContactHistory, KeptContact, KeptPartner};
use crate::state::State;
use laws::contact::SlotEnd;
use laws::simd::BLOCK;
use std::collections::BTreeMap;

/// Contacts that have a history now, in the order of their lists.
pub fn histories<'a>(
    model: &'a Model,
    state: &'a State,
    lists: &'a NeighbourLists,
) -> impl Iterator<Item = KeptContact> + use<'a> {
    let of = |segment: &Segment, slot: usize| {
        let history = history_at(model, state, segment, SlotEnd::new(slot, false));
        let (id, partner) = ends(model, state, lists, segment, slot);
        (!history.is_zero()).then_some(KeptContact { id, partner, history })
    };
    lists.slots.segments.iter().flat_map(move |s| s.contacts().filter_map(move |slot| of(s, slot)))
}

/// Gives the contacts that are listed the histories of an earlier run.
pub fn restore(model: &Model, state: &mut State, lists: &mut NeighbourLists, kept: &[KeptContact]) {
    let known: BTreeMap<(u32, KeptPartner), ContactHistory> =
        kept.iter().map(|k| ((k.id, k.partner), k.history)).collect();
    for segment in lists.slots.segments.clone() {
        for slot in segment.contacts() {
            let (id, partner) = ends(model, state, lists, &segment, slot);
            let seen = |swapped| move |history: &ContactHistory| (*history, swapped);
            let other_way = || match partner {
                KeptPartner::Particle(other) => {
                    known.get(&(other, KeptPartner::Particle(id))).map(seen(true))
                }
                KeptPartner::Wall { .. } => None,
            };
            let Some((history, swapped)) = known.get(&(id, partner)).map(seen(false)).or_else(other_way)
            else {
                continue;
            };
            let composition = &model.kinds[segment.kind].composition;
            let mut numbers = columns(model, &segment, &history);
            for (_, number) in
                numbers.iter_mut().enumerate().filter(|(c, _)| swapped && composition.flips(*c))
            {
                *number = -*number;
            }
            state.contacts.set_history(&segment, slot, &numbers);
            lists.step.active[slot / BLOCK] = true;
        }
    }
}

/// The particle of a contact, and what it touches.
fn ends(
    model: &Model,
    state: &State,
    lists: &NeighbourLists,
    segment: &Segment,
    slot: usize,
) -> (u32, KeptPartner) {
    let (slots, id) = (&lists.slots, &state.particles.id);
    let partner = match segment.with {
        With::Wall(wall) => {
            let element = slots.partner[slot] % model.walls[wall].parts();
            KeptPartner::Wall { wall: wall as u32, element }
        }
        _ => KeptPartner::Particle(id[slots.partner[slot] as usize]),
    };
    (id[slots.i[slot] as usize], partner)
}
