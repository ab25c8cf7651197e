//! Carries contact history and sliding work over to rebuilt lists, by pair of particles or particle and part of a wall.

use crate::model::Model;
use crate::model::kind::{Kind, With};
use crate::neighbours::NeighbourLists;
use crate::neighbours::contacts::{Contacts, Segment};
use crate::neighbours::rebuild::LISTED_FEW;
use crate::state::State;
use crate::threads::share;
use crate::walls::WallBody;
use crate::walls::images::{Image, Periods};

fn history_of_slot<'a>(
    model: &'a Model,
    now: &[Periods],
    before: &'a Contacts,
    order: &'a [u32],
    (wraps, wall_periods): MoveFlags<'a>,
) -> OldLists<'a> {
    let back = |(now, was): (&Periods, &Periods)| [0, 1, 2].map(|a| was[a] - now[a]);
    let back = now.iter().zip(wall_periods).map(back).collect();
    OldLists { kinds: &model.kinds, walls: &model.walls, before, order, wraps, back }
}

/// By how many periods particles were moved, by their old places, and how far walls were counted back before.
type MoveFlags<'a> = (&'a [Periods], &'a [Periods]);

/// Lists and memory as they were before: what new contacts remember from.
struct OldLists<'a> {
    kinds: &'a [Kind],
    walls: &'a [WallBody],
    before: &'a Contacts,
    order: &'a [u32],
    /// By how many periods each particle was moved, by its old place; or none.
    wraps: &'a [Periods],
    /// By how many periods less each wall is counted back; or none.
    back: Vec<Periods>,
}

impl OldLists<'_> {
    /// Fills the memory of one segment. A contact whose two partners have changed places remembers the opposite.
    fn recall(&self, now: &Contacts, segment: &Segment, memory: &mut [f64]) {
        let kernel = &self.kinds[segment.kind].kernel;
        let columns = kernel.columns();
        if columns == 0 {
            return;
        }
        for place in segment.contacts() {
            let before = self.before;
            let holds = |old: &Segment, at: usize| {
                (0..columns).any(|c| before.history_of_slot(old, at, c, columns) != 0.0)
            };
            let Some((old, from, swapped)) = self.find(segment.kind, now.i[place], now.partner[place], holds)
            else {
                continue;
            };
            for c in 0..columns {
                let was = before.history_of_slot(old, from, c, columns);
                let at = now.form.memory_at(0, place - segment.places.start, c, columns);
                now.form.put(memory, at, if swapped && kernel.flips(c) { -was } else { was });
            }
        }
    }

    /// Where a contact was that `holds` something: its segment and place, and whether its partners were the other way round. In a
    /// small periodic box two images of one particle may be listed with another; only one of them can touch it.
    fn find(
        &self,
        kind: usize,
        i: u32,
        partner: u32,
        holds: impl Fn(&Segment, usize) -> bool,
    ) -> Option<(&Segment, usize, bool)> {
        let old = |k: u32| self.order[k as usize];
        let i = old(i);
        let (wall, partner) = match self.kinds[kind].with {
            With::Wall(w) => (true, self.part_before(w, i, partner)),
            _ => (false, old(partner)),
        };
        let range =
            *self.before.starts.get(i as usize)? as usize..*self.before.starts.get(i as usize + 1)? as usize;
        self.before.entries[range].iter().find_map(|&entry| {
            let (place, second) = ((entry >> 1) as usize, entry & 1 == 1);
            let other = if second { self.before.i[place] } else { self.before.partner[place] };
            if other != partner {
                return None;
            }
            let segment = self.before.segment_of(place);
            // A pair may have become a pair across a periodic face, or stopped being one.
            let with = self.kinds[segment.kind].with;
            let same = if wall { segment.kind == kind } else { !matches!(with, With::Wall(_)) };
            (same && holds(segment, place)).then_some((segment, place, second))
        })
    }

    /// Part and image of a wall, as they were before a particle (by its old place) and the wall were moved by whole periods.
    fn part_before(&self, wall: usize, particle: u32, partner: u32) -> u32 {
        let (Some(wrap), Some(back)) = (self.wraps.get(particle as usize), self.back.get(wall)) else {
            return partner;
        };
        let parts = self.walls[wall].parts();
        Image(partner / parts).before(*wrap, *back).0 * parts + partner % parts
    }
}

/// Gives each new contact the memory that it had; `order` tells each particle's old place.
pub fn recall(
    model: &Model,
    state: &mut State,
    lists: &mut NeighbourLists,
    before: &Contacts,
    order: &[u32],
    moved: MoveFlags,
) {
    let kinds = &model.kinds;
    let mut memory = std::mem::take(&mut lists.contacts.memory);
    if !memory.is_empty() && !before.memory.is_empty() {
        let now = &lists.contacts;
        let mut rest = &mut memory[..];
        let mut pieces = Vec::with_capacity(now.segments.len());
        for s in &now.segments {
            let words = now.form.memory(kinds[s.kind].kernel.columns());
            let (mine, others) = rest.split_at_mut(s.places.len() * words);
            rest = others;
            pieces.push((s, mine));
        }
        let old = history_of_slot(model, &lists.wall_periods, before, order, moved);
        share(state.particles.len() >= LISTED_FEW, pieces, |(s, memory)| old.recall(now, s, memory));
    }
    lists.contacts.memory = memory;
}

/// Gives each new contact the work that it has done. What contacts have done that are no longer listed is lost to records.
pub fn recall_work(
    model: &Model,
    lists: &mut NeighbourLists,
    before: &Contacts,
    order: &[u32],
    moved: MoveFlags,
) {
    if before.work.is_empty() {
        return;
    }
    let old = history_of_slot(model, &lists.wall_periods, before, order, moved);
    let mut work = vec![0.0; lists.contacts.i.len()];
    for s in &lists.contacts.segments {
        for place in s.contacts() {
            let holds = |_: &Segment, at: usize| before.work[at] != 0.0;
            let found = old.find(s.kind, lists.contacts.i[place], lists.contacts.partner[place], holds);
            work[place] = found.map_or(0.0, |(_, was, _)| before.work[was]);
        }
    }
    lists.contacts.work = work;
}
