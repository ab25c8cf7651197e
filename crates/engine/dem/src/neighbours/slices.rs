//! What is computed of listed contacts in a step, and slices of it by tile.

use crate::model::With;
use crate::neighbours::{NeighbourLists, Segment, Slots};
use crate::state::{ContactColumns, Particles, WrenchColumns};
use geom::Vec3;
use laws::contact::wrenches::split_off;
use laws::contact::{LEDGER, Sums, WrenchSlicesMut};
use laws::simd::{BLOCK, Layout, Row, Row4};
use laws::space::sphere::FAR;
use std::ops::Range;

/// Columns of the listed contacts that are computed in each step, and no others are saved.
#[derive(Default)]
pub struct StepColumns {
    /// Contact points of images and walls, as rows and spins of partners.
    pub rows: Vec<Row>,
    pub spins: Vec<Row4>,
    /// Patches that contacts belong to, [`laws::contact::patch::PATCH`] numbers each by block and column.
    pub patch: Vec<f64>,
    /// Whether contact points and patches are those of this instant.
    pub pointed: bool,
    /// Whether the wrenches or the history of a block are not all zero.
    pub active: Vec<bool>,
    /// Wrenches that are kept for other tiles.
    pub kept: WrenchColumns,
    /// Wrenches of contacts with walls, by row of their contact points, where walls have sums and not all wrenches are kept.
    pub wall_wrenches: WrenchColumns,
    /// What rests in each tile; only where particles sleep.
    pub resting_tiles: Vec<RestingTile>,
}

impl StepColumns {
    /// Columns of these contacts, with or without spins, but for the wrenches that are kept.
    pub fn new(slots: &Slots, rotates: bool) -> StepColumns {
        let rows = slots.rows();
        StepColumns {
            rows: vec![FAR[1]; rows],
            spins: vec![Row4::default(); if rotates { rows } else { 0 }],
            patch: vec![1.0; slots.patches()],
            active: vec![true; slots.i.len() / BLOCK],
            ..StepColumns::default()
        }
    }
}

/// What of a tile rests ([`crate::forces::resting`] finds it).
#[derive(Debug, Default)]
pub struct RestingTile {
    /// The tile itself, and those that it has contacts with.
    pub near: Vec<u32>,
    /// Steps that had been ended when it was found.
    pub found: Option<u64>,
    /// Whether it was found before this step: what rests is what rested a step before.
    pub unchanged: bool,
    /// Runs of slots whose contacts do not rest.
    pub active: Vec<SlotRun>,
    /// Sums of the wrenches of the others; none where there are no others.
    pub sums: WrenchColumns,
    /// Particles of the tile that are awake, counted from its first.
    pub awake: Vec<Range<usize>>,
    /// Sleepers that touch or may touch a particle that is awake, counted likewise.
    pub disturbed: Vec<u32>,
}

/// Slots that follow each other in a segment.
#[derive(Debug, Clone)]
pub struct SlotRun {
    /// The segment, by its number in the tile.
    pub segment: usize,
    /// Whole blocks.
    pub slots: Range<usize>,
}

impl RestingTile {
    /// Nothing yet, of a tile that has contacts with these.
    pub fn beside(near: Vec<u32>) -> RestingTile {
        RestingTile { near, ..RestingTile::default() }
    }
}

/// The lists, and all that is computed with them in a step.
pub struct Computed<'a> {
    /// What every tile reads.
    pub slots: &'a Slots,
    /// All segments, with their rows of what is computed.
    pub slice: TileSlice<'a>,
    /// Sums by particle.
    pub sums: Sums<'a>,
    /// What rests in each tile; empty where nothing sleeps.
    pub resting_tiles: &'a mut [RestingTile],
}

impl NeighbourLists {
    /// What is computed, with the columns that it is computed in.
    pub fn with<'a>(&'a mut self, columns: &'a mut ContactColumns) -> Computed<'a> {
        let ContactColumns { layout, history, ledger, wrenches, keeps, sums, .. } = columns;
        let StepColumns { rows, spins, patch, active, kept, wall_wrenches, resting_tiles, .. } =
            &mut self.step;
        let (layout, slots) = (*layout, &self.slots);
        let slice = TileSlice {
            segments: &slots.segments,
            layout,
            from: SliceStart::default(),
            rows,
            spins,
            patch,
            history,
            active,
            kept: kept.slices_mut(),
            each: if *keeps { wrenches.slices_mut() } else { Default::default() },
            walls: wall_wrenches.slices_mut(),
            ledger,
        };
        Computed { slots, slice, sums: Sums { first: 0, layout, wrenches: sums.slices_mut() }, resting_tiles }
    }

    /// Where the second of a contact is, and its radius (0 on a flat wall) [m]; `position` tells where particles are. Images and walls are where
    /// they were when forces were computed.
    pub fn partner(
        &self,
        particles: &Particles,
        segment: &Segment,
        slot: usize,
        position: impl Fn(usize) -> Vec3,
    ) -> (Vec3, f64) {
        if segment.with == With::Particles {
            let j = self.slots.partner[slot] as usize;
            return (position(j), particles.rows[j].radius());
        }
        let row = self.partner_row(particles, segment, slot);
        (row.position(), row.radius())
    }

    /// The row of the second of a contact: a particle, its image, or the contact point of a wall.
    pub fn partner_row<'a>(&'a self, particles: &'a Particles, segment: &Segment, slot: usize) -> &'a Row {
        match segment.with {
            With::Particles => &particles.rows[self.slots.partner[slot] as usize],
            With::Images | With::Wall(_) => &self.step.rows[segment.rows + segment.rank(slot)],
        }
    }
}

/// Where a slice begins.
#[derive(Debug, Clone, Copy, Default)]
pub struct SliceStart {
    pub slot: usize,
    pub row: usize,
    pub history: usize,
    pub kept: usize,
    pub patch: usize,
}

/// Some segments that follow each other, with their rows of everything that is computed.
#[derive(Default)]
pub struct TileSlice<'a> {
    pub segments: &'a [Segment],
    pub layout: Layout,
    pub from: SliceStart,
    pub rows: &'a mut [Row],
    pub spins: &'a mut [Row4],
    pub patch: &'a mut [f64],
    pub history: &'a mut [f64],
    pub active: &'a mut [bool],
    /// Wrenches that are kept for other tiles.
    pub kept: WrenchSlicesMut<'a>,
    /// Wrench of each contact, or none.
    pub each: WrenchSlicesMut<'a>,
    /// Wrench of each contact with a wall, by row of its contact point, or none.
    pub walls: WrenchSlicesMut<'a>,
    pub ledger: &'a mut [f64],
}

impl<'a> TileSlice<'a> {
    /// Takes the first `count` segments off.
    pub fn split_off(&mut self, count: usize) -> TileSlice<'a> {
        let (segments, others) = self.segments.split_at(count);
        let Some(next) = others.first() else { return std::mem::take(self) };
        let (from, layout) = (self.from, self.layout);
        let to = SliceStart {
            slot: next.slots.start,
            row: next.rows,
            history: next.history,
            kept: next.kept,
            patch: next.patch,
        };
        (self.segments, self.from) = (others, to);
        let (slots, rows) = (to.slot - from.slot, to.row - from.row);
        TileSlice {
            segments,
            layout,
            from,
            rows: split_off(&mut self.rows, rows),
            spins: split_off(&mut self.spins, rows),
            patch: split_off(&mut self.patch, to.patch - from.patch),
            history: split_off(&mut self.history, to.history - from.history),
            active: split_off(&mut self.active, slots / BLOCK),
            kept: self.kept.split_off(to.kept - from.kept, layout),
            each: self.each.split_off(slots, layout),
            walls: self.walls.split_off(rows, layout),
            ledger: split_off(&mut self.ledger, slots * LEDGER),
        }
    }
}
