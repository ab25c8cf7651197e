//! The part of a tile that rests: found once, and again only when a particle in the tile or beside it falls asleep or wakes.
//!
//! The sum of the wrenches of contacts that rest is kept for each particle; other contacts are added to it, in the order of their slots. So
//! the order of a sum depends on the lists and on which particles sleep, and on nothing else.

use crate::forces::tile::TileInputs;
use crate::neighbours::{RestingTile, Segment, SlotRun, TileSlice};
use crate::passes::sleep::runs;
use crate::state::SleepMap;
use laws::contact::Sums;
use laws::simd::BLOCK;

impl RestingTile {
    /// Forces of the contacts of a tile, and their sums; true when an overlap passes the limit.
    pub fn compute(&mut self, slice: &mut TileSlice, inputs: &TileInputs, sums: &mut Sums) -> bool {
        let Some(sleepers) = inputs.sleepers.filter(|_| !inputs.lists.new) else {
            (self.found, self.unchanged) = (None, false);
            sums.clear();
            return (0..slice.segments.len()).fold(false, |any, k| any | slice.compute(k, inputs, sums));
        };
        self.unchanged = self.holds(&sleepers);
        if !self.unchanged {
            self.find(sleepers, slice, inputs, sums);
        } else if self.sums.forces.is_empty() {
            sums.clear();
        } else {
            sums.set(self.sums.slices());
        }
        let (mut deep, mut found) = (false, None);
        for run in &self.active {
            let s = &slice.segments[run.segment];
            // A segment may have several runs that do not rest: its contact points are found once.
            if found.replace(run.segment) != Some(run.segment) {
                slice.find_contact_points(s, inputs);
            }
            deep |= slice.compute_slots(s, run.slots.clone(), inputs, sums);
        }
        deep
    }

    /// Adds wrenches that were computed before, in the same order.
    pub fn add_kept(&mut self, slice: &mut TileSlice, inputs: &TileInputs, sums: &mut Sums) {
        match inputs.sleepers.filter(|_| !inputs.lists.new) {
            Some(sleepers) => self.find(sleepers, slice, inputs, sums),
            None => {
                sums.clear();
                let whole = |(segment, s): (usize, &Segment)| SlotRun { segment, slots: s.slots.clone() };
                self.active = slice.segments.iter().enumerate().map(whole).collect();
            }
        }
        for run in &self.active {
            slice.add_kept(&slice.segments[run.segment], run.slots.clone(), inputs, sums);
        }
        (self.found, self.unchanged) = (None, false);
    }

    fn holds(&self, sleepers: &SleepMap) -> bool {
        let since =
            |found: u64| move |&t: &u32| sleepers.changed.get(t as usize).is_some_and(|&c| c <= found);
        self.found.is_some_and(|found| self.near.iter().all(since(found)))
    }

    fn find(&mut self, sleepers: SleepMap, slice: &mut TileSlice, inputs: &TileInputs, sums: &mut Sums) {
        let (lists, asleep) = (&inputs.lists, sleepers.asleep);
        self.found = Some(sleepers.turns);
        self.active.clear();
        sums.clear();
        let mut any_rests = false;
        for (segment, s) in slice.segments.iter().enumerate() {
            let rests: Vec<bool> =
                (s.slots.start / BLOCK..s.slots.end / BLOCK).map(|b| lists.rests(b, asleep)).collect();
            for run in runs(&rests) {
                let slots = s.slots.start + run.start * BLOCK..s.slots.start + run.end * BLOCK;
                if rests[run.start] {
                    any_rests = true;
                    slice.add_kept(s, slots.clone(), inputs, sums);
                    slice.clear_ledger(slots);
                } else {
                    self.active.push(SlotRun { segment, slots });
                }
            }
        }
        self.sums.set(any_rests.then(|| sums.wrenches.as_ref()));
        let sleeps = &asleep[sums.first..sums.first + sums.particles()];
        self.awake = runs(sleeps).filter(|run| !sleeps[run.start]).collect();
        let disturbed = |k: &u32| sleeps[*k as usize] && lists.disturbed(sums.first + *k as usize, asleep);
        self.disturbed = (0..sleeps.len() as u32).filter(disturbed).collect();
    }
}
