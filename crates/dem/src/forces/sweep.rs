//! One pass over the tiles, in two halves: the loads of their contacts, which read all particles; then, for each tile, the loads that arrive
//! from others, and the move of its particles. Tiles are shared out to threads; no result depends on how.
//!
//! A tile's contacts are with its own particles and with those of later tiles. So one thread alone takes both halves of a tile at once: who
//! still reads its particles comes before it, and what it computes is in the cache when it moves.

use crate::forces::resting::Still;
use crate::forces::tile::Part;
use crate::forces::tile::Scenery;
use crate::forces::tile::Seen;
use crate::kernel::Common;
use crate::kernel::sums::Sums;
use crate::passes::integrate::Columns;
use crate::passes::integrate::Drive;
use crate::passes::integrate::Moved;
use crate::passes::integrate::advance;
use crate::passes::sleep::Sleepers;
use crate::passes::sleep::advance_awake;
use crate::simd::Row;
use crate::simd::Row4;
use crate::simulation::Simulation;
use crate::state::particles::Particles;
use crate::walls::motion::Pose;
use rayon::prelude::*;
use std::ops::Range;

/// Particles below which one thread is faster than several.
pub(crate) const FEW: usize = 2048;

/// What a pass is to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Pass {
    /// Loads of this instant.
    Loads,
    /// The move, with loads that are there.
    Move,
    /// Both at once.
    Step,
    /// Sums of loads that were computed before.
    Recall,
}

/// What a pass found.
#[derive(Clone, Default)]
pub struct Found {
    /// Segments in which an overlap passes its limit.
    pub deep: Vec<Range<usize>>,
    /// Of the particles that moved.
    pub moved: Moved,
}

impl Simulation {
    /// Computes loads, moves particles, or both.
    pub(crate) fn pass(&mut self, pass: Pass) -> Found {
        if pass == Pass::Step && self.goes_in_turn() {
            return self.step_in_turn();
        }
        let deep = match pass {
            Pass::Move => Vec::new(),
            Pass::Recall => self.add_again(),
            Pass::Loads | Pass::Step => self.compute(pass == Pass::Loads),
        };
        if matches!(pass, Pass::Loads | Pass::Step) {
            self.pull_bonds();
        }
        let moved = self.finish(pass != Pass::Move, matches!(pass, Pass::Move | Pass::Step));
        Found { deep, moved }
    }

    /// Loads of all contacts, and their sums within tiles; the segments in which an overlap passes its limit. `looks`: the load of each contact
    /// is kept.
    fn compute(&mut self, looks: bool) -> Vec<Range<usize>> {
        self.contacts.keep_each(looks && self.records || self.keeps_each());
        self.for_tiles(|part, still, seen, sums| match still {
            Some(still) => still.compute(part, seen, sums),
            None => {
                sums.clear();
                (0..part.segments.len()).fold(false, |any, k| any | part.compute(k, seen, sums))
            }
        })
    }

    /// Sums within tiles of loads that were computed before.
    fn add_again(&mut self) -> Vec<Range<usize>> {
        self.for_tiles(|part, still, seen, sums| {
            match still {
                Some(still) => still.recall(part, seen, sums),
                None => {
                    sums.clear();
                    part.segments.iter().for_each(|s| part.recall(s, s.places.clone(), seen, sums));
                }
            }
            false
        })
    }

    /// Does something with each segment of images, and with each tile, what rests there, and its sums; the segments of those that say so.
    fn for_tiles(
        &mut self,
        each: impl Fn(&mut Part, Option<&mut Still>, Seen, &mut Sums) -> bool + Sync,
    ) -> Vec<Range<usize>> {
        let poses = self.poses();
        let (period, form, many) = (self.period(), self.contacts.form, self.particles.len() >= FEW);
        let Particles { rows, spins, .. } = &self.particles;
        let spins = if self.particles.rotates() { &spins[..] } else { &[] };
        let common = Common { dt: self.dt, overlap_limit: self.setup.guards.overlap, rows, spins, form };
        let known = self.sleepers.as_ref().map(Sleepers::known);
        let (kinds, walls, width) = (&self.kinds, &self.walls, self.width);
        let scenery = Scenery { kinds, walls, poses: &poses, period, width, common, known };
        let (lists, part, mut sums, stills) = self.contacts.parts();
        let (mut images, mut rest) = part.split(lists.tiles[0]);
        let mut items = Vec::with_capacity(images.segments.len() + lists.tiles.len());
        while !images.segments.is_empty() {
            let (one, others) = images.split(1);
            images = others;
            items.push((one, None, Sums::default()));
        }
        let mut stills = stills.iter_mut();
        for segments in lists.tiles.windows(2) {
            let (one, others) = rest.split(segments[1] - segments[0]);
            let (mine, next) = sums.split(lists.tile);
            (rest, sums) = (others, next);
            items.push((one, stills.next(), mine));
        }
        let run = |(mut part, still, mut sums)| each(&mut part, still, (&lists, &scenery), &mut sums);
        let said = share(many, items, run);
        let tiles = lists.tiles.windows(2).map(|s| s[0]..s[1]);
        let segments = (0..lists.tiles[0]).map(|image| image..image + 1).chain(tiles);
        segments.zip(said).filter(|(_, said)| *said).map(|(segments, _)| segments).collect()
    }

    /// Whether tiles are stepped one after the other: one thread, and nothing that is to be done between the halves.
    fn goes_in_turn(&self) -> bool {
        let alone = self.particles.len() < FEW || rayon::current_num_threads() == 1;
        alone && self.bonds.none() && self.sleepers.is_none()
    }

    /// Both halves of each tile at once.
    fn step_in_turn(&mut self) -> Found {
        let form = self.contacts.form;
        self.contacts.keep_each(self.keeps_each());
        self.note_rows();
        let (poses, period, drive) = (self.poses(), self.period(), self.drive());
        let Particles { rows, spins, acceleration, turning, home, .. } = &mut self.particles;
        let (kinds, walls, width) = (&self.kinds, &self.walls, self.width);
        let (lists, mut part, mut sums, _) = self.contacts.parts();
        let mut found = Found::default();
        let compute =
            |segments: Range<usize>, rows: &[Row], spins: &[Row4], part: &mut Part, sums: &mut Sums| {
                let common =
                    Common { dt: self.dt, overlap_limit: self.setup.guards.overlap, rows, spins, form };
                let scenery = Scenery { kinds, walls, poses: &poses, period, width, common, known: None };
                let deep =
                    segments.clone().fold(false, |any, k| any | part.compute(k, (&lists, &scenery), sums));
                deep.then_some(segments)
            };
        found.deep.extend(compute(0..lists.tiles[0], rows, spins, &mut part, &mut Sums::default()));
        for (tile, segments) in lists.tiles.windows(2).enumerate() {
            let (mut mine, others) = sums.split(lists.tile);
            sums = others;
            mine.clear();
            found.deep.extend(compute(segments[0]..segments[1], rows, spins, &mut part, &mut mine));
            mine.collect(lists.arriving(tile), part.kept());
            let (first, count) = (mine.first, mine.len());
            let (all, turn) =
                (first..first + count, if spins.is_empty() { 0..0 } else { first..first + count });
            let columns = Columns {
                first,
                rows: &mut rows[all.clone()],
                spins: &mut spins[turn.clone()],
                acceleration: &mut acceleration[all.clone()],
                turning: &mut turning[turn],
                home: &home[all],
                sums: mine,
                beds: None,
            };
            found.moved = found.moved.and(advance(width, columns, &drive));
        }
        self.contacts.new = false;
        found
    }

    /// Notes where particles are before they move; a fluid asks for that.
    fn note_rows(&mut self) {
        if self.setup.drag.is_some() {
            self.before.clone_from(&self.particles.rows);
        }
    }

    fn drive(&self) -> Drive {
        let g = self.setup.gravity;
        Drive { dt: self.dt, gravity: [g.x, g.y, g.z], motion_limit: self.setup.guards.motion }
    }

    /// Second half: adds what arrives at each tile from others, and moves its particles, where that is to be done.
    fn finish(&mut self, collects: bool, moves: bool) -> Moved {
        if moves {
            self.note_rows();
        }
        let drive = self.drive();
        let Particles { rows, acceleration, spins, turning, home, .. } = &mut self.particles;
        let (count, many) = (acceleration.len(), acceleration.len() >= FEW);
        let (lists, part, sums, stills) = self.contacts.parts();
        let (rows, rotating) = (&mut rows[..count], if spins.is_empty() { 0 } else { count });
        let spins = &mut spins[..rotating];
        let beds = self.sleepers.as_mut().map(|s| s.beds(self.zones.busy()));
        let mut columns = Columns { first: 0, rows, spins, acceleration, turning, home, sums, beds };
        let mut items = Vec::with_capacity(lists.tiles.len());
        for tile in 0..lists.tiles.len() - 1 {
            let (mine, others) = columns.split((tile + 1) * lists.tile);
            columns = others;
            items.push((tile, mine));
        }
        let (bonds, width) = (&self.bonds, self.width);
        let moved = share(many, items, |(tile, mut columns)| {
            if collects {
                columns.sums.collect(lists.arriving(tile), part.kept());
                bonds.add(&mut columns.sums);
            }
            if moves {
                advance_awake(width, columns, &drive, &lists, stills.get(tile))
            } else {
                Moved::default()
            }
        });
        if moves {
            // Until now: sleepers are looked at after each listing.
            self.contacts.new = false;
        }
        moved.into_iter().fold(Moved::default(), Moved::and)
    }

    /// Where walls are now.
    fn poses(&self) -> Vec<Pose> {
        let time = self.time();
        (0..self.walls.len()).map(|w| self.pose_in_box(w, time)).collect()
    }

    /// Contact points of images and walls, without loads.
    pub(crate) fn find_contact_points(&mut self) {
        self.for_tiles(|part, _, (lists, scenery), _| {
            part.segments.iter().for_each(|s| part.renew(s, lists, scenery));
            false
        });
    }
}

/// Does something with all items, on all threads where there are many: one item at a time, so that all end together.
pub(crate) fn share<T: Send, R: Send>(
    many: bool,
    items: Vec<T>,
    run: impl Fn(T) -> R + Sync + Send,
) -> Vec<R> {
    if many {
        items.into_par_iter().with_max_len(1).map(run).collect()
    } else {
        items.into_iter().map(run).collect()
    }
}
