//! The part of a tile that rests: found once, and again only when a particle in the tile or beside it falls asleep or wakes.
//!
//! The sum of the loads of contacts that rest is kept for each particle; other contacts are added to it, in the order of their places. So
//! the order of a sum depends on the lists and on which particles sleep, and on nothing else.

use crate::forces::tile::TileInputs;
use crate::kernel::sums::Sums;
use crate::neighbours::resting::RestingTile;
use crate::neighbours::slices::TileSlice;
use crate::passes::sleep::runs;
use crate::simd::BLOCK;
use crate::state::sleepers::SleepMap;

impl RestingTile {
    /// Loads of the contacts of a tile, and their sums; true when an overlap passes the limit.
    pub fn compute(&mut self, part: &mut TileSlice, seen: TileInputs, sums: &mut Sums) -> bool {
        let (lists, inputs) = seen;
        let Some(known) = inputs.known.filter(|_| !lists.new) else {
            (self.found, self.unchanged) = (None, false);
            sums.clear();
            return (0..part.segments.len()).fold(false, |any, k| any | part.compute(k, seen, sums));
        };
        self.unchanged = self.holds(&known);
        if self.unchanged {
            if self.rest.0.is_empty() { sums.clear() } else { sums.put(&self.rest) }
        } else {
            self.find(known, part, seen, sums);
        }
        let (mut deep, mut refreshes) = (false, None);
        for (k, places) in &self.busy {
            let s = &part.segments[*k];
            // A segment may have several runs that do not rest: its contact points are found once.
            if refreshes.replace(*k) != Some(*k) {
                part.refresh(s, lists, inputs);
            }
            deep |= part.compute_slots(s, places.clone(), seen, sums);
        }
        deep
    }

    /// Adds loads that were computed before, in the same order.
    pub fn recall(&mut self, part: &mut TileSlice, seen: TileInputs, sums: &mut Sums) {
        match seen.1.known.filter(|_| !seen.0.new) {
            Some(known) => self.find(known, part, seen, sums),
            None => {
                sums.clear();
                self.busy = part.segments.iter().map(|s| s.places.clone()).enumerate().collect();
            }
        }
        for (k, places) in &self.busy {
            part.recall(&part.segments[*k], places.clone(), seen, sums);
        }
        (self.found, self.unchanged) = (None, false);
    }

    fn holds(&self, known: &SleepMap) -> bool {
        let since = |found: u64| move |&t: &u32| known.changed.get(t as usize).is_some_and(|&c| c <= found);
        self.found.is_some_and(|found| self.near.iter().all(since(found)))
    }

    fn find(&mut self, known: SleepMap, part: &mut TileSlice, seen: TileInputs, sums: &mut Sums) {
        let (lists, asleep) = (seen.0, known.asleep);
        self.found = Some(known.turns);
        self.busy.clear();
        sums.clear();
        let mut some = false;
        for (k, s) in part.segments.iter().enumerate() {
            let rests: Vec<bool> =
                (s.places.start / BLOCK..s.places.end / BLOCK).map(|b| lists.rests(b, asleep)).collect();
            for run in runs(&rests) {
                let places = s.places.start + run.start * BLOCK..s.places.start + run.end * BLOCK;
                if rests[run.start] {
                    some = true;
                    part.recall(s, places.clone(), seen, sums);
                    part.clear_ledger(places);
                } else {
                    self.busy.push((k, places));
                }
            }
        }
        self.rest.0.clear();
        self.rest.1.clear();
        if some {
            self.rest.0.extend_from_slice(sums.loads);
            self.rest.1.extend_from_slice(sums.torques);
        }
        let sleeps = &asleep[sums.first..sums.first + sums.len()];
        self.awake = runs(sleeps).filter(|run| !sleeps[run.start]).collect();
        let disturbed = |k: &u32| sleeps[*k as usize] && lists.disturbed(sums.first + *k as usize, asleep);
        self.disturbed = (0..sleeps.len() as u32).filter(disturbed).collect();
    }
}
