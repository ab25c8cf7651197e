//! All listed contacts, in the order of the tiles of particles that they belong to.
//!
//! A kind of contact is a pair of materials that particles have, or a wall and a material. Each has its own composition of
//! effects, so that a frictionless pair takes no memory even where another has friction. Contacts of one kind in one tile are a
//! segment: whole blocks, one task of the contact loop. Images across periodic faces come first, before all tiles.

use crate::aligned::Aligned;
use crate::kernel::{Common, Kernel, LEDGER, Task};
use crate::lane::{BLOCK, Row, Row4, Width};
use crate::motion::Pose;
use crate::particles::FAR;
use crate::seams::Slots;
use crate::sleep::runs;
use crate::walls::WallBody;
use geom::Vec3;
use std::ops::Range;

/// Particles of a tile.
pub const TILE: usize = 256;

/// Whom the particles of a kind of contact meet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum With {
    /// Each other.
    Particles,
    /// Each other across a periodic face.
    Images,
    /// The wall of this number.
    Wall(usize),
}

/// Contacts that share a law.
pub struct Kind {
    /// The law.
    pub kernel: Box<dyn Kernel>,
    /// Materials, lower first; of the particle, then of the wall.
    pub between: (u16, u16),
    /// Whom they meet.
    pub with: With,
}

/// What may disturb a sleeper.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Met {
    Particles,
    StillWall,
    MovingWall,
}

/// Contacts of one kind in one tile.
#[derive(Debug, Clone)]
pub struct Segment {
    /// Which kind.
    pub kind: usize,
    /// Places of its contacts, whole blocks.
    pub places: Range<usize>,
    /// How many of them are contacts.
    pub len: usize,
    memory: usize,
    rows: usize,
}

impl Segment {
    /// Places that hold contacts.
    pub fn contacts(&self) -> Range<usize> {
        self.places.start..self.places.start + self.len
    }
}

/// The lists, and what was computed of them.
#[derive(Default)]
pub struct Contacts {
    /// In order of their places.
    pub segments: Vec<Segment>,
    /// First segment of each tile, and one more.
    pub tiles: Vec<usize>,
    /// First particle of each contact.
    pub i: Vec<u32>,
    /// Second particle, or part of the wall.
    pub partner: Vec<u32>,
    /// Shift of an image [m], by place.
    shift: Vec<Vec3>,
    rows: Vec<Row>,
    spins: Vec<Row4>,
    /// Contact memory.
    pub memory: Aligned,
    active: Vec<bool>,
    /// Forces and moments.
    pub loads: Aligned,
    /// Couples, or none.
    pub couples: Aligned,
    /// Energy of each contact, or none.
    pub ledger: Aligned,
    /// Sliding work of each contact since it was asked for [J], or none.
    pub work: Vec<f64>,
    /// First entry of each particle, and one more.
    pub starts: Vec<u32>,
    /// Place × 2, + 1 where the particle is the second.
    pub entries: Vec<u32>,
    /// For each tile, the first that has a contact with it.
    lowest: Vec<u32>,
    count: Vec<u32>,
    /// Whom the contacts of each block meet; only where particles sleep.
    met: Vec<Met>,
    /// Whether contact points of walls at rest are to be found.
    pub new: bool,
}

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
    /// Contacts of `images`, then of each tile, a list for every kind; of so many particles.
    pub fn new(kinds: &[Kind], images: &[List], tiles: &[Vec<List>], particles: usize) -> Contacts {
        let mut new = Contacts { new: true, ..Contacts::default() };
        let most: usize = images.iter().chain(tiles.iter().flatten()).map(|l| l.i.len() + BLOCK).sum();
        new.i.reserve(most);
        new.partner.reserve(most);
        let (mut memory, mut rows) = (0, 0);
        let mut put = |kind: usize, list: &List, new: &mut Contacts| {
            let len = list.i.len();
            if len == 0 {
                return;
            }
            let first = new.i.len();
            new.i.extend(&list.i);
            new.partner.extend(&list.partner);
            new.shift.extend(&list.shift);
            let places = first..first + len.next_multiple_of(BLOCK);
            new.i.resize(places.end, particles as u32);
            new.partner.resize(places.end, particles as u32 + 1);
            if !list.shift.is_empty() {
                new.shift.resize(places.end, Vec3::zeros());
            }
            let padded = places.len();
            new.segments.push(Segment { kind, places, len, memory, rows });
            memory += padded * kinds[kind].kernel.memory();
            rows += if kinds[kind].with == With::Particles { 0 } else { padded };
        };
        images.iter().enumerate().for_each(|(kind, list)| put(kind, list, &mut new));
        for tile in tiles {
            new.tiles.push(new.segments.len());
            tile.iter().enumerate().for_each(|(kind, list)| put(kind, list, &mut new));
        }
        new.tiles.push(new.segments.len());
        let turns = kinds.iter().any(|k| k.kernel.rotates());
        new.rows = vec![FAR[1]; rows];
        new.spins = vec![Row4::default(); if turns { rows } else { 0 }];
        new.memory = Aligned::zeros(memory);
        new.active = vec![true; new.i.len() / BLOCK];
        let largest = new.segments.iter().filter(|s| kinds[s.kind].with != With::Particles);
        new.count = (0..largest.map(|s| s.places.len()).max().unwrap_or(0) as u32).collect();
        new.index(kinds, particles);
        new.find_lowest(kinds);
        new
    }

    fn find_lowest(&mut self, kinds: &[Kind]) {
        self.lowest = (0..self.tiles.len() as u32 - 1).collect();
        let pairs = |s: &&Segment| kinds[s.kind].with == With::Particles;
        for place in self.segments.iter().filter(pairs).flat_map(Segment::contacts) {
            let from = self.i[place] / TILE as u32;
            let lowest = &mut self.lowest[self.partner[place] as usize / TILE];
            *lowest = from.min(*lowest);
        }
    }

    /// Notes whom blocks meet.
    pub fn note_walls(&mut self, kinds: &[Kind], walls: &[WallBody]) {
        self.met = vec![Met::Particles; self.active.len()];
        for s in &self.segments {
            if let With::Wall(w) = kinds[s.kind].with {
                let met = if walls[w].motion.moves() { Met::MovingWall } else { Met::StillWall };
                self.met[s.places.start / BLOCK..s.places.end / BLOCK].fill(met);
            }
        }
    }

    /// For each particle, its contacts in the order of their places.
    fn index(&mut self, kinds: &[Kind], particles: usize) {
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

    /// Number of contacts.
    pub fn len(&self) -> usize {
        self.segments.iter().map(|s| s.len).sum()
    }

    /// Energy in their springs [J]; 0 without the ledger.
    pub fn elastic(&self) -> f64 {
        self.ledger.chunks_exact(LEDGER).map(|row| row[0]).sum()
    }

    /// Room for what is computed of them: numbers of one load, whether there are couples, whether a ledger is kept.
    pub fn make_room(&mut self, stride: usize, couples: bool, ledger: bool) {
        let places = self.i.len();
        self.loads = Aligned::zeros(places * stride);
        self.couples = Aligned::zeros(if couples { places * 4 } else { 0 });
        self.ledger = Aligned::zeros(if ledger { places * LEDGER } else { 0 });
        self.work.resize(if ledger { places } else { 0 }, 0.0);
    }

    /// The segment that a place belongs to.
    pub fn segment_of(&self, place: usize) -> &Segment {
        &self.segments[self.segments.partition_point(|s| s.places.start <= place) - 1]
    }

    /// Where number `column` of so many in the memory of contact `place` is.
    pub fn memory_at(&self, segment: &Segment, place: usize, column: usize, columns: usize) -> usize {
        let k = place - segment.places.start;
        segment.memory + (k / BLOCK * columns + column) * BLOCK + k % BLOCK
    }

    /// Contact point of an image or a wall when loads were computed: place, radius (0 on a flat wall) [m].
    pub fn partner_row(&self, segment: &Segment, place: usize) -> &Row {
        &self.rows[segment.rows + place - segment.places.start]
    }

    /// Memory that lists, contact points and what is computed take [bytes].
    pub fn bytes(&self) -> usize {
        use std::mem::size_of_val;
        size_of_val(&self.i[..])
            + size_of_val(&self.partner[..])
            + size_of_val(&self.shift[..])
            + size_of_val(&self.rows[..])
            + size_of_val(&self.spins[..])
            + size_of_val(&self.active[..])
            + size_of_val(&self.entries[..])
            + 8 * (self.work.len()
                + self.memory.len()
                + self.loads.len()
                + self.couples.len()
                + self.ledger.len())
    }

    /// Everything, to be computed; `stride`: numbers of one load.
    pub fn parts(&mut self, stride: usize) -> (Lists<'_>, Part<'_>) {
        let lists = Lists {
            i: &self.i,
            partner: &self.partner,
            shift: &self.shift,
            count: &self.count,
            met: &self.met,
            new: self.new,
            tiles: &self.tiles,
            lowest: &self.lowest,
            starts: &self.starts,
            entries: &self.entries,
        };
        let part = Part {
            segments: &self.segments,
            stride,
            from: At::default(),
            rows: &mut self.rows,
            spins: &mut self.spins,
            memory: &mut self.memory,
            active: &mut self.active,
            loads: &mut self.loads,
            couples: &mut self.couples,
            ledger: &mut self.ledger,
        };
        (lists, part)
    }
}

/// What all parts read.
#[derive(Clone, Copy)]
pub struct Lists<'a> {
    i: &'a [u32],
    partner: &'a [u32],
    shift: &'a [Vec3],
    count: &'a [u32],
    met: &'a [Met],
    new: bool,
    /// First segment of each tile, and one more.
    pub tiles: &'a [usize],
    /// For each tile, the first that has a contact with it.
    pub lowest: &'a [u32],
    /// First entry of each particle, and one more.
    pub starts: &'a [u32],
    /// Place × 2, + 1 where the particle is the second.
    pub entries: &'a [u32],
}

impl Lists<'_> {
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
    fn rests(&self, block: usize, asleep: &[bool]) -> bool {
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
    pub asleep: Option<&'a [bool]>,
}

/// Where a part begins.
#[derive(Debug, Clone, Copy, Default)]
struct At {
    place: usize,
    row: usize,
    memory: usize,
}

/// Some segments that follow each other, with their part of everything that is computed.
pub struct Part<'a> {
    pub segments: &'a [Segment],
    stride: usize,
    from: At,
    rows: &'a mut [Row],
    spins: &'a mut [Row4],
    memory: &'a mut [f64],
    active: &'a mut [bool],
    loads: &'a mut [f64],
    couples: &'a mut [f64],
    ledger: &'a mut [f64],
}

impl<'a> Part<'a> {
    /// The same, for a while.
    pub fn by_ref(&mut self) -> Part<'_> {
        Part {
            segments: self.segments,
            stride: self.stride,
            from: self.from,
            rows: self.rows,
            spins: self.spins,
            memory: self.memory,
            active: self.active,
            loads: self.loads,
            couples: self.couples,
            ledger: self.ledger,
        }
    }

    /// The first `count` segments, and the others.
    pub fn split(self, count: usize) -> (Part<'a>, Part<'a>) {
        let Part { segments, stride, from, rows, spins, memory, active, loads, couples, ledger } = self;
        let (first, second) = segments.split_at(count);
        let all = At {
            place: from.place + active.len() * BLOCK,
            row: from.row + rows.len(),
            memory: from.memory + memory.len(),
        };
        let to = second.first().map_or(all, |s| At { place: s.places.start, row: s.rows, memory: s.memory });
        let places = to.place - from.place;
        let (rows, rows2) = rows.split_at_mut(to.row - from.row);
        let (spins, spins2) = split(spins, to.row - from.row);
        let (memory, memory2) = memory.split_at_mut(to.memory - from.memory);
        let (active, active2) = active.split_at_mut(places / BLOCK);
        let (loads, loads2) = loads.split_at_mut(places * stride);
        let (couples, couples2) = split(couples, places * 4);
        let (ledger, ledger2) = split(ledger, places * LEDGER);
        let one = Part { segments: first, stride, from, rows, spins, memory, active, loads, couples, ledger };
        let two = Part {
            segments: second,
            stride,
            from: to,
            rows: rows2,
            spins: spins2,
            memory: memory2,
            active: active2,
            loads: loads2,
            couples: couples2,
            ledger: ledger2,
        };
        (one, two)
    }

    /// Contact points and loads of segment `k` of this part; true when an overlap passes the limit.
    pub fn compute(&mut self, k: usize, lists: &Lists, scenery: &Scenery) -> bool {
        let s = &self.segments[k];
        self.renew(s, lists, scenery);
        let Some(asleep) = scenery.asleep else {
            return self.compute_places(s, s.places.clone(), lists, scenery);
        };
        let blocks = s.places.start / BLOCK..s.places.end / BLOCK;
        let rests: Vec<bool> = blocks.map(|b| lists.rests(b, asleep)).collect();
        let mut deep = false;
        for run in runs(&rests) {
            let places = s.places.start + run.start * BLOCK..s.places.start + run.end * BLOCK;
            if rests[run.start] {
                self.forget_ledger(places);
            } else {
                deep |= self.compute_places(s, places, lists, scenery);
            }
        }
        deep
    }

    /// What is passed over loses no energy.
    fn forget_ledger(&mut self, places: Range<usize>) {
        let first = places.start - self.from.place;
        for row in part_mut(self.ledger, first * LEDGER, places.len() * LEDGER).chunks_exact_mut(LEDGER) {
            row[1..].fill(0.0);
        }
    }

    fn compute_places(
        &mut self,
        s: &Segment,
        places: Range<usize>,
        lists: &Lists,
        scenery: &Scenery,
    ) -> bool {
        let kind = &scenery.kinds[s.kind];
        let (first, n) = (places.start - self.from.place, places.len());
        let columns = kind.kernel.memory();
        let within = places.start - s.places.start;
        let (row, memory) = (s.rows - self.from.row + within, s.memory - self.from.memory + within * columns);
        let (partners, j) = match kind.with {
            With::Particles => ((scenery.common.rows, scenery.common.spins), &lists.partner[places.clone()]),
            _ => ((&self.rows[row..row + n], part(self.spins, row, n)), &lists.count[..n]),
        };
        let task = Task {
            partners,
            i: &lists.i[places],
            j,
            memory: &mut self.memory[memory..memory + n * columns],
            active: &mut self.active[first / BLOCK..(first + n) / BLOCK],
            loads: &mut self.loads[first * self.stride..(first + n) * self.stride],
            couples: part_mut(self.couples, first * 4, n * 4),
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
                let columns = kind.kernel.memory();
                let memory = s.memory - self.from.memory;
                let memory = &mut self.memory[memory..memory + s.places.len() * columns];
                let mut slots = Slots { memory, first: 0, columns };
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

    /// Loads and couples of this part, and the place of the first.
    pub fn loads(&self) -> (usize, &[f64], &[f64]) {
        (self.from.place, self.loads, self.couples)
    }
}

/// Some of a column, or none of a column that does not exist.
fn part<T>(of: &[T], from: usize, n: usize) -> &[T] {
    if of.is_empty() { &[] } else { &of[from..from + n] }
}

fn part_mut<T>(of: &mut [T], from: usize, n: usize) -> &mut [T] {
    if of.is_empty() { &mut [] } else { &mut of[from..from + n] }
}

fn split<T>(of: &mut [T], at: usize) -> (&mut [T], &mut [T]) {
    let at = at.min(of.len());
    of.split_at_mut(at)
}
