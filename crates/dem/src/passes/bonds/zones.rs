//! Bonds through cuts: recorded with both particles that pass a storage plane, restored where both come in.
//!
//! A bond needs to know how both ends have turned since they were bonded, and nothing else: a traveller turns by its zone's motion, in closed form. It
//! acts on the first of both that is free while the other is still on its way, as contacts do.

use crate::model::Model;
use crate::model::bonds::beam::{Beam, Pull};
use crate::model::bonds::bonded_pair::{BondedPair, GONE};
use crate::setup::Link;
use crate::state::bonds::Bonds;
use crate::state::{ListStatus, State};
use nalgebra::UnitQuaternion;
use std::collections::{BTreeMap, BTreeSet};

impl Bonds {
    /// One comes in at the end of the list, turned like this; `None`: not at all.
    pub fn push(&mut self, turn: Option<UnitQuaternion<f64>>) {
        if self.on {
            self.turns.push(turn.unwrap_or_default());
        }
    }

    /// How particle `k` has turned; `None` where there are no bonds.
    pub fn turn_of(&self, k: usize) -> Option<UnitQuaternion<f64>> {
        self.on.then(|| self.turns[k])
    }

    /// Particle `k` is moved by something else, and has turned like this.
    pub fn put_turn(&mut self, k: usize, turn: UnitQuaternion<f64>) {
        if self.on {
            self.turns[k] = turn;
        }
    }

    /// Places among the bonds of particle `k`, of those that are whole.
    fn whole(&self, k: usize) -> impl Iterator<Item = usize> {
        let of = if self.on { self.starts[k] as usize..self.starts[k + 1] as usize } else { 0..0 };
        self.entries[of]
            .iter()
            .map(|&entry| (entry >> 1) as usize)
            .filter(|&n| self.pairs_bonded[n].is_whole())
    }

    /// Elastic energy of the bonds of particle `k` [J].
    pub fn held(&self, k: usize) -> f64 {
        self.whole(k).map(|n| self.pulls[n].elastic).sum()
    }

    /// Particle `k` leaves: its bonds are no more.
    pub fn leave(&mut self, k: usize) {
        let mine: Vec<usize> = self.whole(k).collect();
        for n in mine {
            (self.pairs_bonded[n].broken, self.pulls[n]) = (GONE, Pull::default());
        }
    }

    /// Whole bonds of particle `k`, by the ids of the others.
    pub fn links(&self, k: usize, ids: &[u32]) -> Vec<Link> {
        let link = |n: usize| {
            let BondedPair { ends: [i, j], beam, strength, .. } = self.pairs_bonded[n];
            let second = j as usize == k;
            Link {
                id: ids[k],
                partner: ids[if second { i } else { j } as usize],
                axis: if second { -beam.axis } else { beam.axis },
                size: [beam.length, beam.radius],
                springs: beam.springs,
                lag: beam.lag,
                strength,
            }
        };
        self.whole(k).map(link).collect()
    }
}

impl BondedPair {
    /// Of two that come in.
    fn new(link: &Link, rows: [u32; 2]) -> BondedPair {
        let Link { id, partner, axis, size, springs, lag, strength } = *link;
        let (ends, axis) = if id < partner { (rows, axis) } else { ([rows[1], rows[0]], -axis) };
        BondedPair { ends, beam: Beam::new(axis, size, springs, lag), strength, broken: f64::INFINITY }
    }
}

/// Says that two are bonded that come in, before the first of them is free; of no effect where it is known, or where there are no bonds.
pub fn link(state: &mut State, link: Link) {
    if state.bonds.on {
        state.bonds.waiting.push(link);
        state.listing.outdate(ListStatus::Outdated);
    }
}

/// Makes bonds of those that are here now; those of which one has gone are forgotten.
pub fn insert_due(model: &Model, state: &mut State) {
    if state.bonds.waiting.is_empty() {
        return;
    }
    let waiting = std::mem::take(&mut state.bonds.waiting);
    let wanted: BTreeSet<u32> = waiting.iter().flat_map(|l| [l.id, l.partner]).collect();
    let here = (0u32..)
        .zip(&state.particles.id)
        .filter(|&(k, id)| wanted.contains(id) && !state.zones.is_gone(k as usize));
    let rows: BTreeMap<u32, u32> = here.map(|(k, &id)| (id, k)).collect();
    let period = model.period();
    let mut known: BTreeSet<[u32; 2]> =
        state.bonds.pairs_bonded.iter().map(|pair_bonded| pair_bonded.ends).collect();
    let mut energy = 0.0;
    for link in waiting {
        let ends = [link.id, link.partner].map(|id| rows.get(&id).copied());
        if let [Some(a), Some(b)] = ends {
            let pair_bonded = BondedPair::new(&link, [a, b]);
            if known.insert(pair_bonded.ends) {
                energy += pair_bonded
                    .beam
                    .pull(&pair_bonded.ends(&state.particles, &state.bonds.turns, &period))
                    .elastic;
                state.bonds.pairs_bonded.push(pair_bonded);
                state.bonds.pulls.push(Pull::default());
            }
        } else if [link.id, link.partner]
            .iter()
            .zip(ends)
            .all(|(&id, row)| row.is_some() || state.zones.waits(id))
        {
            state.bonds.waiting.push(link);
        }
    }
    state.ledger.entered += energy;
    state.ledger.passed -= energy;
    state.bonds.index(&state.particles.id);
}
