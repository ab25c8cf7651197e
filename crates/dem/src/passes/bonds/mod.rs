//! Bonds: elastic beams between particles, a pass before the move that adds to the sums of wrenches.

pub mod zones;

use crate::model::{BondedPair, GONE, Model, Pull};
use crate::space::sphere::nearest;
use crate::state::{BondState, State};

/// Brings bonds to this instant.
pub fn add_bond_forces(model: &Model, state: &mut State) {
    if state.bonds.none() {
        return;
    }
    let (period, time) = (model.period(), state.time());
    state.bonds.pull(&state.particles, &period, (time, &state.zones.prescribed[..]));
}

/// Bonds of this instant, broken ones as well, by ids.
pub fn bonds(model: &Model, state: &State) -> Vec<BondState> {
    let (p, period) = (&state.particles, model.period());
    let middle = |[i, j]: [u32; 2]| {
        let from = p.position(j as usize);
        model.wrapped(from + nearest(p.position(i as usize) - from, &period) * 0.5)
    };
    let of = |(pair, pull): (&BondedPair, &Pull)| BondState {
        ids: pair.ends.map(|k| p.id[k as usize]),
        middle: middle(pair.ends),
        size: [pair.beam.length, pair.beam.radius],
        broken: pair.broken.is_finite().then_some(pair.broken),
        force: pull.force.into(),
        moments: pull.moment.map(Into::into),
        stress: pull.stress,
    };
    let here = state.bonds.pairs.iter().zip(&state.bonds.pulls).filter(|(pair, _)| pair.broken != GONE);
    let mut all: Vec<BondState> = here.map(of).collect();
    all.sort_unstable_by_key(|b| b.ids);
    all
}
