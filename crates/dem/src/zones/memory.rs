//! What contacts remember across a cut: read where a particle passes a storage plane, given back where it is free downstream.
//!
//! The record is made at the passage of `id`, whose partner is free then, too: both feel the contact. So it is given back when `id` is
//! free behind the calculation plane, and the partner still on its way in; from then on the contact goes on by itself.

use crate::contacts::{Segment, With};
use crate::explain::parts;
use crate::limit::contact_between;
use crate::setup::{Memory, Springs};
use crate::simulation::Simulation;
use geom::Vec3;

impl Simulation {
    /// Says what a contact is to remember of two that come in: before the first of them is free, or it is of no effect.
    pub fn remember(&mut self, memory: Memory) {
        let Memory { id, partner, springs } = memory;
        if self.zones.comes(id, &self.setup) {
            self.zones.memories.insert((id, partner), springs);
        }
    }

    /// What contact `place` remembers, as its first particle sees it, or its second.
    pub(crate) fn springs(&self, segment: &Segment, place: usize, second: bool) -> Springs {
        let kernel = &self.kinds[segment.kind].kernel;
        let columns = kernel.columns();
        let number = |c: usize| {
            let n = self.contacts.remembered(segment, place, c, columns);
            if second && kernel.flips(c) { -n } else { n }
        };
        let mut springs = Springs::default();
        self.for_columns(segment, |at, field| match field {
            Field::Sliding => springs.sliding = Vec3::new(number(at), number(at + 1), number(at + 2)),
            Field::Rolling => springs.rolling = Vec3::new(number(at), number(at + 1), number(at + 2)),
            Field::Twisting => springs.twisting = number(at),
            Field::Normal => springs.normal = number(at),
        });
        springs
    }

    /// The columns of a kind of contact, in the kernel's order.
    fn columns(&self, segment: &Segment, springs: &Springs) -> Vec<f64> {
        let mut columns = vec![0.0; self.kinds[segment.kind].kernel.columns()];
        self.for_columns(segment, |at, field| match field {
            Field::Sliding => columns[at..at + 3].copy_from_slice(springs.sliding.as_slice()),
            Field::Rolling => columns[at..at + 3].copy_from_slice(springs.rolling.as_slice()),
            Field::Twisting => columns[at] = springs.twisting,
            Field::Normal => columns[at] = springs.normal,
        });
        columns
    }

    /// First column of each effect that has a memory.
    fn for_columns(&self, segment: &Segment, mut each: impl FnMut(usize, Field)) {
        let (a, b) = self.kinds[segment.kind].between;
        let Ok(contact) = contact_between(&self.setup, a, b) else { return };
        let mut at = 0;
        for part in parts(contact).iter().filter(|p| p.bytes > 0) {
            let field = match part.effect {
                "sliding_friction" => Field::Sliding,
                "rolling_resistance" => Field::Rolling,
                "twisting_resistance" => Field::Twisting,
                _ => Field::Normal,
            };
            each(at, field);
            at += part.bytes / size_of::<f64>();
        }
    }

    /// Particle `k` is free from now on: its contacts with those on their way in remember what they were told.
    pub(super) fn recollect(&mut self, k: usize) {
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

/// What a column of memory is.
enum Field {
    Sliding,
    Rolling,
    Twisting,
    Normal,
}
