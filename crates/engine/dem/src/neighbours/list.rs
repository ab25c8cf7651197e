//! How lists become contacts: segments, what arrives at which tile, and which tiles are adjacent.

use crate::model::{Kind, With};
use crate::neighbours::{Disturber, LISTED_FEW, RestingTile, Segment, Slots};
use crate::space::search::tile;
use crate::threads::share;
use crate::walls::WallBody;
use laws::contact::patch::PATCH;
use laws::contact::{Arrival, SlotEnd};
use laws::simd::{BLOCK, Layout};
use laws::space::cell::ImageOf;

/// Contacts of one kind to be listed, by first particle.
#[derive(Debug, Clone, Default)]
pub struct List {
    /// Particle.
    pub i: Vec<u32>,
    /// Other particle, or part of the wall.
    pub partner: Vec<u32>,
    /// Which image of the other particle; empty for all but images.
    pub image: Vec<ImageOf>,
}

impl List {
    /// Adds a contact at the end.
    pub fn push(&mut self, i: u32, partner: u32) {
        self.i.push(i);
        self.partner.push(partner);
    }
}

impl Slots {
    /// Slots of the contacts of `images`, then of each tile: lists for every kind, with particles of the tile and of later ones.
    /// Each list is freed when its contacts have their slots.
    pub fn new(
        kinds: &[Kind],
        images: Vec<List>,
        tiles: Vec<Vec<[List; 2]>>,
        particles: usize,
        layout: Layout,
    ) -> Slots {
        let here: Vec<usize> = images.iter().map(|list| list.i.len()).collect();
        let both = |[here, later]: &[List; 2]| [here.i.len(), later.i.len()];
        let counts = tiles.iter().map(|tile| tile.iter().map(both).collect());
        let mut new = Slots::laid_out(kinds, &here, counts, particles, layout);
        let end = new.end();
        new.i.reserve(end);
        new.partner.reserve(end);
        images.into_iter().chain(tiles.into_iter().flatten().flatten()).for_each(|list| new.append(&list));
        new.index_arrivals();
        new
    }

    /// Segments of so many contacts: of images by kind, then of each tile by kind, with particles of the tile and of later ones. They have no contacts yet.
    pub fn laid_out(
        kinds: &[Kind],
        images: &[usize],
        tiles: impl Iterator<Item = Vec<[usize; 2]>>,
        particles: usize,
        layout: Layout,
    ) -> Slots {
        let mut new = Slots { new: true, particles, tile: tile(particles), ..Slots::default() };
        let (mut first, mut history, mut rows, mut kept, mut patch) = (0, 0, 0, 0, 0);
        let mut put = |kind: usize, later: bool, len: usize, new: &mut Slots| {
            if len == 0 {
                return;
            }
            let padded = len.next_multiple_of(BLOCK);
            let (with, slots, patches) =
                (kinds[kind].with, first..first + padded, kinds[kind].patch.is_some());
            new.segments.push(Segment { kind, with, slots, len, later, history, rows, kept, patch, patches });
            first += padded;
            history += padded * layout.history(kinds[kind].composition.columns());
            rows += if with == With::Particles { 0 } else { padded };
            kept += if later || with == With::Images { padded } else { 0 };
            patch += if patches { padded * PATCH } else { 0 };
        };
        images.iter().enumerate().for_each(|(kind, &len)| put(kind, false, len, &mut new));
        for tile in tiles {
            new.tiles.push(new.segments.len());
            for (kind, [here, later]) in tile.into_iter().enumerate() {
                put(kind, false, here, &mut new);
                put(kind, true, later, &mut new);
            }
        }
        new.tiles.push(new.segments.len());
        new.history = history;
        let largest = new.segments.iter().filter(|s| s.with != With::Particles);
        new.count = (0..largest.map(|s| s.slots.len()).max().unwrap_or(0) as u32).collect();
        new
    }

    /// Fills all slots, which have been laid out: both ends of each contact, and the images of those that are with one.
    pub fn fill(&mut self, i: Vec<u32>, partner: Vec<u32>, image: Vec<ImageOf>) {
        (self.i, self.partner, self.image) = (i, partner, image);
        self.index_arrivals();
    }

    /// Adds the contacts of a list, filled up to whole blocks.
    fn append(&mut self, list: &List) {
        self.i.extend(&list.i);
        self.partner.extend(&list.partner);
        self.image.extend(&list.image);
        let end = self.i.len().next_multiple_of(BLOCK);
        self.i.resize(end, self.particles as u32);
        self.partner.resize(end, self.particles as u32 + 1);
        if !list.image.is_empty() {
            self.image.resize(end, [0; 3]);
        }
    }

    /// What arrives at each tile.
    fn index_arrivals(&mut self) {
        let tiles = self.tiles.len() - 1;
        let mut starts = vec![0; tiles + 1];
        self.for_each_kept(|_, particle| starts[particle as usize / self.tile + 1] += 1);
        (0..tiles).for_each(|tile| starts[tile + 1] += starts[tile]);
        let mut next = starts.clone();
        let mut arrivals = vec![Arrival { from: SlotEnd::default(), particle: 0 }; starts[tiles] as usize];
        self.for_each_kept(|from, particle| {
            let at = &mut next[particle as usize / self.tile];
            arrivals[*at as usize] = Arrival { from, particle };
            *at += 1;
        });
        (self.arrivals, self.arriving) = (arrivals, starts);
    }

    /// Calls `each` with the ends that take a wrench which is kept, in the order of the slots (counted among those that are kept), and with their particles.
    fn for_each_kept(&self, mut each: impl FnMut(SlotEnd, u32)) {
        for s in &self.segments {
            let image = s.with == With::Images;
            for slot in if image || s.later { s.contacts() } else { 0..0 } {
                let kept = s.kept + slot - s.slots.start;
                if image {
                    each(SlotEnd::new(kept, false), self.i[slot]);
                }
                each(SlotEnd::new(kept, true), self.partner[slot]);
            }
        }
    }

    /// Marks what blocks meet.
    pub fn mark_wall_blocks(&mut self, walls: &[WallBody]) {
        self.met = vec![Disturber::Particles; self.i.len() / BLOCK];
        for s in &self.segments {
            if let With::Wall(w) = s.with {
                let met = if walls[w].drives() { Disturber::MovingWall } else { Disturber::StillWall };
                self.met[s.slots.start / BLOCK..s.slots.end / BLOCK].fill(met);
            }
        }
    }

    /// What rests in each tile: nothing yet, beside the tiles that it meets.
    pub fn resting_tiles(&self) -> Vec<RestingTile> {
        let tile = |particle: u32| (particle as usize / self.tile) as u32;
        let mut near: Vec<Vec<u32>> = (0..self.tiles.len() as u32 - 1).map(|t| vec![t]).collect();
        for s in self.segments.iter().filter(|s| !s.with.is_wall()) {
            for (a, b) in s.contacts().map(|slot| (tile(self.i[slot]), tile(self.partner[slot]))) {
                if a != b && near[a as usize].last() != Some(&b) {
                    near[a as usize].push(b);
                    near[b as usize].push(a);
                }
            }
        }
        for near in &mut near {
            near.sort_unstable();
            near.dedup();
        }
        near.into_iter().map(RestingTile::beside).collect()
    }

    /// For each particle, its contacts in the order of their slots; only where contacts are looked up by particle.
    pub fn index(&mut self) {
        let tiles = (0..self.tiles.len().saturating_sub(1)).collect();
        let found = share(self.particles >= LISTED_FEW, tiles, |tile| self.ends_of_tile(tile));
        let (mut starts, mut entries) = (Vec::with_capacity(self.particles + 1), Vec::new());
        entries.reserve(found.iter().map(|(_, ends)| ends.len()).sum());
        for (own, ends) in found {
            let before = entries.len() as u32;
            starts.extend(own.iter().map(|start| before + start));
            entries.extend(ends);
        }
        starts.push(entries.len() as u32);
        (self.starts, self.entries) = (starts, entries);
    }

    /// First entry of each particle of a tile, and their contacts in the order of the slots.
    fn ends_of_tile(&self, tile: usize) -> (Vec<u32>, Vec<SlotEnd>) {
        let first = tile * self.tile;
        let count = self.tile.min(self.particles - first);
        let mut starts = vec![0; count + 1];
        self.for_each_end_of_tile(tile, |_, particle| starts[particle as usize - first + 1] += 1);
        (0..count).for_each(|k| starts[k + 1] += starts[k]);
        let mut ends = vec![SlotEnd::default(); starts[count] as usize];
        let mut next = starts.clone();
        self.for_each_end_of_tile(tile, |end, particle| {
            let at = &mut next[particle as usize - first];
            ends[*at as usize] = end;
            *at += 1;
        });
        starts.truncate(count);
        (starts, ends)
    }

    /// Calls `each` with both ends of each contact that are particles of a tile, in the order of the slots: those that arrive from elsewhere, which
    /// have slots before its own, then its own.
    fn for_each_end_of_tile(&self, tile: usize, mut each: impl FnMut(SlotEnd, u32)) {
        for &Arrival { from, particle } in self.arriving(tile) {
            let kept = from.slot();
            // Of segments that keep nothing, the next one has the same first row.
            let s = &self.segments[self.segments.partition_point(|s| s.kept <= kept) - 1];
            each(SlotEnd::new(s.slots.start + kept - s.kept, from.is_second()), particle);
        }
        for s in &self.segments[self.tiles[tile]..self.tiles[tile + 1]] {
            let both = s.with == With::Particles && !s.later;
            for slot in s.contacts() {
                each(SlotEnd::new(slot, false), self.i[slot]);
                if both {
                    each(SlotEnd::new(slot, true), self.partner[slot]);
                }
            }
        }
    }
}
