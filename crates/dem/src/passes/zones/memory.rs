//! What contacts remember across a cut: read where a particle passes a storage plane, given back where it is free downstream.
//!
//! The record is made at the passage of `id`, whose partner is free then, too: both feel the contact. So it is given back when `id` is
//! free behind the calculation plane, and the partner still on its way in; from then on the contact goes on by itself.

use crate::model::limit::contact_between;
use crate::neighbours::contacts::Segment;
use crate::neighbours::contacts::With;
use crate::setup::ContactHistory;
use crate::setup::Memory;
use crate::simulation::Simulation;
use std::ops::Range;

impl Simulation {
    /// Says what a contact is to remember of two that come in: before the first of them is free, or it is of no effect.
    pub fn remember(&mut self, memory: Memory) {
        let Memory { id, partner, springs } = memory;
        if self.zones.comes(id, &self.setup) {
            self.zones.memories.insert((id, partner), springs);
        }
    }

    /// History of contact `place`, as its first particle sees it, or its second.
    pub(crate) fn springs(&self, segment: &Segment, place: usize, second: bool) -> ContactHistory {
        let kernel = &self.kinds[segment.kind].kernel;
        let columns = kernel.columns();
        let number = |c: usize| {
            let n = self.contacts.remembered(segment, place, c, columns);
            if second && kernel.flips(c) { -n } else { n }
        };
        let mut history = ContactHistory::default();
        for (listed, recorded) in self.history_places(segment) {
            for (from, to) in listed.zip(recorded) {
                history.numbers_mut()[to] = number(from);
            }
        }
        history
    }

    /// The columns of a kind of contact, in the kernel's order.
    fn columns(&self, segment: &Segment, history: &ContactHistory) -> Vec<f64> {
        let mut columns = vec![0.0; self.kinds[segment.kind].kernel.columns()];
        for (listed, recorded) in self.history_places(segment) {
            columns[listed].copy_from_slice(&history.numbers()[recorded]);
        }
        columns
    }

    /// Where each field of a kind of contact lies: in the lists, and in a record.
    fn history_places(&self, segment: &Segment) -> Vec<(Range<usize>, Range<usize>)> {
        let (a, b) = self.kinds[segment.kind].between;
        contact_between(&self.setup, a, b).map_or_else(|_| Vec::new(), ContactHistory::places)
    }

    /// Particle `k` is free from now on: its contacts with those on their way in remember what they were told.
    pub(crate) fn recollect(&mut self, k: usize) {
        let id = self.particles.id[k];
        for (partner, springs) in self.zones.told(id) {
            let Some((place, second)) = self.contact_with(k, partner) else { continue };
            let segment = self.contacts.segment_of(place).clone();
            let kernel = &self.kinds[segment.kind].kernel;
            let mut columns = self.columns(&segment, &springs);
            for (_, number) in columns.iter_mut().enumerate().filter(|(c, _)| second && kernel.flips(*c)) {
                *number = -*number;
            }
            self.contacts.give_memory(&segment, place, &columns);
        }
    }

    /// Where particle `k` is listed with one that travels, and whether it is the second there.
    fn contact_with(&self, k: usize, partner: u32) -> Option<(usize, bool)> {
        let c = &self.contacts;
        let entries = &c.entries[*c.starts.get(k)? as usize..*c.starts.get(k + 1)? as usize];
        entries.iter().map(|&e| ((e >> 1) as usize, e & 1 == 1)).find(|&(place, second)| {
            let wall = matches!(self.kinds[c.segment_of(place).kind].with, With::Wall(_));
            let other = if second { c.i[place] } else { c.partner[place] } as usize;
            !wall && self.particles.id[other] == partner && self.zones.travels(other)
        })
    }
}
