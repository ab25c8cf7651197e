//! All listed contacts, in the order of the tiles of particles that they belong to.
//!
//! A kind of contact is a pair of materials that particles have, or a wall and a material. Each has its own composition of
//! effects, so that a frictionless pair keeps no history even where another has friction. Contacts of one kind in one tile are a
//! segment: whole blocks of slots, one batch of the contact loop. Images across periodic faces come first, before all tiles. History and
//! wrenches lie in columns of State ([`crate::state::contacts`]), one row per slot.

use crate::model::With;
use crate::state::ContactColumns;
use laws::contact::patch::PATCH;
use laws::contact::{Arrival, SlotEnd};
use laws::simd::BLOCK;
use laws::space::cell::ImageOf;
use std::ops::Range;

/// What may disturb a sleeper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Disturber {
    /// Particles that are awake.
    Particles,
    /// A wall at rest: nothing.
    StillWall,
    /// A wall that moves.
    MovingWall,
}

/// Contacts of one kind in one tile.
#[derive(Debug, Clone)]
pub struct Segment {
    /// Which kind.
    pub kind: usize,
    /// What its particles meet.
    pub with: With,
    /// Its slots, whole blocks.
    pub slots: Range<usize>,
    /// How many of them hold contacts.
    pub len: usize,
    /// Whether the second of each is a particle of a later tile.
    pub later: bool,
    /// First word of its history.
    pub history: usize,
    /// First row of its contact points.
    pub rows: usize,
    /// First row of its wrenches that are kept for other tiles.
    pub kept: usize,
    /// First number of its patches; those of other kinds have none.
    pub patch: usize,
    /// Whether its contacts may be parts of patches.
    pub patches: bool,
}

impl Segment {
    /// Slots that hold contacts.
    pub fn contacts(&self) -> Range<usize> {
        self.slots.start..self.slots.start + self.len
    }

    /// Number of its contact at which the one in `slot` stands.
    pub fn rank(&self, slot: usize) -> usize {
        slot - self.slots.start
    }
}

/// The slots of all listed contacts.
#[derive(Clone, Default)]
pub struct Slots {
    /// In order of their slots.
    pub segments: Vec<Segment>,
    /// How many particles there are.
    pub particles: usize,
    /// Particles of a tile.
    pub tile: usize,
    /// First segment of each tile, and one more.
    pub tiles: Vec<usize>,
    /// First particle of each contact.
    pub i: Vec<u32>,
    /// Second particle, or element of the wall.
    pub partner: Vec<u32>,
    /// Words of history of all segments.
    pub history: usize,
    /// Shift of an image [m], by slot.
    pub image: Vec<ImageOf>,
    /// Wrenches that arrive at each tile, in the order of the slots that they come from.
    pub arrivals: Vec<Arrival>,
    /// First arrival of each tile, and one more.
    pub arriving: Vec<u32>,
    /// First entry of each particle, and one more; none before [`Slots::index`].
    pub starts: Vec<u32>,
    /// Contacts of each particle; none before [`Slots::index`].
    pub entries: Vec<SlotEnd>,
    /// 0, 1, 2, …
    pub count: Vec<u32>,
    /// What the contacts of each block meet; only where particles sleep.
    pub met: Vec<Disturber>,
    /// Whether contact points of walls at rest are to be found.
    pub new: bool,
}

impl Slots {
    /// Number of contacts.
    pub fn len(&self) -> usize {
        self.segments.iter().map(|s| s.len).sum()
    }

    /// Number of slots of all segments.
    pub fn end(&self) -> usize {
        self.segments.last().map_or(0, |s| s.slots.end)
    }

    /// Rows of wrenches that are kept for other tiles.
    pub fn kept(&self) -> usize {
        self.segments.last().map_or(0, |s| s.kept + s.slots.len())
    }

    /// Rows of contact points, of images and walls.
    pub fn rows(&self) -> usize {
        self.segments.iter().filter(|s| s.with != With::Particles).map(|s| s.slots.len()).sum()
    }

    /// Numbers of the patches of all contacts that have them.
    pub fn patches(&self) -> usize {
        self.segments.last().map_or(0, |s| s.patch + s.slots.len() * PATCH * usize::from(s.patches))
    }

    /// Slots of contacts with images, which come first.
    pub fn with_images(&self) -> usize {
        self.segments.iter().take_while(|s| s.with == With::Images).last().map_or(0, |s| s.slots.end)
    }

    /// The particle of a contact, and the other one where it is not with a wall.
    pub fn ends(&self, segment: &Segment, slot: usize) -> (u32, Option<u32>) {
        (self.i[slot], (!segment.with.is_wall()).then(|| self.partner[slot]))
    }

    /// The contacts of a particle; none where they are not indexed.
    pub fn of_particle(&self, k: usize) -> &[SlotEnd] {
        match (self.starts.get(k), self.starts.get(k + 1)) {
            (Some(&from), Some(&to)) => &self.entries[from as usize..to as usize],
            _ => &[],
        }
    }

    /// The particle (or element of a wall) at the other end.
    pub fn other(&self, end: SlotEnd) -> u32 {
        if end.is_second() { self.i[end.slot()] } else { self.partner[end.slot()] }
    }

    /// The segment that a slot belongs to.
    pub fn segment_of(&self, slot: usize) -> &Segment {
        &self.segments[self.segments.partition_point(|s| s.slots.start <= slot) - 1]
    }

    /// What arrives at a tile.
    pub fn arriving(&self, tile: usize) -> &[Arrival] {
        &self.arrivals[self.arriving[tile] as usize..self.arriving[tile + 1] as usize]
    }

    /// Whether a particle has a contact that may have changed while it slept.
    pub fn disturbed(&self, particle: usize, asleep: &[bool]) -> bool {
        let may_change = |&end: &SlotEnd| match self.met[end.slot() / BLOCK] {
            Disturber::Particles => !asleep[self.other(end) as usize],
            Disturber::StillWall => false,
            Disturber::MovingWall => true,
        };
        self.new || self.of_particle(particle).iter().any(may_change)
    }

    /// Whether all contacts of a block are between sleepers, or of sleepers with a wall at rest.
    pub fn rests(&self, block: usize, asleep: &[bool]) -> bool {
        let all = |of: &[u32]| of[block * BLOCK..(block + 1) * BLOCK].iter().all(|&k| asleep[k as usize]);
        !self.new
            && match self.met[block] {
                Disturber::Particles => all(&self.i) && all(&self.partner),
                Disturber::StillWall => all(&self.i),
                Disturber::MovingWall => false,
            }
    }
}

impl ContactColumns {
    /// Number `column` of so many in the history of the contact in `slot`.
    pub fn history_of_slot(&self, segment: &Segment, slot: usize, column: usize, columns: usize) -> f64 {
        let at = self.layout.history_at(segment.history, segment.rank(slot), column, columns);
        self.layout.get(&self.history, at)
    }

    /// Sets the history of the contact in `slot`, in the order of its kind's columns.
    pub fn set_history(&mut self, segment: &Segment, slot: usize, columns: &[f64]) {
        for (c, number) in columns.iter().enumerate() {
            let at = self.layout.history_at(segment.history, segment.rank(slot), c, columns.len());
            self.layout.put(&mut self.history, at, *number);
        }
    }
}
