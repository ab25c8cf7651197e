//! All listed contacts, in the order of the tiles of particles that they belong to.
//!
//! A kind of contact is a pair of materials that particles have, or a wall and a material. Each has its own composition of
//! effects, so that a frictionless pair takes no memory even where another has friction. Contacts of one kind in one tile are a
//! segment: whole blocks, one task of the contact loop. Images across periodic faces come first, before all tiles.

use crate::kernel::LEDGER;
use crate::kernel::sums::{Arrival, Sums, WrenchSums};
use crate::model::kind::With;
use crate::neighbours::resting::RestingTile;
use crate::neighbours::slices::{Lists, SliceStart, TileSlice};
use crate::simd::aligned::Aligned;
use crate::simd::number::Layout;
use crate::simd::{BLOCK, Row, Row4};
use geom::Vec3;
use std::borrow::Cow;
use std::ops::Range;

/// What may disturb a sleeper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Disturber {
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
    /// Whether the second of each is a particle of a later tile.
    pub later: bool,
    /// Where its memory, its contact points and its kept loads begin.
    pub memory: usize,
    pub rows: usize,
    pub kept: usize,
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
    /// How what is computed is kept.
    pub form: Layout,
    /// How many particles there are.
    pub(crate) particles: usize,
    /// Particles of a tile.
    pub(crate) tile: usize,
    /// First segment of each tile, and one more.
    pub tiles: Vec<usize>,
    /// First particle of each contact.
    pub i: Vec<u32>,
    /// Second particle, or part of the wall.
    pub partner: Vec<u32>,
    /// Shift of an image [m], by place.
    pub(crate) shift: Vec<Vec3>,
    pub(crate) rows: Vec<Row>,
    pub(crate) spins: Vec<Row4>,
    /// Contact memory.
    pub memory: Aligned,
    pub(crate) active: Vec<bool>,
    /// Force and moment of each contact, where an observer wants them; else none.
    pub loads: Aligned,
    /// Couples, or none.
    pub torques: Aligned,
    /// Whether these are kept now.
    pub(crate) keeps: bool,
    /// Of loads and couples, by particle.
    pub(crate) sums: (Aligned, Aligned),
    /// Loads and couples that are kept for other tiles.
    pub(crate) kept: (Aligned, Aligned),
    /// What arrives at each tile, in the order of the places it comes from.
    pub(crate) arrivals: Vec<Arrival>,
    /// First arrival of each tile, and one more.
    pub(crate) arriving: Vec<u32>,
    /// Energy of each contact, or none.
    pub ledger: Aligned,
    /// Sliding work of each contact since it was asked for [J], or none.
    pub work: Vec<f64>,
    /// First entry of each particle, and one more; none before [`Contacts::index`].
    pub starts: Vec<u32>,
    /// Place × 2, + 1 where the particle is the second; none before [`Contacts::index`].
    pub entries: Vec<u32>,
    pub(crate) count: Vec<u32>,
    /// What the contacts of each block meet; only where particles sleep.
    pub(crate) met: Vec<Disturber>,
    /// What rests in each tile; only where particles sleep.
    pub(crate) resting_tiles: Vec<RestingTile>,
    /// Whether contact points of walls at rest are to be found.
    pub new: bool,
}

impl Contacts {
    /// Particles of a tile.
    pub fn tile(&self) -> usize {
        self.tile
    }

    /// Number of contacts.
    pub fn len(&self) -> usize {
        self.segments.iter().map(|s| s.len).sum()
    }

    /// Energy in their springs [J]; 0 without the ledger.
    pub fn elastic(&self) -> f64 {
        self.ledger.chunks_exact(LEDGER).map(|row| row[0]).sum()
    }

    /// Room for what is computed of them: whether there are couples, whether a ledger is kept.
    pub fn allocate(&mut self, torques: bool, ledger: bool) {
        let (places, particles, load, torque) =
            (self.i.len(), self.particles, self.form.load(), self.form.torque());
        let kept = self.segments.last().map_or(0, |s| s.kept + s.places.len());
        let some = |torques: bool, n: usize| Aligned::zeros(if torques { n * torque } else { 0 });
        self.sums = (Aligned::zeros(particles * load), some(torques, particles));
        self.kept = (Aligned::zeros(kept * load), some(torques, kept));
        (self.loads, self.torques, self.keeps) = Default::default();
        self.ledger = Aligned::zeros(if ledger { places * LEDGER } else { 0 });
        self.work.resize(if ledger { places } else { 0 }, 0.0);
    }

    /// Gives the room back.
    pub fn release_memory(&mut self) {
        (self.sums, self.kept, self.ledger) = Default::default();
        (self.loads, self.torques, self.keeps) = Default::default();
    }

    /// Whether the load and couple of each contact are kept from now on. Where they were not, all begin at 0: blocks in which nothing touches
    /// are not computed.
    pub fn keep_wrenches(&mut self, keep: bool) {
        if keep && !self.keeps {
            let places = self.i.len();
            let torques = if self.sums.1.is_empty() { 0 } else { places };
            self.loads.clear(places * self.form.load());
            self.torques.clear(torques * self.form.torque());
        }
        self.keeps = keep;
    }

    /// Whether the load and couple of each contact are kept.
    pub fn keeps(&self) -> bool {
        self.keeps
    }

    /// Puts loads, couples and ledger of each contact, or sums by particle, as they were saved; false where there are other numbers of them.
    pub fn put_loads(&mut self, each: &[Cow<[f64]>; 3], sums: &[Cow<[f64]>; 2]) -> bool {
        let Contacts { loads, torques, ledger, keeps, .. } = self;
        let (mine, sums_mine) = ([loads, torques], [&mut self.sums.0, &mut self.sums.1]);
        let pairs: Vec<(&Cow<[f64]>, &mut Aligned)> = match keeps {
            true => each.iter().zip(mine.into_iter().chain([ledger])).collect(),
            false => sums.iter().zip(sums_mine).chain([(&each[2], ledger)]).collect(),
        };
        for (saved, now) in pairs {
            if saved.len() != now.len() {
                return false;
            }
            now.copy_from_slice(saved);
        }
        true
    }

    /// Sums of the loads on all particles.
    pub fn sums(&self) -> WrenchSums<'_> {
        WrenchSums { first: 0, form: self.form, sums: (&self.sums.0, &self.sums.1) }
    }

    /// The particle of a contact, and the other one where it is not with a wall.
    pub fn ends(&self, with: With, place: usize) -> (u32, Option<u32>) {
        let pair = !matches!(with, With::Wall(_));
        (self.i[place], pair.then(|| self.partner[place]))
    }

    /// The segment that a place belongs to.
    pub fn segment_of(&self, place: usize) -> &Segment {
        &self.segments[self.segments.partition_point(|s| s.places.start <= place) - 1]
    }

    /// Number `column` of so many in the memory of contact `place`.
    pub fn history_of_slot(&self, segment: &Segment, place: usize, column: usize, columns: usize) -> f64 {
        let at = self.form.memory_at(segment.memory, place - segment.places.start, column, columns);
        self.form.get(&self.memory, at)
    }

    /// Gives one contact its memory, in the order of its kind's columns.
    pub fn set_history(&mut self, segment: &Segment, place: usize, columns: &[f64]) {
        for (c, number) in columns.iter().enumerate() {
            let at = self.form.memory_at(segment.memory, place - segment.places.start, c, columns.len());
            self.form.put(&mut self.memory, at, *number);
        }
        self.active[place / BLOCK] = true;
    }

    /// Force on the first particle of contact `place` [N], where each is kept.
    pub fn force(&self, place: usize) -> Vec3 {
        self.form.force(&self.loads, place)
    }

    /// Contact point of an image or a wall when loads were computed: place, radius (0 on a flat wall) [m].
    pub fn partner_row(&self, segment: &Segment, place: usize) -> &Row {
        &self.rows[segment.rows + place - segment.places.start]
    }

    /// Everything, to be computed.
    pub fn parts(&mut self) -> (Lists<'_>, TileSlice<'_>, Sums<'_>, &mut [RestingTile]) {
        let lists = Lists {
            i: &self.i,
            partner: &self.partner,
            shift: &self.shift,
            count: &self.count,
            met: &self.met,
            new: self.new,
            tiles: &self.tiles,
            tile: self.tile,
            starts: &self.starts,
            entries: &self.entries,
            arrivals: &self.arrivals,
            arriving: &self.arriving,
        };
        let part = TileSlice {
            segments: &self.segments,
            form: self.form,
            from: SliceStart::default(),
            rows: &mut self.rows,
            spins: &mut self.spins,
            memory: &mut self.memory,
            active: &mut self.active,
            kept: (&mut self.kept.0, &mut self.kept.1),
            each: if self.keeps { (&mut self.loads, &mut self.torques) } else { Default::default() },
            ledger: &mut self.ledger,
        };
        let sums = Sums { first: 0, form: self.form, loads: &mut self.sums.0, torques: &mut self.sums.1 };
        (lists, part, sums, &mut self.resting_tiles)
    }
}
