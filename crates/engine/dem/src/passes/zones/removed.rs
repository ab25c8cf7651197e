//! Free particles that are taken out of the calculation; those that have gone back through the inlet that they came by: once they are through its
//! whole zone, or where they are in the way of one that comes in.

use crate::model::{Entrance, Halt, Model, Partner};
use crate::neighbours::NeighbourLists;
use crate::passes::zones::cross::book_leaving;
use crate::passes::zones::travel::exclude;
use crate::passes::zones::whole::{rows_with, test_point};
use crate::setup::CameBack;
use crate::state::{Direction, State};

/// Takes out the particles that are in the way of those that have just been added, from row `first` on: before any force between the two,
/// which would drive a newcomer that brought no energy for that. The lists are those of before.
pub fn make_room(model: &Model, state: &mut State, lists: &NeighbourLists, first: usize) {
    if model.setup.guards.zones != CameBack::IsRemoved || !state.zones.lost.any {
        return;
    }
    let added = state.zones.zone_particles.iter().filter(|t| t.at as usize >= first);
    let newcomers: Vec<(usize, u32)> = added
        .filter_map(
            |t| if let Direction::In(inlet) = t.direction { Some((t.at as usize, inlet)) } else { None },
        )
        .collect();
    for k in 0..first {
        for &(newcomer, inlet) in &newcomers {
            if state.zones.is_free(k) && too_deep(model, state, k, newcomer) {
                remove_behind(model, state, lists, k, inlet);
            }
        }
    }
}

/// Whether two particles overlap by more than the guard allows.
fn too_deep(model: &Model, state: &State, i: usize, j: usize) -> bool {
    let (a, b) = (&state.particles.rows[i], &state.particles.rows[j]);
    let apart = model.cell().nearest(a.position() - b.position());
    a.radius() + b.radius() - apart.norm() > model.setup.guards.overlap * a.radius().min(b.radius())
}

/// Takes out the particle behind a calculation plane that one on its way in has run into; whether that is what stopped the step.
pub fn clear_the_way(model: &Model, state: &mut State, lists: &NeighbourLists, halt: &Halt) -> bool {
    let Halt::InletOverlap { by: Entrance::Inlet(inlet), partner: Partner::Particle(id), .. } = halt else {
        return false;
    };
    if model.setup.guards.zones != CameBack::IsRemoved {
        return false;
    }
    let is_free = |&k: &usize| state.particles.id[k] == *id && state.zones.is_free(k);
    let found = (0..state.particles.len()).find(is_free);
    found.is_some_and(|k| remove_behind(model, state, lists, k, *inlet))
}

/// Takes out free particle `k` if it came by that inlet and is behind its calculation plane; whether it was.
fn remove_behind(model: &Model, state: &mut State, lists: &NeighbourLists, k: usize, inlet: u32) -> bool {
    // Of a clump, what is tested is its centre.
    let first = rows_with(state, k)[0] as usize;
    let Some((position, radius)) = test_point(state, first) else { return false };
    let behind = state.zones.came_back(first, &position, radius);
    let removes =
        behind.is_some_and(|(by, behind)| by == inlet && behind > -state.zones.inlets[by as usize].length);
    if removes {
        remove(model, state, lists, first, inlet);
    }
    removes
}

/// Takes out free particle `k`, with all members of its clump, and counts it for its inlet.
pub fn remove(model: &Model, state: &mut State, lists: &NeighbourLists, k: usize, inlet: u32) {
    state.zones.lost.returned.removed[inlet as usize] += 1;
    take_out(model, state, lists, k);
}

/// Takes out free particle `k`, with all members of its clump.
pub fn take_out(model: &Model, state: &mut State, lists: &NeighbourLists, k: usize) {
    if model.setup.ledger {
        book_leaving(model, state, k);
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
