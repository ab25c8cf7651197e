//! One pass over the tiles: loads of their contacts, and, behind them, the move of their particles.
//!
//! A contact belongs to the tile of its first particle, and its second comes later in space order: when the loads of a tile are
//! computed, its particles have all their loads, and move while those are still in the cache. The contact loop reads the
//! rows of this instant, moves write the next ones. Threads take a region of tiles each; tiles that have contacts
//! with an earlier region wait until all regions are done. No result depends on how tiles are divided.

use crate::advance::{Columns, Drive, Moved};
use crate::kernel::Common;
use crate::lane::Width;
use crate::motion::Pose;
use crate::part::{Lists, Part, Scenery};
use crate::particles::Particles;
use crate::simulation::Simulation;
use crate::sleep::{Beds, advance_awake};
use crate::sums::{Computed, Kept, Sums, stride};
use rayon::prelude::*;
use std::ops::Range;

/// Regions for each thread, so that threads of unequal pace end together.
const REGIONS: usize = 4;
/// Particles below which one thread is faster than several.
const FEW: usize = 2048;

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
#[derive(Clone, Copy, Default)]
pub struct Found {
    /// Whether an overlap passes its limit.
    pub deep: bool,
    /// Of the particles that moved.
    pub moved: Moved,
}

impl Found {
    fn and(self, o: Found) -> Found {
        Found { deep: self.deep | o.deep, moved: self.moved.and(o.moved) }
    }
}

/// Some tiles, with all that is written for them.
struct Region<'a> {
    tiles: Range<usize>,
    part: Part<'a>,
    columns: Columns<'a>,
}

/// What all regions read.
#[derive(Clone, Copy)]
struct Shared<'a> {
    pass: Pass,
    width: Width,
    lists: Lists<'a>,
    scenery: Scenery<'a>,
    drive: Drive,
}

impl Simulation {
    /// Computes loads, moves particles, or both.
    pub(crate) fn pass(&mut self, pass: Pass) -> Found {
        let (poses, period) = (self.poses(), self.period());
        let stride = stride(self.particles.rotates());
        if matches!(pass, Pass::Loads | Pass::Step) && !self.keeps_each() {
            self.contacts.keep_each(pass == Pass::Loads, stride);
        }
        let Particles { rows, acceleration, spins, turning, home, .. } = &mut self.particles;
        let (dt, width, count) = (self.dt, self.width, acceleration.len());
        let rotating = if spins.is_empty() { 0 } else { count };
        let common = Common { dt, overlap_limit: self.setup.guards.overlap, rows, spins, stride };
        let beds = self.sleepers.as_mut().map(|s| s.beds(self.zones.busy()));
        let asleep = beds.as_ref().map(Beds::asleep);
        let (kinds, walls) = (&self.kinds, &self.walls);
        let scenery = Scenery { kinds, walls, poses: &poses, period, width, common, asleep };
        let (lists, part, sums) = self.contacts.parts(stride);
        let columns = Columns {
            first: 0,
            rows: &rows[..count],
            spins: &spins[..rotating],
            next: &mut self.next_rows[..count],
            next_spins: &mut self.next_spins[..rotating],
            acceleration,
            turning,
            home,
            sums,
            beds,
        };
        let g = self.setup.gravity;
        let drive = Drive { dt, gravity: [g.x, g.y, g.z], motion_limit: self.setup.guards.motion };
        let found = Shared { pass, width, lists, scenery, drive }.run(part, columns);
        if matches!(pass, Pass::Loads | Pass::Step) {
            self.contacts.new = false;
        }
        if matches!(pass, Pass::Move | Pass::Step) {
            std::mem::swap(&mut self.particles.rows, &mut self.next_rows);
            std::mem::swap(&mut self.particles.spins, &mut self.next_spins);
        }
        found
    }

    /// Where walls are now.
    fn poses(&self) -> Vec<Pose> {
        let time = self.time();
        (0..self.walls.len()).map(|w| self.pose_in_box(w, time)).collect()
    }

    /// Contact points of images and walls, without loads.
    pub(crate) fn find_contact_points(&mut self) {
        let (poses, period) = (self.poses(), self.period());
        let stride = stride(self.particles.rotates());
        let Particles { rows, spins, .. } = &self.particles;
        let common = Common { dt: self.dt, overlap_limit: self.setup.guards.overlap, rows, spins, stride };
        let (kinds, walls, width) = (&self.kinds, &self.walls, self.width);
        let scenery = Scenery { kinds, walls, poses: &poses, period, width, common, asleep: None };
        let (lists, mut part, _) = self.contacts.parts(stride);
        for segment in part.segments {
            part.renew(segment, &lists, &scenery);
        }
    }
}

impl Shared<'_> {
    fn run(&self, part: Part, mut columns: Columns) -> Found {
        let (mut images, mut own) = part.split(self.lists.tiles[0]);
        let mut found = Found { deep: self.compute_images(images.by_ref()), ..Found::default() };
        let (_, images) = images.kept();
        let ranges = self.ranges();
        if self.pass != Pass::Move {
            let regions =
                divide(&ranges, (self.lists.tiles, self.lists.tile), own.by_ref(), columns.by_ref());
            found = all(regions, found, |r| self.region(r, images));
        }
        let late = self.late(&ranges, columns);
        let (first, own) = own.kept();
        let kept = Kept { images, own, first };
        all(late, found, |c| self.finish(c, &kept))
    }

    fn compute_images(&self, mut images: Part) -> bool {
        if self.pass == Pass::Move {
            return false;
        }
        let mut parts = Vec::new();
        while !images.segments.is_empty() {
            let (first, rest) = images.split(1);
            parts.push(first);
            images = rest;
        }
        let compute = |mut p: Part| self.compute(&mut p, 0, &mut Sums::default());
        parts.into_par_iter().map(compute).reduce(|| false, |a, b| a | b)
    }

    fn compute(&self, part: &mut Part, segment: usize, sums: &mut Sums) -> bool {
        if self.pass == Pass::Recall {
            part.recall_all(segment, &self.lists, &self.scenery, sums);
            return false;
        }
        part.compute(segment, &self.lists, &self.scenery, sums)
    }

    /// The tiles of each region.
    fn ranges(&self) -> Vec<Range<usize>> {
        let tiles = self.lists.lowest.len();
        let threads = if tiles * self.lists.tile < FEW { 1 } else { rayon::current_num_threads() };
        let count = if threads > 1 { threads * REGIONS } else { 1 };
        (0..count).map(|r| tiles * r / count..tiles * (r + 1) / count).filter(|r| !r.is_empty()).collect()
    }

    /// Loads of all tiles of a region, and the rest for those that no earlier region touches.
    fn region(&self, region: Region, images: Computed) -> Found {
        let Region { tiles, mut part, columns: mut rest } = region;
        let (mut found, from) = (Found::default(), self.lists.tiles[tiles.start]);
        for tile in tiles.clone() {
            let (mut columns, others) = rest.split((tile + 1) * self.lists.tile);
            rest = others;
            columns.sums.clear();
            for segment in self.lists.tiles[tile]..self.lists.tiles[tile + 1] {
                found.deep |= self.compute(&mut part, segment - from, &mut columns.sums);
            }
            if !self.waits(tile, tiles.start) {
                let (first, own) = part.kept();
                found = found.and(self.finish(columns, &Kept { images, own, first }));
            }
        }
        found
    }

    /// Of one tile, whose own contacts are computed: adds what arrives from elsewhere, and moves.
    fn finish(&self, mut columns: Columns, kept: &Kept) -> Found {
        if self.pass != Pass::Move {
            let tile = columns.first / self.lists.tile;
            let arriving = self.lists.arriving[tile] as usize..self.lists.arriving[tile + 1] as usize;
            columns.sums.collect(&self.lists.arrivals[arriving], kept);
        }
        if matches!(self.pass, Pass::Loads | Pass::Recall) {
            return Found::default();
        }
        Found { moved: advance_awake(self.width, columns, &self.drive, &self.lists), deep: false }
    }

    /// Whether a tile has contacts with tiles before `first`.
    fn waits(&self, tile: usize, first: usize) -> bool {
        (self.lists.lowest[tile] as usize) < first
    }

    /// Columns of the tiles that have not moved in their regions.
    fn late<'a>(&self, ranges: &[Range<usize>], mut rest: Columns<'a>) -> Vec<Columns<'a>> {
        let mut late = Vec::new();
        for range in ranges {
            for tile in range.clone() {
                let (columns, others) = rest.split((tile + 1) * self.lists.tile);
                rest = others;
                if self.pass == Pass::Move || self.waits(tile, range.start) {
                    late.push(columns);
                }
            }
        }
        late
    }
}

fn divide<'a>(
    ranges: &[Range<usize>],
    (segments, tile): (&[usize], usize),
    mut part: Part<'a>,
    mut columns: Columns<'a>,
) -> Vec<Region<'a>> {
    let mut regions = Vec::with_capacity(ranges.len());
    for tiles in ranges {
        let (first, others) = part.split(segments[tiles.end] - segments[tiles.start]);
        let (mine, rest) = columns.split(tiles.end * tile);
        (part, columns) = (others, rest);
        regions.push(Region { tiles: tiles.clone(), part: first, columns: mine });
    }
    regions
}

/// Does all of something, on all threads where there are several.
fn all<T: Send>(items: Vec<T>, found: Found, run: impl Fn(T) -> Found + Sync + Send) -> Found {
    if items.len() < 2 {
        return items.into_iter().map(run).fold(found, Found::and);
    }
    found.and(items.into_par_iter().map(run).reduce(Found::default, Found::and))
}
