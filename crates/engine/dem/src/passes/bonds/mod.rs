//! Bonds: a pass before the forces of contacts, which adds to the sums of wrenches when these are known.
//!
//! ```text
//! make_due → [insert_due] → act: pulls of this instant, and what they break → lists, if contacts begin → contacts → Bonds::add
//! ```

pub mod lanes;
pub mod make;
pub mod zones;

use crate::model::bonds::springs::{breaks, numbers, replaces_contact};
use crate::model::{BondedPair, GONE, Model, Pull, Springs};
use crate::neighbours::NeighbourLists;
use crate::passes::bonds::lanes::{BondChunk, Instant};
use crate::state::bonds::CHUNK;
use crate::state::{BondState, Bonds, Crack, ListStatus, State};
use crate::threads::{FEW, share};
use laws::contact::LEDGER;
use laws::simd::compiled::{self, Registers};

/// Brings bonds to this instant: those that break do nothing any more. None breaks while both of its particles are in zones, where nothing acts on them.
pub fn act(model: &Model, state: &mut State) {
    if state.bonds.none() {
        return;
    }
    let (cell, time) = (state.cell(model), state.time());
    let State { bonds, particles, zones, clusters, listing, steps, .. } = state;
    let Bonds { pairs, springs, pulls, turns, .. } = bonds;
    let at = Instant::of(particles, turns, &cell);
    let chunks = pairs.chunks(CHUNK).zip(springs.chunks(CHUNK)).zip(pulls.chunks_mut(CHUNK));
    let breaking = share(pairs.len() >= FEW / 4, chunks.collect(), |((pairs, springs), pulls)| {
        let chunk = BondChunk { at: &at, pairs, springs, pulls };
        compiled::run::<Registers, _>(model.width, chunk)
    });
    // Lists may be asked for more than once at one instant.
    if bonds.at != Some(*steps) {
        (bonds.at, bonds.lost) = (Some(*steps), 0.0);
        bonds.freed.clear();
    }
    let count = bonds.pairs.len();
    let chunks = (0..count).step_by(CHUNK).zip(breaking).filter(|(_, breaks)| *breaks);
    for n in chunks.flat_map(|(first, _)| first..count.min(first + CHUNK)) {
        let (pair, springs, pull) = (&mut bonds.pairs[n], &bonds.springs[n], &mut bonds.pulls[n]);
        let travel = pair.ends.iter().all(|&k| zones.prescribed.get(k as usize) == Some(&true));
        let broken = breaks(springs, pull.stress).filter(|_| pair.is_whole() && !travel);
        let Some(mode) = broken else { continue };
        (pair.broken, pair.mode) = (time, mode);
        let ids = pair.ends.map(|k| particles.id[k as usize]);
        let [a, b] = pair.ends.map(|k| particles.position(k as usize));
        let arm = cell.nearest(a - b);
        bonds.cracks.push(Crack {
            time,
            ids,
            clusters: ids.map(|id| crate::setup::bond::cluster_of(clusters, id)),
            place: cell.wrapped(b + arm * 0.5),
            normal: arm.normalize(),
            radius: numbers(springs).size[1],
            mode,
            energy: pull.elastic,
        });
        bonds.lost += pull.elastic;
        *pull = Pull { stress: pull.stress, ..Pull::default() };
        if replaces_contact(springs) {
            bonds.freed.push(ids);
            listing.outdate(ListStatus::Outdated);
        }
    }
    bonds.freed.sort_unstable();
}

/// Elastic energy that the contacts hold which begin at this instant because bonds broke [J].
pub fn freed_energy(state: &State, lists: &NeighbourLists) -> f64 {
    let (freed, slots, ids) = (&state.bonds.freed, &lists.slots, &state.particles.id);
    let mut energy = 0.0;
    if freed.is_empty() {
        return energy;
    }
    for segment in slots.segments.iter().filter(|s| !s.with.is_wall()) {
        for slot in segment.contacts() {
            let [a, b] = [slots.i[slot], slots.partner[slot]].map(|k| ids[k as usize]);
            if freed.binary_search(&[a.min(b), a.max(b)]).is_ok() {
                energy += state.contacts.ledger[slot * LEDGER];
            }
        }
    }
    energy
}

/// Bonds of this instant, broken ones as well, by ids.
pub fn bonds(model: &Model, state: &State) -> Vec<BondState> {
    let (p, cell) = (&state.particles, state.cell(model));
    let middle = |[i, j]: [u32; 2]| {
        let from = p.position(j as usize);
        cell.wrapped(from + cell.nearest(p.position(i as usize) - from) * 0.5)
    };
    let of = |((pair, pull), springs): ((&BondedPair, &Pull), &Springs)| {
        let bond = numbers(springs);
        let [tension, shear, mean] = pull.stress;
        BondState {
            ids: pair.ends.map(|k| p.id[k as usize]),
            middle: middle(pair.ends),
            size: bond.size,
            broken: pair.broken.is_finite().then_some(pair.broken),
            mode: pair.mode,
            force: pull.force.into(),
            moments: pull.moment.map(Into::into),
            stress: [tension, shear],
            strength: bond.resists(mean),
        }
    };
    let Bonds { pairs, pulls, springs, .. } = &state.bonds;
    let here = pairs.iter().zip(pulls).zip(springs).filter(|((pair, _), _)| pair.broken != GONE);
    let mut all: Vec<BondState> = here.map(of).collect();
    all.sort_unstable_by_key(|b| b.ids);
    all
}

/// Cracks since the last call, by time and ids.
pub fn take_cracks(state: &mut State) -> Vec<Crack> {
    let mut cracks = std::mem::take(&mut state.bonds.cracks);
    cracks.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.ids.cmp(&b.ids)));
    cracks
}
