//! One pass over the tiles. [`forces_of_tile`] computes the contacts of a tile, which read all particles; [`SecondHalf::tile`] adds what arrives
//! from other tiles and moves the particles. Two schedules call these two functions: several threads do the first for all tiles, then the
//! second for all tiles; one thread alone does both for one tile after the other. No result depends on the schedule.
//!
//! A tile's contacts are with its own particles and with those of later tiles. So one thread can take both halves of a tile at once: each
//! tile that reads its particles comes before it, and what it computes is in the cache when it moves.

use crate::forces::tile::{ContactInputs, TileInputs};
use crate::kernel::StepInputs;
use crate::kernel::sums::{Sums, WrenchSlices};
use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::neighbours::poses::pose_in_box;
use crate::neighbours::resting::RestingTile;
use crate::neighbours::slices::{Lists, TileSlice};
use crate::passes::bonds::pull::add_bond_forces;
use crate::passes::integrate::{MoveFlags, MoveInputs, ParticleSlices};
use crate::passes::sleep::advance_awake;
use crate::simd::{Row, Row4, Width};
use crate::state::bonds::Bonds;
use crate::state::particles::Particles;
use crate::state::sleepers::Sleepers;
use crate::state::{Forces, State};
use crate::threads::{FEW, share};
use crate::walls::motion::Pose;
use std::ops::Range;

/// What a pass found.
#[derive(Clone, Default)]
pub struct StepFlags {
    /// Segments in which an overlap passes its limit.
    pub deep: Vec<Range<usize>>,
    /// Of the particles that moved.
    pub moved: MoveFlags,
}

/// Forces of this instant; the wrench of each contact is kept for observers.
pub fn forces(model: &Model, state: &mut State, lists: &mut NeighbourLists) -> StepFlags {
    let deep = compute(model, state, lists, true);
    add_bond_forces(model, state);
    let moved = finish(model, state, lists, Ends { collects: true, moves: false });
    StepFlags { deep, moved }
}

/// Forces of this instant, unless they are known, and the move.
pub fn forces_and_move(model: &Model, state: &mut State, lists: &mut NeighbourLists) -> StepFlags {
    if state.forces == Forces::Known {
        let moved = finish(model, state, lists, Ends { collects: false, moves: true });
        return StepFlags { deep: Vec::new(), moved };
    }
    if is_sequential(state) {
        return step_tile_by_tile(model, state, lists);
    }
    let deep = compute(model, state, lists, false);
    add_bond_forces(model, state);
    let moved = finish(model, state, lists, Ends { collects: true, moves: true });
    StepFlags { deep, moved }
}

/// Sums of wrenches that were computed before.
pub fn recall(model: &Model, state: &mut State, lists: &mut NeighbourLists) {
    sum_kept_wrenches(model, state, lists);
    finish(model, state, lists, Ends { collects: true, moves: false });
}

/// What the second half does with a tile.
#[derive(Clone, Copy)]
struct Ends {
    /// Adds what arrives from other tiles.
    collects: bool,
    /// Moves its particles.
    moves: bool,
}

/// Loads of all contacts, and their sums within tiles; the segments in which an overlap passes its limit. `looks`: the load of each contact
/// is kept.
fn compute(model: &Model, state: &State, lists: &mut NeighbourLists, looks: bool) -> Vec<Range<usize>> {
    lists.contacts.keep_wrenches(looks && lists.records || state.keeps_wrenches());
    for_each_tile(model, state, lists, |part, still, seen, sums| match still {
        Some(still) => still.compute(part, seen, sums),
        None => forces_of_tile(part, 0..part.segments.len(), seen, sums),
    })
}

/// Forces of some segments of a tile, and their sums; true when an overlap passes its limit.
fn forces_of_tile(part: &mut TileSlice, segments: Range<usize>, seen: TileInputs, sums: &mut Sums) -> bool {
    sums.clear();
    segments.into_iter().fold(false, |any, k| any | part.compute(k, seen, sums))
}

/// The second half of a pass, with what it needs of the scene.
struct SecondHalf<'a> {
    width: Width,
    drive: MoveInputs,
    bonds: &'a Bonds,
    lists: &'a Lists<'a>,
    ends: Ends,
}

impl SecondHalf<'_> {
    /// Adds what arrives at a tile from others, and moves its particles.
    fn tile(
        &self,
        tile: usize,
        mut particles: ParticleSlices,
        kept: WrenchSlices,
        resting: Option<&RestingTile>,
    ) -> MoveFlags {
        if self.ends.collects {
            particles.sums.collect(self.lists.arriving(tile), kept);
            self.bonds.add(&mut particles.sums);
        }
        if self.ends.moves {
            advance_awake(self.width, particles, &self.drive, self.lists, resting)
        } else {
            MoveFlags::default()
        }
    }
}

/// Sums within tiles of loads that were computed before.
fn sum_kept_wrenches(model: &Model, state: &State, lists: &mut NeighbourLists) {
    for_each_tile(model, state, lists, |part, still, seen, sums| {
        match still {
            Some(still) => still.recall(part, seen, sums),
            None => {
                sums.clear();
                part.segments.iter().for_each(|s| part.recall(s, s.places.clone(), seen, sums));
            }
        }
        false
    });
}

/// Does something with each segment of images, and with each tile, what rests there, and its sums; the segments of those that say so.
fn for_each_tile(
    model: &Model,
    state: &State,
    lists: &mut NeighbourLists,
    each: impl Fn(&mut TileSlice, Option<&mut RestingTile>, TileInputs, &mut Sums) -> bool + Sync,
) -> Vec<Range<usize>> {
    let poses = poses(model, state, lists);
    let contacts = &mut lists.contacts;
    let (period, form, many) = (model.period(), contacts.form, state.particles.len() >= FEW);
    let Particles { rows, spins, .. } = &state.particles;
    let spins = if state.particles.rotates() { &spins[..] } else { &[] };
    let common = StepInputs { dt: model.dt, overlap_limit: model.setup.guards.overlap, rows, spins, form };
    let known = state.sleepers.as_ref().map(Sleepers::known);
    let (kinds, walls, width) = (&model.kinds, &model.walls, model.width);
    let inputs = ContactInputs { kinds, walls, poses: &poses, period, width, common, known };
    let (lists, part, mut sums, resting_tiles) = contacts.parts();
    let (mut images, mut rest) = part.split(lists.tiles[0]);
    let mut items = Vec::with_capacity(images.segments.len() + lists.tiles.len());
    while !images.segments.is_empty() {
        let (one, others) = images.split(1);
        images = others;
        items.push((one, None, Sums::default()));
    }
    let mut resting_tiles = resting_tiles.iter_mut();
    for segments in lists.tiles.windows(2) {
        let (one, others) = rest.split(segments[1] - segments[0]);
        let (mine, next) = sums.split(lists.tile);
        (rest, sums) = (others, next);
        items.push((one, resting_tiles.next(), mine));
    }
    let run = |(mut part, still, mut sums)| each(&mut part, still, (&lists, &inputs), &mut sums);
    let said = share(many, items, run);
    let tiles = lists.tiles.windows(2).map(|s| s[0]..s[1]);
    let segments = (0..lists.tiles[0]).map(|image| image..image + 1).chain(tiles);
    segments.zip(said).filter(|(_, said)| *said).map(|(segments, _)| segments).collect()
}

/// Whether tiles are stepped one after the other: one thread, and nothing that is to be done between the halves.
fn is_sequential(state: &State) -> bool {
    let alone = state.particles.len() < FEW || rayon::current_num_threads() == 1;
    alone && state.bonds.none() && state.sleepers.is_none()
}

/// Both halves of each tile at once.
fn step_tile_by_tile(model: &Model, state: &mut State, lists: &mut NeighbourLists) -> StepFlags {
    let form = lists.contacts.form;
    lists.contacts.keep_wrenches(state.keeps_wrenches());
    keep_rows(model, state, lists);
    let (poses, period, drive) = (poses(model, state, lists), model.period(), drive(model));
    let contacts = &mut lists.contacts;
    let Particles { rows, spins, acceleration, turning, home, .. } = &mut state.particles;
    let (kinds, walls, width) = (&model.kinds, &model.walls, model.width);
    let (lists, mut part, mut sums, _) = contacts.parts();
    let mut found = StepFlags::default();
    let ends = Ends { collects: true, moves: true };
    let second = SecondHalf { width, drive, bonds: &state.bonds, lists: &lists, ends };
    let forces =
        |segments: Range<usize>, rows: &[Row], spins: &[Row4], part: &mut TileSlice, sums: &mut Sums| {
            let common =
                StepInputs { dt: model.dt, overlap_limit: model.setup.guards.overlap, rows, spins, form };
            let inputs = ContactInputs { kinds, walls, poses: &poses, period, width, common, known: None };
            forces_of_tile(part, segments.clone(), (&lists, &inputs), sums).then_some(segments)
        };
    found.deep.extend(forces(0..lists.tiles[0], rows, spins, &mut part, &mut Sums::default()));
    for (tile, segments) in lists.tiles.windows(2).enumerate() {
        let (mut mine, others) = sums.split(lists.tile);
        sums = others;
        found.deep.extend(forces(segments[0]..segments[1], rows, spins, &mut part, &mut mine));
        let (first, count) = (mine.first, mine.len());
        let (all, turn) = (first..first + count, if spins.is_empty() { 0..0 } else { first..first + count });
        let particles = ParticleSlices {
            first,
            rows: &mut rows[all.clone()],
            spins: &mut spins[turn.clone()],
            acceleration: &mut acceleration[all.clone()],
            turning: &mut turning[turn],
            home: &home[all],
            sums: mine,
            sleeper_slices: None,
        };
        found.moved = found.moved.and(second.tile(tile, particles, part.kept(), None));
    }
    contacts.new = false;
    found
}

/// Notes where particles are before they move; a fluid asks for that.
fn keep_rows(model: &Model, state: &State, lists: &mut NeighbourLists) {
    if model.setup.drag.is_some() {
        lists.before.clone_from(&state.particles.rows);
    }
}

fn drive(model: &Model) -> MoveInputs {
    let g = model.setup.gravity;
    MoveInputs { dt: model.dt, gravity: [g.x, g.y, g.z], motion_limit: model.setup.guards.motion }
}

/// Second half: adds what arrives at each tile from others, and moves its particles, where that is to be done.
fn finish(model: &Model, state: &mut State, lists: &mut NeighbourLists, ends: Ends) -> MoveFlags {
    if ends.moves {
        keep_rows(model, state, lists);
    }
    let drive = drive(model);
    let Particles { rows, acceleration, spins, turning, home, .. } = &mut state.particles;
    let (count, many) = (acceleration.len(), acceleration.len() >= FEW);
    let contacts = &mut lists.contacts;
    let (lists, part, sums, resting_tiles) = contacts.parts();
    let (rows, rotating) = (&mut rows[..count], if spins.is_empty() { 0 } else { count });
    let spins = &mut spins[..rotating];
    let sleeper_slices = state.sleepers.as_mut().map(|s| s.sleeper_slices(state.zones.busy()));
    let mut columns =
        ParticleSlices { first: 0, rows, spins, acceleration, turning, home, sums, sleeper_slices };
    let mut items = Vec::with_capacity(lists.tiles.len());
    for tile in 0..lists.tiles.len() - 1 {
        let (mine, others) = columns.split((tile + 1) * lists.tile);
        columns = others;
        items.push((tile, mine));
    }
    let second = SecondHalf { width: model.width, drive, bonds: &state.bonds, lists: &lists, ends };
    let run = |(tile, particles)| second.tile(tile, particles, part.kept(), resting_tiles.get(tile));
    let moved = share(many, items, run);
    if ends.moves {
        // Until now: sleepers are looked at after each listing.
        contacts.new = false;
    }
    moved.into_iter().fold(MoveFlags::default(), MoveFlags::and)
}

/// Where walls are now.
fn poses(model: &Model, state: &State, lists: &NeighbourLists) -> Vec<Pose> {
    let time = state.time();
    (0..model.walls.len()).map(|w| pose_in_box(model, state, lists, w, time)).collect()
}

/// Contact points of images and walls, without loads.
pub fn find_contact_points(model: &Model, state: &State, lists: &mut NeighbourLists) {
    for_each_tile(model, state, lists, |part, _, (lists, inputs), _| {
        part.segments.iter().for_each(|s| part.refresh(s, lists, inputs));
        false
    });
}
