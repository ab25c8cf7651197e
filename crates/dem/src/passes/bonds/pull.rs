//! Forces of bonds, and bonds for observers.

use crate::model::Model;
use crate::model::bonds::beam::Pull;
use crate::model::bonds::tie::{GONE, Tie};
use crate::space::sphere::nearest;
use crate::state::State;
use crate::state::bonds::BondState;

/// Brings bonds to this instant.
pub fn pull_bonds(model: &Model, state: &mut State) {
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
    let of = |(tie, pull): (&Tie, &Pull)| BondState {
        ids: tie.ends.map(|k| p.id[k as usize]),
        middle: middle(tie.ends),
        size: [tie.beam.length, tie.beam.radius],
        broken: tie.broken.is_finite().then_some(tie.broken),
        force: pull.force.into(),
        moments: pull.moment.map(Into::into),
        stress: pull.stress,
    };
    let here = state.bonds.ties.iter().zip(&state.bonds.pulls).filter(|(tie, _)| tie.broken != GONE);
    let mut all: Vec<BondState> = here.map(of).collect();
    all.sort_unstable_by_key(|b| b.ids);
    all
}
