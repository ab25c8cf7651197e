//! Particles that have gone back through the inlet that they came by, and are taken out of the calculation.

use crate::model::{Halt, Model, Partner};
use crate::neighbours::NeighbourLists;
use crate::passes::zones::cross::{book_leaving, state_back};
use crate::passes::zones::ledger::held_with;
use crate::passes::zones::travel::exclude;
use crate::passes::zones::whole::{rows_with, test_point};
use crate::setup::CameBack;
use crate::state::State;

/// Takes out the particle behind a calculation plane that is in the way of one that comes in; whether that is what stopped the step.
pub fn clear_the_way(model: &Model, state: &mut State, lists: &NeighbourLists, halt: &Halt) -> bool {
    let Halt::InletOverlap { id: newcomer, inlet, partner: Partner::Particle(id), .. } = halt else {
        return false;
    };
    if model.setup.guards.zones != CameBack::IsRemoved {
        return false;
    }
    let Some(member) =
        (0..state.particles.len()).find(|&k| state.particles.id[k] == *id && state.zones.is_free(k))
    else {
        return false;
    };
    // Of a clump, what is tested is its centre.
    let first = rows_with(state, member)[0] as usize;
    let Some((position, radius)) = test_point(state, first) else { return false };
    let behind = state.zones.came_back(first, &position, radius);
    let in_the_way =
        behind.is_some_and(|(by, behind)| by == *inlet && behind > -state.zones.inlets[by as usize].length);
    if in_the_way {
        if model.setup.ledger {
            // The newcomer brings the springs between the two along, already compressed.
            let brought = held_with(state, lists, first, *newcomer);
            state.ledger.entered += brought;
            state.ledger.passed -= brought;
        }
        remove(model, state, lists, first, *inlet);
    }
    in_the_way
}

/// Takes out free particle `k`, with all members of its clump, and counts it for its inlet.
pub fn remove(model: &Model, state: &mut State, lists: &NeighbourLists, k: usize, inlet: u32) {
    state.zones.lost.returned.removed[inlet as usize] += 1;
    if model.setup.ledger {
        let (particle, clump) = state_back(model, state, k, 0.0);
        book_leaving(model, state, k, (&particle, clump.as_ref()), 0.0);
    }
    for member in rows_with(state, k) {
        let member = member as usize;
        if let Some(sleepers) = &mut state.sleepers {
            sleepers.wake_particle(member);
        }
        state.clumps.take(member);
        state.zones.ids.remove(&state.particles.id[member]);
        exclude(model, state, lists, member);
    }
}
