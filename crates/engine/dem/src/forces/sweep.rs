//! One pass over the tiles. [`forces_of_tile`] computes the contacts of a tile, which read all particles; [`SecondHalf::tile`] adds what arrives
//! from other tiles and moves the particles. Two schedules call these two functions: several threads do the first for all tiles, then the
//! second for all tiles; one thread alone does both, tile after tile. No result depends on the schedule.
//!
//! A tile's contacts are with its own particles and with those of later tiles. So one thread can take both halves of a tile at once: each
//! tile that reads its particles comes before it, and what it computes is in the cache when it moves.

use crate::forces::clump_patches;
use crate::forces::tile::TileInputs;
use crate::model::Model;
use crate::neighbours::poses::pose_in_box;
use crate::neighbours::{Computed, NeighbourLists, RestingTile, Slots, TileSlice};
use crate::passes::integrate::ParticleSlices;
use crate::passes::sleep::advance_awake;
use crate::passes::waking::{Movers, Stirred};
use crate::state::{Bonds, Forces, Particles, Sleepers, State, WrenchColumns};
use crate::threads::{FEW, share};
use geom::motion::Pose;
use laws::contact::{MoveFlags, StepInputs, Sums, WrenchSlices};
use laws::simd::Layout;
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
    find_clump_patches(model, state, lists);
    let deep = compute(model, state, lists, true);
    let moved = finish(model, state, lists, Second::ARRIVALS);
    StepFlags { deep, moved }
}

/// Forces of this instant, unless they are known, and the move.
pub fn forces_and_move(model: &Model, state: &mut State, lists: &mut NeighbourLists) -> StepFlags {
    if state.forces == Forces::Known {
        let moved = finish(model, state, lists, Second::MOVE);
        return StepFlags { deep: Vec::new(), moved };
    }
    find_clump_patches(model, state, lists);
    if is_sequential(state) {
        return step_tile_by_tile(model, state, lists);
    }
    let deep = compute(model, state, lists, false);
    let moved = finish(model, state, lists, Second::BOTH);
    StepFlags { deep, moved }
}

/// Sums of wrenches that were computed before.
pub fn sum_kept(model: &Model, state: &mut State, lists: &mut NeighbourLists) {
    for_each_tile(model, state, lists, |slice, resting, inputs, sums| {
        match resting {
            Some(resting) => resting.add_kept(slice, inputs, sums),
            None => {
                sums.clear();
                slice.segments.iter().for_each(|s| slice.add_kept(s, s.slots.clone(), inputs, sums));
            }
        }
        false
    });
    finish(model, state, lists, Second::ARRIVALS);
}

/// Contact points of images and walls, without forces.
pub fn find_contact_points(model: &Model, state: &mut State, lists: &mut NeighbourLists) {
    lists.step.pointed = false;
    for_each_tile(model, state, lists, |slice, _, inputs, _| {
        slice.segments.iter().for_each(|s| slice.find_contact_points(s, inputs));
        false
    });
}

/// Contact points and patches of this instant, where there are clumps: what a contact of a clump moves depends on contacts in other tiles.
fn find_clump_patches(model: &Model, state: &mut State, lists: &mut NeighbourLists) {
    lists.step.pointed = false;
    if model.setup.patches && !state.clumps.none() {
        find_contact_points(model, state, lists);
        clump_patches::find(model, state, lists);
        lists.step.pointed = true;
    }
}

/// Forces of all contacts, and their sums within tiles; the segments in which an overlap passes its limit. `observed`: the wrench of each
/// contact is kept where the setup asks for records.
fn compute(
    model: &Model,
    state: &mut State,
    lists: &mut NeighbourLists,
    observed: bool,
) -> Vec<Range<usize>> {
    let recorded = model.setup.record_wrenches || !state.wall_sums.none();
    keep_wrenches(model, state, lists, observed && recorded || state.keeps_wrenches());
    for_each_tile(model, state, lists, |slice, resting, inputs, sums| match resting {
        Some(resting) => resting.compute(slice, inputs, sums),
        None => forces_of_tile(slice, 0..slice.segments.len(), inputs, sums),
    })
}

/// Forces of some segments of a tile, and their sums; true when an overlap passes its limit.
fn forces_of_tile(
    slice: &mut TileSlice,
    segments: Range<usize>,
    inputs: &TileInputs,
    sums: &mut Sums,
) -> bool {
    sums.clear();
    segments.into_iter().fold(false, |any, k| any | slice.compute(k, inputs, sums))
}

/// What the second half does with a tile.
#[derive(Clone, Copy)]
struct Second {
    /// Adds what arrives from other tiles.
    adds_arrivals: bool,
    /// Moves its particles.
    moves: bool,
}

impl Second {
    const ARRIVALS: Second = Second { adds_arrivals: true, moves: false };
    const MOVE: Second = Second { adds_arrivals: false, moves: true };
    const BOTH: Second = Second { adds_arrivals: true, moves: true };
}

/// The second half of a pass, with what it needs of the scene.
struct SecondHalf<'a> {
    model: &'a Model,
    bonds: &'a Bonds,
    lists: &'a Slots,
    does: Second,
    /// Where particles sleep.
    stirred: Option<Stirred<'a>>,
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
        if self.does.adds_arrivals {
            particles.sums.accumulate_arrivals(self.lists.arriving(tile), kept);
            self.bonds.add(&mut particles.sums);
        }
        if self.does.moves {
            advance_awake(self.model, particles, resting, self.stirred)
        } else {
            MoveFlags::default()
        }
    }
}

/// Calls `each` with each segment of images, and with each tile, what rests there, and its sums; the segments for which it returns true.
fn for_each_tile(
    model: &Model,
    state: &mut State,
    lists: &mut NeighbourLists,
    each: impl Fn(&mut TileSlice, Option<&mut RestingTile>, &TileInputs, &mut Sums) -> bool + Sync,
) -> Vec<Range<usize>> {
    let (poses, cell) = (poses(model, state, lists), state.cell(model));
    let State { particles, sleepers, contacts, .. } = state;
    let (layout, many, pointed) = (contacts.layout, particles.len() >= FEW, lists.step.pointed);
    let Computed { slots, mut slice, mut sums, resting_tiles } = lists.with(contacts);
    let inputs = TileInputs {
        lists: slots,
        model,
        poses: &poses,
        cell,
        lengths: cell.lengths(),
        step: step_inputs(model, particles, layout),
        pointed,
        sleepers: sleepers.as_ref().map(Sleepers::map),
    };
    let mut images = slice.split_off(slots.tiles[0]);
    let mut items = Vec::with_capacity(images.segments.len() + slots.tiles.len());
    while !images.segments.is_empty() {
        items.push((images.split_off(1), None, Sums::default()));
    }
    let mut resting_tiles = resting_tiles.iter_mut();
    for segments in slots.tiles.windows(2) {
        let tile = slice.split_off(segments[1] - segments[0]);
        items.push((tile, resting_tiles.next(), sums.split_off(slots.tile)));
    }
    let run = |(mut slice, resting, mut sums)| each(&mut slice, resting, &inputs, &mut sums);
    let found = share(many, items, run);
    let tiles = slots.tiles.windows(2).map(|s| s[0]..s[1]);
    let segments = (0..slots.tiles[0]).map(|image| image..image + 1).chain(tiles);
    segments.zip(found).filter(|(_, found)| *found).map(|(segments, _)| segments).collect()
}

/// Whether tiles are stepped one after the other: one thread, and nothing that is to be done between the halves.
fn is_sequential(state: &State) -> bool {
    let alone = state.particles.len() < FEW || rayon::current_num_threads() == 1;
    alone && state.bonds.none() && state.sleepers.is_none()
}

/// Both halves of each tile at once.
fn step_tile_by_tile(model: &Model, state: &mut State, lists: &mut NeighbourLists) -> StepFlags {
    keep_wrenches(model, state, lists, state.keeps_wrenches());
    keep_rows(model, state, lists);
    let (poses, cell) = (poses(model, state, lists), state.cell(model));
    let lengths = cell.lengths();
    let State { particles, bonds, contacts, .. } = state;
    let (layout, pointed) = (contacts.layout, lists.step.pointed);
    let Computed { slots: shared, mut slice, mut sums, .. } = lists.with(contacts);
    let mut found = StepFlags::default();
    let second = SecondHalf { model, bonds, lists: shared, does: Second::BOTH, stirred: None };
    let forces = |segments: Range<usize>, particles: &Particles, slice: &mut TileSlice, sums: &mut Sums| {
        let step = step_inputs(model, particles, layout);
        let inputs =
            TileInputs { lists: shared, model, poses: &poses, cell, lengths, step, pointed, sleepers: None };
        forces_of_tile(slice, segments.clone(), &inputs, sums).then_some(segments)
    };
    found.deep.extend(forces(0..shared.tiles[0], particles, &mut slice, &mut Sums::default()));
    for (tile, segments) in shared.tiles.windows(2).enumerate() {
        let mut own = sums.split_off(shared.tile);
        found.deep.extend(forces(segments[0]..segments[1], particles, &mut slice, &mut own));
        let range = own.first..own.first + own.particles();
        let particles = ParticleSlices::of(particles, range, own);
        found.moved = found.moved.and(second.tile(tile, particles, slice.kept.as_ref(), None));
    }
    lists.slots.new = false;
    found
}

/// What all contacts of a step share.
fn step_inputs<'a>(model: &Model, particles: &'a Particles, layout: Layout) -> StepInputs<'a> {
    let Particles { rows, spins, .. } = particles;
    let (dt, ahead) = (model.dt, model.ahead());
    StepInputs { dt, ahead, overlap_limit: model.setup.guards.overlap, rows, spins, layout }
}

/// Whether the wrenches of all contacts are kept from now on; where walls have sums, at least those with walls are. As all, they begin at 0.
fn keep_wrenches(model: &Model, state: &mut State, lists: &mut NeighbourLists, all: bool) {
    state.contacts.keep_wrenches(all, lists.slots.i.len());
    if state.wall_sums.none() {
        return;
    }
    let walls = &mut lists.step.wall_wrenches;
    if all {
        *walls = WrenchColumns::default();
    } else if walls.forces.is_empty() {
        *walls = WrenchColumns::zeros(model.layout(), lists.slots.rows(), state.torques(model));
    }
}

/// Notes how particles move before they do; a fluid and local damping ask for that, of spheres that move on their own.
fn keep_rows(model: &Model, state: &State, lists: &mut NeighbourLists) {
    if state.clumps.carry_all(state.particles.len()) {
        return;
    }
    if model.setup.drag.is_some() || model.setup.local_damping.is_some() {
        lists.before.clone_from(&state.particles.rows);
    }
    if model.setup.local_damping.is_some() {
        lists.spins_before.clone_from(&state.particles.spins);
    }
}

/// Second half: adds what arrives at each tile from others, and moves its particles, where that is to be done.
fn finish(model: &Model, state: &mut State, lists: &mut NeighbourLists, does: Second) -> MoveFlags {
    if does.moves {
        keep_rows(model, state, lists);
    }
    let time = state.time();
    let State { particles, bonds, sleepers, zones, contacts, .. } = state;
    let asleep = sleepers.as_ref().filter(|_| does.moves);
    let movers = asleep.map(|s| Movers::new(model, particles, s, time));
    let (count, many) = (particles.len(), particles.len() >= FEW);
    let Computed { slots: shared, slice, sums, resting_tiles } = lists.with(contacts);
    let sleeper_slices = sleepers.as_mut().map(|s| s.sleeper_slices(&zones.prescribed));
    let mut columns = ParticleSlices { sleeper_slices, ..ParticleSlices::of(particles, 0..count, sums) };
    let items = (0..shared.tiles.len() - 1).map(|tile| (tile, columns.split_off(shared.tile))).collect();
    let (wrenches, layout) = (slice.each.as_ref(), slice.layout);
    let stirred = movers.as_ref().map(|movers| Stirred { movers, lists: shared, wrenches, layout });
    let second = SecondHalf { model, bonds, lists: shared, does, stirred };
    let run = |(tile, particles)| second.tile(tile, particles, slice.kept.as_ref(), resting_tiles.get(tile));
    let moved = share(many, items, run);
    if does.moves {
        // Until here: all sleepers are checked after each rebuild.
        lists.slots.new = false;
    }
    moved.into_iter().fold(MoveFlags::default(), MoveFlags::and)
}

/// Where walls are now.
fn poses(model: &Model, state: &State, lists: &NeighbourLists) -> Vec<Pose> {
    let time = state.time();
    (0..model.walls.len()).map(|w| pose_in_box(model, state, lists, w, time)).collect()
}
