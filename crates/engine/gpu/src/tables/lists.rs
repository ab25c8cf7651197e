//! Tables that lists are made with.

use super::columns::{Address, ContactTables, ParticleTables};
use laws::space::cell::Cell;
use laws::space::images::WallImages;
use laws::space::margins::MarginInputs;
use primitives::Pose;
use primitives::{Lattice, Vec3};

/// Particles of which one thread finds the box, or rows of boxes that it folds.
pub const PART: usize = 16;
/// Keys that one thread sorts.
pub const CHUNK: usize = 64;
/// Numbers that one thread sums.
pub const SUMMED: usize = 32;
/// Intervals that reaches are counted in.
pub const INTERVALS: usize = 4096;
/// Bits of a key that particles are sorted by at once.
pub const DIGIT: u32 = 8;
/// How many numbers they make.
pub const DIGITS: usize = 1 << DIGIT;

/// Extent of some particles, and of their reaches: the least of each number [m].
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct LeastRow {
    /// Lowest coordinates.
    pub low: [f64; 3],
    /// Highest coordinates, with the opposite sign.
    pub opposite_high: [f64; 3],
    /// Least reach.
    pub reach: f64,
    /// Largest reach, with the opposite sign.
    pub opposite_reach: f64,
}

/// A wall as it is listed.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct DeviceWall {
    /// Where it is.
    pub pose: Pose,
    /// Where its images are met.
    pub around: WallImages,
    /// How far it may move until lists are rebuilt [m].
    pub margin: f64,
    /// Largest radius of its spheres [m].
    pub largest: f64,
    /// Cells that its spheres are sorted by.
    pub lattice: Lattice,
    /// Centre and radius of each, as at t = 0 [m].
    pub spheres: Address,
    /// Key of the cell of each.
    pub keys: Address,
    /// How many parts it has.
    pub parts: u32,
    /// Nothing.
    pub pad: u32,
    /// By how many periods less it is counted back than when lists were made before.
    pub back: [i32; 4],
}

/// Contacts of one kind in one tile.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct DeviceSegment {
    /// First block.
    pub block: u32,
    /// Kind of contact.
    pub kind: u32,
    /// First word of its history.
    pub history: u32,
    /// Words of history of a block.
    pub words: u32,
    /// First of its points.
    pub point: u32,
}

/// What the making of lists reads and writes.
#[derive(Debug, Clone, Copy, Default)]
#[repr(C)]
pub struct ListTables {
    /// Cells that particles are sorted by, along `axes`.
    pub lattice: Lattice,
    /// Which coordinate is the first, second, third.
    pub axes: [u32; 4],
    /// Lowest and highest coordinate of any particle along `axes` [m].
    pub bounds: [[f64; 3]; 2],
    /// Margins.
    pub margins: MarginInputs,
    /// Lowest and highest coordinate of the box along x, y, z [m]; equal along open axes.
    pub periodic: [[f64; 3]; 2],
    /// 1 where anything is periodic.
    pub wraps_any: u32,
    /// Number of materials.
    pub materials: u32,
    /// Number of kinds.
    pub kind_count: u32,
    /// Number of images that pairs are sought with.
    pub images: u32,
    /// Columns of the particles in their new order.
    pub next: ParticleTables,
    /// By how many periods each particle was moved, by its old position.
    pub wraps: Address,
    /// [`laws::simd::Row4`] of each particle: its home along `axes`, and its reach.
    pub spots: Address,
    /// Key of the cell of each particle, 8 bytes.
    pub keys: Address,
    /// Where each of them was before it was sorted.
    pub order: Address,
    /// Keys, sorted by one digit more.
    pub next_keys: Address,
    /// Where they were.
    pub next_order: Address,
    /// First particle of each cell, and one more; 0 where most cells are empty.
    pub cell_starts: Address,
    /// Counters of digits, by digit and chunk.
    pub counters: Address,
    /// [`LeastRow`]s.
    pub boxes: Address,
    /// What they are folded to.
    pub next_boxes: Address,
    /// How many there are.
    pub box_count: u32,
    /// Which interval of reaches is asked for.
    pub interval: u32,
    /// Least reach [m].
    pub least_reach: f64,
    /// Intervals per metre.
    pub per_metre: f64,
    /// Number of reaches in each interval, and how many were found.
    pub reach_counts: Address,
    /// Reaches that were found.
    pub reaches: Address,
    /// What is summed.
    pub summed: Address,
    /// Sums of each part of it.
    pub sums: Address,
    /// How many numbers.
    pub summed_count: u32,
    /// Kinds of contact with images: each is a class.
    pub image_classes: u32,
    /// Classes of a tile.
    pub classes: u32,
    /// Number of tiles.
    pub tile_count: u32,
    /// Where the contacts of each particle of each class begin; 0 before the first.
    pub class_cursors: Address,
    /// The same of whole classes, of all images and all tiles, and the end.
    pub class_starts: Address,
    /// What is to be added to have slots, modulo 2³².
    pub class_slots: Address,
    /// Kind of contact of two materials.
    pub pair_kinds: Address,
    /// The same with an image.
    pub image_kinds: Address,
    /// [`laws::simd::Row4`] of each image: its shift [m].
    pub shifts: Address,
    /// Which of them the contact in each slot of images is with, a byte.
    pub image: Address,
    /// [`DeviceWall`] of each wall.
    pub walls: Address,
    /// [`DeviceSegment`] of each segment.
    pub segments: Address,
    /// How many there are.
    pub segment_count: u32,
    /// How many numbers cells may have, where their first particles are noted.
    pub cells: u32,
    /// Contacts as they were.
    pub old: ContactTables,
}

impl ListTables {
    /// The periodic box.
    #[inline(always)]
    pub fn cell(&self) -> Cell {
        let [low, high] = self.periodic;
        Cell::at_rest([0, 1, 2].map(|a| (low[a] < high[a]).then_some((low[a], high[a]))))
    }

    /// A position along `axes`.
    #[inline(always)]
    pub fn along(&self, p: &Vec3) -> Vec3 {
        // Chosen, not indexed: what is indexed by a number lies in memory.
        let of = |axis: u32| {
            if axis == 0 {
                p.x
            } else if axis == 1 {
                p.y
            } else {
                p.z
            }
        };
        let [x, y, z, _] = self.axes;
        Vec3::new(of(x), of(y), of(z))
    }

    /// Which interval a reach is counted in.
    #[inline(always)]
    pub fn interval_of(&self, reach: f64) -> usize {
        (((reach - self.least_reach) * self.per_metre) as usize).min(INTERVALS - 1)
    }

    /// Number of class `class` of images, or of tile `tile`.
    #[inline(always)]
    pub fn class_of(&self, tile: usize, class: u32) -> usize {
        (self.image_classes + tile as u32 * self.classes + class) as usize
    }
}
