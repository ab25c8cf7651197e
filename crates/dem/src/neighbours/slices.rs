//! Slices of the lists: what one tile reads, and what it writes.

use crate::kernel::LEDGER;
use crate::kernel::sums::{Arrival, WrenchSlices};
use crate::neighbours::contacts::{Disturber, Segment};
use crate::simd::number::Layout;
use crate::simd::{BLOCK, Row, Row4};
use geom::Vec3;

/// What all parts read.
#[derive(Clone, Copy)]
pub struct Lists<'a> {
    pub i: &'a [u32],
    pub partner: &'a [u32],
    pub shift: &'a [Vec3],
    /// 0, 1, 2, …
    pub count: &'a [u32],
    pub met: &'a [Disturber],
    pub new: bool,
    /// First segment of each tile, and one more.
    pub tiles: &'a [usize],
    /// Particles of a tile.
    pub tile: usize,
    /// First entry of each particle, and one more.
    pub starts: &'a [u32],
    /// Place × 2, + 1 where the particle is the second.
    pub entries: &'a [u32],
    /// What arrives at tiles.
    pub arrivals: &'a [Arrival],
    /// First arrival of each tile, and one more.
    pub arriving: &'a [u32],
}

impl Lists<'_> {
    /// What arrives at a tile.
    pub fn arriving(&self, tile: usize) -> &[Arrival] {
        &self.arrivals[self.arriving[tile] as usize..self.arriving[tile + 1] as usize]
    }

    /// Whether a particle has a contact that may have changed while it slept.
    pub fn disturbed(&self, particle: usize, asleep: &[bool]) -> bool {
        let entries = self.starts[particle] as usize..self.starts[particle + 1] as usize;
        self.new
            || self.entries[entries].iter().any(|&entry| {
                let (place, second) = ((entry >> 1) as usize, entry & 1 == 1);
                match self.met[place / BLOCK] {
                    Disturber::Particles => {
                        !asleep[if second { self.i[place] } else { self.partner[place] } as usize]
                    }
                    Disturber::StillWall => false,
                    Disturber::MovingWall => true,
                }
            })
    }

    /// Whether all contacts of a block are between sleepers, or of sleepers with a wall at rest.
    pub fn rests(&self, block: usize, asleep: &[bool]) -> bool {
        let all = |of: &[u32]| of[block * BLOCK..(block + 1) * BLOCK].iter().all(|&k| asleep[k as usize]);
        !self.new
            && match self.met[block] {
                Disturber::Particles => all(self.i) && all(self.partner),
                Disturber::StillWall => all(self.i),
                Disturber::MovingWall => false,
            }
    }
}

/// Where a part begins.
#[derive(Debug, Clone, Copy, Default)]
pub struct SliceStart {
    pub place: usize,
    pub row: usize,
    pub memory: usize,
    pub kept: usize,
}

/// Some segments that follow each other, with their part of everything that is computed.
pub struct TileSlice<'a> {
    pub segments: &'a [Segment],
    pub form: Layout,
    pub from: SliceStart,
    pub rows: &'a mut [Row],
    pub spins: &'a mut [Row4],
    pub memory: &'a mut [f64],
    pub active: &'a mut [bool],
    /// Loads and couples that are kept for other tiles.
    pub kept: (&'a mut [f64], &'a mut [f64]),
    /// Loads and couples of each contact, or none.
    pub each: (&'a mut [f64], &'a mut [f64]),
    pub ledger: &'a mut [f64],
}

impl<'a> TileSlice<'a> {
    /// The first `count` segments, and the others.
    pub fn split(self, count: usize) -> (TileSlice<'a>, TileSlice<'a>) {
        let TileSlice { segments, form, from, rows, spins, memory, active, kept, each, ledger } = self;
        let (first, second) = segments.split_at(count);
        let all = SliceStart {
            place: from.place + active.len() * BLOCK,
            row: from.row + rows.len(),
            memory: from.memory + memory.len(),
            kept: from.kept + kept.0.len() / form.load(),
        };
        let of =
            |s: &Segment| SliceStart { place: s.places.start, row: s.rows, memory: s.memory, kept: s.kept };
        let to = second.first().map_or(all, of);
        let places = to.place - from.place;
        let (rows, rows2) = rows.split_at_mut(to.row - from.row);
        let (spins, spins2) = split(spins, to.row - from.row);
        let (memory, memory2) = memory.split_at_mut(to.memory - from.memory);
        let (active, active2) = active.split_at_mut(places / BLOCK);
        let (kept, kept2) = split_both(kept, to.kept - from.kept, form);
        let (each, each2) = split_both(each, places, form);
        let (ledger, ledger2) = split(ledger, places * LEDGER);
        let one = TileSlice { segments: first, form, from, rows, spins, memory, active, kept, each, ledger };
        let two = TileSlice {
            segments: second,
            form,
            from: to,
            rows: rows2,
            spins: spins2,
            memory: memory2,
            active: active2,
            kept: kept2,
            each: each2,
            ledger: ledger2,
        };
        (one, two)
    }

    /// Loads and couples that are kept for other tiles.
    pub fn kept(&self) -> WrenchSlices<'_> {
        (self.kept.0, self.kept.1)
    }
}

/// Some of a column, or none of a column that does not exist.
pub fn part<T>(of: &[T], from: usize, n: usize) -> &[T] {
    if of.is_empty() { &[] } else { &of[from..from + n] }
}

pub fn part_mut<T>(of: &mut [T], from: usize, n: usize) -> &mut [T] {
    if of.is_empty() { &mut [] } else { &mut of[from..from + n] }
}

/// Some loads and couples, or none of those that do not exist.
pub fn some<'a>(
    of: &'a mut (&mut [f64], &mut [f64]),
    from: usize,
    n: usize,
    form: Layout,
) -> (&'a mut [f64], &'a mut [f64]) {
    let (load, torque) = (form.load(), form.torque());
    (part_mut(of.0, from * load, n * load), part_mut(of.1, from * torque, n * torque))
}

pub type Both<'a> = (&'a mut [f64], &'a mut [f64]);

fn split_both<'a>((loads, torques): Both<'a>, n: usize, form: Layout) -> (Both<'a>, Both<'a>) {
    let (loads, loads2) = split(loads, n * form.load());
    let (torques, couples2) = split(torques, n * form.torque());
    ((loads, torques), (loads2, couples2))
}

pub fn split<T>(of: &mut [T], at: usize) -> (&mut [T], &mut [T]) {
    let at = at.min(of.len());
    of.split_at_mut(at)
}
