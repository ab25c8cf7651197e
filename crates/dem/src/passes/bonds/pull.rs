//! Forces of bonds, and bonds for observers.

use crate::model::Model;
use crate::model::bonds::beam::Pull;
use crate::model::bonds::bonded_pair::{BondedPair, GONE};
use crate::space::sphere::nearest;
use crate::state::State;
use crate::state::bonds::BondState;

/// Brings bonds to this instant.
pub fn add_bond_forces(model: &Model, state: &mut State) {
    if state.bonds.none() {
        return;
    }
    let (period, time) = (model.period(), state.time());
    state.bonds.pull(&state.particles, &period, (time, state.zones.busy()));
}

/// Bonds of this instant, broken ones as well, by ids.
pub fn bonds(model: &Model, state: &State) -> Vec<BondState> {
    let (p, period) = (&state.particles, model.period());
    let middle = |[i, j]: [u32; 2]| {
        let from = p.position(j as usize);
        model.wrapped(from + nearest(p.position(i as usize) - from, &period) * 0.5)
    };
    let of = |(pair_bonded, pull): (&BondedPair, &Pull)| BondState {
        ids: pair_bonded.ends.map(|k| p.id[k as usize]),
        middle: middle(pair_bonded.ends),
        size: [pair_bonded.beam.length, pair_bonded.beam.radius],
        broken: pair_bonded.broken.is_finite().then_some(pair_bonded.broken),
        force: pull.force.into(),
        moments: pull.moment.map(Into::into),
        stress: pull.stress,
    };
    let here = state
        .bonds
        .pairs_bonded
        .iter()
        .zip(&state.bonds.pulls)
        .filter(|(pair_bonded, _)| pair_bonded.broken != GONE);
    let mut all: Vec<BondState> = here.map(of).collect();
    all.sort_unstable_by_key(|b| b.ids);
    all
}
