//! Bonds through cuts: recorded with both particles that pass a storage plane, restored where both come in.
//!
//! A bond needs to know how both ends have turned since they were bonded, and nothing else: a zone particle turns by its zone's motion, in
//! closed form. A bond acts on the first particle that is free while the other is still on its way, as contacts do.

use super::lanes::{Instant, one};
use crate::model::bonds::springs::{numbers, packed};
use crate::model::{BondedPair, GONE, Model, NewBond, Pull};
use crate::setup::CrossingBond;
use crate::state::bonds::row_of;
use crate::state::{Bonds, State};
use nalgebra::UnitQuaternion;
use std::collections::{BTreeMap, BTreeSet};

impl Bonds {
    /// Adds a particle at the end of the columns, turned like this.
    pub fn push(&mut self, turn: UnitQuaternion<f64>) {
        if self.on {
            self.turns.push(row_of(&turn));
        }
    }

    /// How particle `k` has turned; `None` where there are no bonds.
    pub fn turn_of(&self, k: usize) -> Option<UnitQuaternion<f64>> {
        self.on.then(|| self.turn(k))
    }

    /// Numbers of the whole bonds of particle `k`.
    fn whole(&self, k: usize) -> impl Iterator<Item = usize> {
        let of = if self.on { self.starts[k] as usize..self.starts[k + 1] as usize } else { 0..0 };
        self.entries[of].iter().map(|&entry| (entry >> 1) as usize).filter(|&n| self.pairs[n].is_whole())
    }

    /// Elastic energy of the bonds of particle `k` [J].
    pub fn held(&self, k: usize) -> f64 {
        self.whole(k).map(|n| self.pulls[n].elastic).sum()
    }

    /// Particle `k` leaves: its bonds go with it.
    pub fn leave(&mut self, k: usize) {
        let mine: Vec<usize> = self.whole(k).collect();
        for n in mine {
            (self.pairs[n].broken, self.pulls[n]) = (GONE, Pull::default());
        }
    }

    /// Whole bonds of particle `k`, by the ids of the others.
    pub fn crossing(&self, k: usize, ids: &[u32]) -> Vec<CrossingBond> {
        let bond = |n: usize| {
            let (BondedPair { ends: [i, j], .. }, own) = (self.pairs[n], numbers(&self.springs[n]));
            let second = j as usize == k;
            let bond = if second { own.flipped() } else { own };
            CrossingBond { id: ids[k], partner: ids[if second { i } else { j } as usize], bond }
        };
        self.whole(k).map(bond).collect()
    }
}

/// A bond of two particles that come in, in these rows.
fn entering(&CrossingBond { id, partner, bond }: &CrossingBond, rows: [u32; 2]) -> NewBond {
    match id < partner {
        true => NewBond { ends: rows, numbers: bond },
        false => NewBond { ends: [rows[1], rows[0]], numbers: bond.flipped() },
    }
}

/// Makes the queued bonds whose particles are both here now. Those of which one particle has gone are dropped.
pub fn insert_due(model: &Model, state: &mut State) {
    if state.bonds.waiting.is_empty() {
        return;
    }
    let waiting = std::mem::take(&mut state.bonds.waiting);
    let wanted: BTreeSet<u32> = waiting.iter().flat_map(|bond| [bond.id, bond.partner]).collect();
    let here = (0u32..)
        .zip(&state.particles.id)
        .filter(|&(k, id)| wanted.contains(id) && !state.zones.is_gone(k as usize));
    let rows: BTreeMap<u32, u32> = here.map(|(k, &id)| (id, k)).collect();
    let cell = state.cell(model);
    let mut known: BTreeSet<[u32; 2]> = state.bonds.pairs.iter().map(|pair| pair.ends).collect();
    let mut energy = 0.0;
    let is_pending = |id: u32| state.zones.pending.iter().any(|e| e.particle.id == id);
    for bond in waiting {
        let ids = [bond.id, bond.partner];
        let ends = ids.map(|id| rows.get(&id).copied());
        if let [Some(a), Some(b)] = ends {
            let bond = entering(&bond, [a, b]);
            if known.insert(bond.ends) {
                let at = Instant::of(&state.particles, &state.bonds.turns, &cell);
                energy += one(&at, bond.ends, &packed(&bond.numbers)).elastic;
                state.bonds.put(bond);
            }
        } else if ids.iter().zip(ends).all(|(&id, row)| row.is_some() || is_pending(id)) {
            state.bonds.waiting.push(bond);
        }
    }
    state.ledger.entered += energy;
    state.ledger.passed -= energy;
    state.bonds.index(&state.particles.id);
}
