//! Tiles of the lists, with what is computed for them: what a thread works on.

use crate::kernel::sums::{Arrival, Computed, Sums};
use crate::kernel::{Common, LEDGER, Task};
use crate::model::kind::{Kind, With};
use crate::neighbours::contacts::{Met, Segment};
use crate::simd::number::Form;
use crate::simd::{BLOCK, Row, Row4, Width};
use crate::state::sleepers::Known;
use crate::walls::WallBody;
use crate::walls::motion::Pose;
use crate::walls::seams::Slots;
use geom::Vec3;
use std::ops::Range;

/// What all parts read.
#[derive(Clone, Copy)]
pub struct Lists<'a> {
    pub i: &'a [u32],
    pub partner: &'a [u32],
    pub shift: &'a [Vec3],
    /// 0, 1, 2, …
    pub count: &'a [u32],
    pub met: &'a [Met],
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
    pub fn stirred(&self, particle: usize, asleep: &[bool]) -> bool {
        let entries = self.starts[particle] as usize..self.starts[particle + 1] as usize;
        self.new
            || self.entries[entries].iter().any(|&entry| {
                let (place, second) = ((entry >> 1) as usize, entry & 1 == 1);
                match self.met[place / BLOCK] {
                    Met::Particles => {
                        !asleep[if second { self.i[place] } else { self.partner[place] } as usize]
                    }
                    Met::StillWall => false,
                    Met::MovingWall => true,
                }
            })
    }

    /// Whether all contacts of a block are between sleepers, or of sleepers with a wall at rest.
    pub fn rests(&self, block: usize, asleep: &[bool]) -> bool {
        let all = |of: &[u32]| of[block * BLOCK..(block + 1) * BLOCK].iter().all(|&k| asleep[k as usize]);
        !self.new
            && match self.met[block] {
                Met::Particles => all(self.i) && all(self.partner),
                Met::StillWall => all(self.i),
                Met::MovingWall => false,
            }
    }
}

/// What a contact needs besides the lists.
#[derive(Clone, Copy)]
pub struct Scenery<'a> {
    pub kinds: &'a [Kind],
    pub walls: &'a [WallBody],
    pub poses: &'a [Pose],
    /// Length of the box along periodic axes, 0 along others [m].
    pub period: Vec3,
    pub width: Width,
    pub common: Common<'a>,
    /// Who sleeps, where the scene asks for it.
    pub known: Option<Known<'a>>,
}

/// Where a part begins.
#[derive(Debug, Clone, Copy, Default)]
pub struct At {
    place: usize,
    row: usize,
    memory: usize,
    kept: usize,
}

/// Some segments that follow each other, with their part of everything that is computed.
pub struct Part<'a> {
    pub segments: &'a [Segment],
    pub form: Form,
    pub from: At,
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

impl<'a> Part<'a> {
    /// The first `count` segments, and the others.
    pub fn split(self, count: usize) -> (Part<'a>, Part<'a>) {
        let Part { segments, form, from, rows, spins, memory, active, kept, each, ledger } = self;
        let (first, second) = segments.split_at(count);
        let all = At {
            place: from.place + active.len() * BLOCK,
            row: from.row + rows.len(),
            memory: from.memory + memory.len(),
            kept: from.kept + kept.0.len() / form.load(),
        };
        let of = |s: &Segment| At { place: s.places.start, row: s.rows, memory: s.memory, kept: s.kept };
        let to = second.first().map_or(all, of);
        let places = to.place - from.place;
        let (rows, rows2) = rows.split_at_mut(to.row - from.row);
        let (spins, spins2) = split(spins, to.row - from.row);
        let (memory, memory2) = memory.split_at_mut(to.memory - from.memory);
        let (active, active2) = active.split_at_mut(places / BLOCK);
        let (kept, kept2) = split_both(kept, to.kept - from.kept, form);
        let (each, each2) = split_both(each, places, form);
        let (ledger, ledger2) = split(ledger, places * LEDGER);
        let one = Part { segments: first, form, from, rows, spins, memory, active, kept, each, ledger };
        let two = Part {
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

    /// Contact points and loads of segment `k` of this part, added to the `sums` of its tile; true when an overlap passes the limit.
    pub fn compute(&mut self, k: usize, (lists, scenery): Seen, sums: &mut Sums) -> bool {
        let s = &self.segments[k];
        self.renew(s, lists, scenery);
        self.compute_places(s, s.places.clone(), (lists, scenery), sums)
    }

    /// Adds loads that were computed before: those of contacts `places` of a segment.
    pub fn recall(&mut self, s: &Segment, places: Range<usize>, (lists, scenery): Seen, sums: &mut Sums) {
        let both = scenery.kinds[s.kind].with == With::Particles && !s.later;
        let (first, n) = (places.start - self.from.place, places.len());
        let pairs = (&lists.i[places.clone()], &lists.partner[places.clone()]);
        let (load, couple) = (self.form.load(), self.form.couple());
        let loads = part(self.each.0, first * load, n * load);
        let couples = part(self.each.1, first * couple, n * couple);
        sums.take_again(pairs, both, (loads, couples));
        if s.later || scenery.kinds[s.kind].with == With::Images {
            let kept = s.kept - self.from.kept + places.start - s.places.start;
            self.kept.0[kept * load..][..loads.len()].copy_from_slice(loads);
            part_mut(self.kept.1, kept * couple, n * couple).copy_from_slice(couples);
        }
    }

    /// What is passed over loses no energy.
    pub fn forget_ledger(&mut self, places: Range<usize>) {
        let first = places.start - self.from.place;
        for row in part_mut(self.ledger, first * LEDGER, places.len() * LEDGER).chunks_exact_mut(LEDGER) {
            row[1..].fill(0.0);
        }
    }

    /// Loads of contacts `places` of a segment, whose contact points are found.
    pub fn compute_places(
        &mut self,
        s: &Segment,
        places: Range<usize>,
        (lists, scenery): Seen,
        sums: &mut Sums,
    ) -> bool {
        let kind = &scenery.kinds[s.kind];
        let (first, n) = (places.start - self.from.place, places.len());
        let words = self.form.memory(kind.kernel.columns());
        let within = places.start - s.places.start;
        let (row, memory) = (s.rows - self.from.row + within, s.memory - self.from.memory + within * words);
        let (partners, j) = match kind.with {
            With::Particles => ((scenery.common.rows, scenery.common.spins), &lists.partner[places.clone()]),
            _ => ((&self.rows[row..row + n], part(self.spins, row, n)), &lists.count[..n]),
        };
        let keeps = s.later || kind.with == With::Images;
        let (kept, kept_n) = if keeps { (s.kept - self.from.kept + within, n) } else { (0, 0) };
        let task = Task {
            partners,
            i: &lists.i[places],
            j,
            memory: &mut self.memory[memory..memory + n * words],
            active: &mut self.active[first / BLOCK..(first + n) / BLOCK],
            sums: sums.by_ref(),
            both: kind.with == With::Particles && !s.later,
            kept: some(&mut self.kept, kept, kept_n, self.form),
            each: some(&mut self.each, first, n, self.form),
            ledger: part_mut(self.ledger, first * LEDGER, n * LEDGER),
        };
        kind.kernel.run(scenery.width, scenery.common, task)
    }

    /// Finds the contact points of images and walls as they are now.
    pub fn renew(&mut self, s: &Segment, lists: &Lists, scenery: &Scenery) {
        let kind = &scenery.kinds[s.kind];
        let first = s.rows - self.from.row;
        let (i, partner) = (&lists.i[s.contacts()], &lists.partner[s.contacts()]);
        match kind.with {
            With::Particles => {}
            With::Images => {
                for (k, (&j, shift)) in partner.iter().zip(&lists.shift[s.contacts()]).enumerate() {
                    let mut row = scenery.common.rows[j as usize];
                    for a in 0..3 {
                        row[a] += shift[a];
                    }
                    self.rows[first + k] = row;
                    if let Some(spin) = self.spins.get_mut(first + k) {
                        *spin = scenery.common.spins[j as usize];
                    }
                }
            }
            With::Wall(w) if lists.new || scenery.walls[w].renewed() => {
                let (form, columns) = (self.form, kind.kernel.columns());
                let memory = s.memory - self.from.memory;
                let memory = &mut self.memory[memory..memory + s.places.len() * form.memory(columns)];
                let active = (s.places.start - self.from.place) / BLOCK;
                let active = &mut self.active[active..active + s.places.len() / BLOCK];
                let mut slots = Slots { memory, active, form, first: 0, columns };
                let mut from = 0;
                while from < s.len {
                    let to = from + i[from..].iter().take_while(|&&k| k == i[from]).count();
                    let row = &scenery.common.rows[i[from] as usize];
                    let rows = &mut self.rows[first + from..first + to];
                    let spins = part_mut(self.spins, first + from, to - from);
                    let pose = (&scenery.poses[w], &scenery.period);
                    scenery.walls[w].meet(pose, row, &partner[from..to], (rows, spins), slots.from(from));
                    from = to;
                }
            }
            With::Wall(_) => {}
        }
    }

    /// Loads and couples that are kept for other tiles.
    pub fn kept(&self) -> Computed<'_> {
        (self.kept.0, self.kept.1)
    }
}

/// What a contact needs besides its own.
pub type Seen<'a> = (&'a Lists<'a>, &'a Scenery<'a>);

/// Some of a column, or none of a column that does not exist.
fn part<T>(of: &[T], from: usize, n: usize) -> &[T] {
    if of.is_empty() { &[] } else { &of[from..from + n] }
}

fn part_mut<T>(of: &mut [T], from: usize, n: usize) -> &mut [T] {
    if of.is_empty() { &mut [] } else { &mut of[from..from + n] }
}

/// Some loads and couples, or none of those that do not exist.
fn some<'a>(
    of: &'a mut (&mut [f64], &mut [f64]),
    from: usize,
    n: usize,
    form: Form,
) -> (&'a mut [f64], &'a mut [f64]) {
    let (load, couple) = (form.load(), form.couple());
    (part_mut(of.0, from * load, n * load), part_mut(of.1, from * couple, n * couple))
}

type Both<'a> = (&'a mut [f64], &'a mut [f64]);

fn split_both<'a>((loads, couples): Both<'a>, n: usize, form: Form) -> (Both<'a>, Both<'a>) {
    let (loads, loads2) = split(loads, n * form.load());
    let (couples, couples2) = split(couples, n * form.couple());
    ((loads, couples), (loads2, couples2))
}

fn split<T>(of: &mut [T], at: usize) -> (&mut [T], &mut [T]) {
    let at = at.min(of.len());
    of.split_at_mut(at)
}
