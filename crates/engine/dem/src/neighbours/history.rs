//! Carries contact history and sliding work over to rebuilt lists, by pair of particles, or by particle and element of a wall.

use crate::model::{Kind, Model, With};
use crate::neighbours::{LISTED_FEW, NeighbourLists, Segment, Slots};
use crate::state::{ContactColumns, State};
use crate::threads::share;
use crate::walls::WallBody;
use laws::space::images::{Image, Periods, WallImages};

/// Lists and columns of contacts as they were before.
pub struct OldContacts {
    /// Their lists, indexed by particle.
    pub slots: Slots,
    /// Their columns.
    pub columns: ContactColumns,
    /// Old position of each particle in its columns, by the new one.
    pub order: Vec<u32>,
    /// By how many periods each particle was moved, by its old position; empty where nothing is periodic.
    pub wraps: Vec<Periods>,
    /// How far walls were counted back; empty where nothing is periodic.
    pub wall_periods: Vec<Periods>,
}

/// The same, with what it takes to find a contact.
struct Finder<'a> {
    old: &'a OldContacts,
    kinds: &'a [Kind],
    walls: &'a [WallBody],
    /// Images of each wall, and by how many periods less it is counted back now; empty where nothing is periodic.
    images: Vec<(WallImages, Periods)>,
}

/// Where a contact was.
struct OldSlot<'a> {
    segment: &'a Segment,
    slot: usize,
    /// Whether its particles have been exchanged since.
    swapped: bool,
}

impl<'a> Finder<'a> {
    fn new(model: &'a Model, old: &'a OldContacts, wall_periods: &[Periods]) -> Finder<'a> {
        let period = model.cell().lengths();
        let images = |((now, was), wall): ((&Periods, &Periods), &WallBody)| {
            let [lo, hi] = wall.bounds;
            (WallImages { period, lo, hi }, [0, 1, 2].map(|a| was[a] - now[a]))
        };
        let images = wall_periods.iter().zip(&old.wall_periods).zip(&model.walls).map(images).collect();
        Finder { old, kinds: &model.kinds, walls: &model.walls, images }
    }

    /// Fills the history of one segment. A contact whose particles have been exchanged takes the opposite.
    fn fill(&self, slots: &Slots, segment: &Segment, history: &mut [f64]) {
        let composition = &self.kinds[segment.kind].composition;
        let (old, columns) = (&self.old.columns, composition.columns());
        if columns == 0 {
            return;
        }
        for slot in segment.contacts() {
            let holds = |segment: &Segment, slot: usize| {
                (0..columns).any(|c| old.history_of_slot(segment, slot, c, columns) != 0.0)
            };
            let Some(was) = self.find(slots, segment, slot, holds) else {
                continue;
            };
            for c in 0..columns {
                let number = old.history_of_slot(was.segment, was.slot, c, columns);
                let at = old.layout.history_at(0, slot - segment.slots.start, c, columns);
                old.layout.put(
                    history,
                    at,
                    if was.swapped && composition.flips(c) { -number } else { number },
                );
            }
        }
    }

    /// Carries the numbers of a column over to the contacts of the segments that are `wanted`; by old slot, whether it was.
    fn carry<T: Copy + Default + PartialEq>(
        &self,
        slots: &Slots,
        before: &[T],
        column: &mut Vec<T>,
        wanted: impl Fn(&Segment) -> bool,
    ) -> Vec<bool> {
        let mut carried = vec![false; before.len()];
        if before.is_empty() {
            return carried;
        }
        let none = T::default();
        *column = vec![none; slots.i.len()];
        for s in slots.segments.iter().filter(|s| wanted(s)) {
            for slot in s.contacts() {
                let holds = |_: &Segment, slot: usize| before[slot] != none;
                if let Some(was) = self.find(slots, s, slot, holds) {
                    (column[slot], carried[was.slot]) = (before[was.slot], true);
                }
            }
        }
        carried
    }

    /// Where a contact was that `holds` something. In a small periodic box two images of one particle may be listed with another; only one
    /// of them can touch it.
    fn find(
        &self,
        slots: &Slots,
        segment: &Segment,
        slot: usize,
        holds: impl Fn(&Segment, usize) -> bool,
    ) -> Option<OldSlot<'_>> {
        let (now, OldContacts { slots: old, order, .. }) = (segment, self.old);
        let (i, partner) = (order[slots.i[slot] as usize], slots.partner[slot]);
        let partner = match now.with {
            With::Wall(w) => self.element_before(w, i, partner),
            _ => order[partner as usize],
        };
        old.of_particle(i as usize).iter().find_map(|&end| {
            let (slot, swapped) = (end.slot(), end.is_second());
            if old.other(end) != partner {
                return None;
            }
            let segment = old.segment_of(slot);
            // A pair may have become a pair across a periodic face, or stopped being one.
            let same = if now.with.is_wall() { segment.kind == now.kind } else { !segment.with.is_wall() };
            (same && holds(segment, slot)).then_some(OldSlot { segment, slot, swapped })
        })
    }

    /// Element and image of a wall, as they were before a particle (by its old position) and the wall were moved by whole periods.
    fn element_before(&self, wall: usize, particle: u32, partner: u32) -> u32 {
        let (Some(wrap), Some((images, back))) =
            (self.old.wraps.get(particle as usize), self.images.get(wall))
        else {
            return partner;
        };
        let parts = self.walls[wall].parts();
        images.before(Image(partner / parts), *wrap, *back).0 * parts + partner % parts
    }
}

/// Gives each new contact its history, the work that it has done, the stiffness at which its springs were booked, and whether it touched a wall. By old slot, whether
/// the work is that of a contact that is listed again.
pub fn carry_over(model: &Model, state: &mut State, lists: &NeighbourLists, old: &OldContacts) -> Vec<bool> {
    let finder = Finder::new(model, old, &lists.wall_periods);
    let (slots, many) = (&lists.slots, state.particles.len() >= LISTED_FEW);
    let ContactColumns { layout, history, work, stiffness, touched, .. } = &mut state.contacts;
    if !history.is_empty() && !old.columns.history.is_empty() {
        let mut rest = &mut history[..];
        let mut pieces = Vec::with_capacity(slots.segments.len());
        for s in &slots.segments {
            let words = layout.history(model.kinds[s.kind].composition.columns());
            let (own, others) = rest.split_at_mut(s.slots.len() * words);
            rest = others;
            pieces.push((s, own));
        }
        share(many, pieces, |(s, history)| finder.fill(slots, s, history));
    }
    let all = |_: &Segment| true;
    let carried = finder.carry(slots, &old.columns.work, work, all);
    finder.carry(slots, &old.columns.stiffness, stiffness, all);
    finder.carry(slots, &old.columns.touched, touched, |s| s.with.is_wall());
    carried
}
