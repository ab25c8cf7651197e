//! How lists become contacts: segments, what arrives at which tile, and which tiles are adjacent.

use crate::kernel::sums::Arrival;
use crate::model::kind::{Kind, With};
use crate::neighbours::contacts::{Contacts, Disturber, Segment};
use crate::neighbours::resting::RestingTile;
use crate::simd::aligned::Aligned;
use crate::simd::number::Layout;
use crate::simd::{BLOCK, Row4};
use crate::space::search::tile;
use crate::space::sphere::FAR;
use crate::walls::WallBody;
use geom::Vec3;
use std::ops::Range;

/// Contacts of one kind to be listed, by first particle.
#[derive(Debug, Clone, Default)]
pub struct List {
    /// Particle.
    pub i: Vec<u32>,
    /// Other particle, or part of the wall.
    pub partner: Vec<u32>,
    /// Shift of the other particle's image [m]; empty for all but images.
    pub shift: Vec<Vec3>,
}

impl List {
    /// Adds a contact at the end.
    pub fn push(&mut self, i: u32, partner: u32) {
        self.i.push(i);
        self.partner.push(partner);
    }
}

impl Contacts {
    /// Contacts of `images`, then of each tile, lists for every kind: with particles of the tile, and of later ones. Of so many particles.
    pub fn new(
        kinds: &[Kind],
        images: &[List],
        tiles: &[Vec<[List; 2]>],
        (particles, form): (usize, Layout),
    ) -> Contacts {
        let mut new = Contacts { new: true, form, particles, tile: tile(particles), ..Contacts::default() };
        let lists = images.iter().chain(tiles.iter().flatten().flatten());
        let most: usize = lists.map(|l| l.i.len() + BLOCK).sum();
        new.i.reserve(most);
        new.partner.reserve(most);
        let (mut memory, mut rows, mut kept) = (0, 0, 0);
        let mut put = |kind: usize, later: bool, list: &List, new: &mut Contacts| {
            let len = list.i.len();
            if len == 0 {
                return;
            }
            let places = new.append(list);
            let padded = places.len();
            let with = kinds[kind].with;
            new.segments.push(Segment { kind, places, len, later, memory, rows, kept });
            memory += padded * form.memory(kinds[kind].kernel.columns());
            rows += if with == With::Particles { 0 } else { padded };
            kept += if later || with == With::Images { padded } else { 0 };
        };
        images.iter().enumerate().for_each(|(kind, list)| put(kind, false, list, &mut new));
        for tile in tiles {
            new.tiles.push(new.segments.len());
            for (kind, [here, later]) in tile.iter().enumerate() {
                put(kind, false, here, &mut new);
                put(kind, true, later, &mut new);
            }
        }
        new.tiles.push(new.segments.len());
        let turns = kinds.iter().any(|k| k.kernel.rotates());
        new.rows = vec![FAR[1]; rows];
        new.spins = vec![Row4::default(); if turns { rows } else { 0 }];
        new.memory = Aligned::zeros(memory);
        new.active = vec![true; new.i.len() / BLOCK];
        let largest = new.segments.iter().filter(|s| kinds[s.kind].with != With::Particles);
        new.count = (0..largest.map(|s| s.places.len()).max().unwrap_or(0) as u32).collect();
        new.index_arrivals(kinds);
        new
    }

    /// Adds the contacts of a list, filled up to whole blocks; the slots that they get.
    fn append(&mut self, list: &List) -> Range<usize> {
        let first = self.i.len();
        self.i.extend(&list.i);
        self.partner.extend(&list.partner);
        self.shift.extend(&list.shift);
        let slots = first..first + list.i.len().next_multiple_of(BLOCK);
        self.i.resize(slots.end, self.particles as u32);
        self.partner.resize(slots.end, self.particles as u32 + 1);
        if !list.shift.is_empty() {
            self.shift.resize(slots.end, Vec3::zeros());
        }
        slots
    }

    /// What arrives at each tile.
    fn index_arrivals(&mut self, kinds: &[Kind]) {
        let tiles = self.tiles.len() - 1;
        let mut starts = vec![0; tiles + 1];
        self.for_each_kept(kinds, |_, particle| starts[particle as usize / self.tile + 1] += 1);
        (0..tiles).for_each(|tile| starts[tile + 1] += starts[tile]);
        let mut next = starts.clone();
        let mut arrivals = vec![Arrival { from: 0, particle: 0 }; starts[tiles] as usize];
        self.for_each_kept(kinds, |from, particle| {
            let at = &mut next[particle as usize / self.tile];
            arrivals[*at as usize] = Arrival { from, particle };
            *at += 1;
        });
        (self.arrivals, self.arriving) = (arrivals, starts);
    }

    /// Each wrench that is kept, in the order of the slots: slot among them × 2, + 1 for the second particle of a contact; and the particle that takes it.
    fn for_each_kept(&self, kinds: &[Kind], mut each: impl FnMut(u32, u32)) {
        for s in &self.segments {
            let image = kinds[s.kind].with == With::Images;
            for place in if image || s.later { s.contacts() } else { 0..0 } {
                let kept = 2 * (s.kept + place - s.places.start) as u32;
                if image {
                    each(kept, self.i[place]);
                }
                each(kept + 1, self.partner[place]);
            }
        }
    }

    /// Marks what blocks meet.
    pub fn mark_wall_blocks(&mut self, kinds: &[Kind], walls: &[WallBody]) {
        self.met = vec![Disturber::Particles; self.active.len()];
        for s in &self.segments {
            if let With::Wall(w) = kinds[s.kind].with {
                let met = if walls[w].motion.moves() { Disturber::MovingWall } else { Disturber::StillWall };
                self.met[s.places.start / BLOCK..s.places.end / BLOCK].fill(met);
            }
        }
    }

    /// Notes which tiles meet.
    pub fn find_adjacent_tiles(&mut self, kinds: &[Kind]) {
        let tile = |particle: u32| (particle as usize / self.tile) as u32;
        let mut near: Vec<Vec<u32>> = (0..self.tiles.len() as u32 - 1).map(|t| vec![t]).collect();
        for s in self.segments.iter().filter(|s| !matches!(kinds[s.kind].with, With::Wall(_))) {
            for (a, b) in s.contacts().map(|place| (tile(self.i[place]), tile(self.partner[place]))) {
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
        self.resting_tiles = near.into_iter().map(RestingTile::beside).collect();
    }

    /// For each particle, its contacts in the order of their slots; only where contacts are looked up by particle.
    pub fn index(&mut self, kinds: &[Kind]) {
        let particles = self.particles;
        self.starts = vec![0; particles + 1];
        for s in &self.segments {
            let both = !matches!(kinds[s.kind].with, With::Wall(_));
            for place in s.contacts() {
                self.starts[self.i[place] as usize + 1] += 1;
                if both {
                    self.starts[self.partner[place] as usize + 1] += 1;
                }
            }
        }
        for k in 0..particles {
            self.starts[k + 1] += self.starts[k];
        }
        let mut next = self.starts.clone();
        self.entries = vec![0; self.starts[particles] as usize];
        let mut put = |particle: u32, entry: usize| {
            let at = &mut next[particle as usize];
            self.entries[*at as usize] = entry as u32;
            *at += 1;
        };
        for s in &self.segments {
            let both = !matches!(kinds[s.kind].with, With::Wall(_));
            for place in s.contacts() {
                put(self.i[place], 2 * place);
                if both {
                    put(self.partner[place], 2 * place + 1);
                }
            }
        }
    }
}
