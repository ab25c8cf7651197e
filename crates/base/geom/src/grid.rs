//! The cell grid: finds points near a position. It is the only neighbour search with a fixed radius in the project.
//!
//! Points are sorted by cell, x fastest, so that the points of neighbouring cells along x are one
//! contiguous run, and within a cell by their index, so that the order depends on nothing else. If all neighbours should lie
//! close in memory, and not those along x alone ([`Grid::in_blocks`]), cells are sorted by blocks first, and a run ends where its block does.
//! Cells are looked up in a dense table where the box is well filled (a bed of grains) and in a hash
//! table where it is mostly empty (a scanned surface); both give the same order.

mod sort;

pub use sort::sorted;

use crate::{Lattice, Vec3};
use rayon::prelude::*;
use sort::by_cell;
use std::borrow::Cow;
use std::ops::Range;
use std::sync::OnceLock;

/// Most cells along one axis; a wider cloud gets wider cells, which costs time and not correctness.
const CELLS_PER_AXIS: f64 = 2_000_000.0;
/// A dense table may have this many cells for each point.
const DENSE_CELLS_PER_POINT: f64 = 8.0;
/// A longer row of cells is searched by bisection, not cell by cell.
const LONG_ROW: u64 = 32;
const EMPTY: u32 = u32::MAX;

/// Points sorted into cubic cells.
#[derive(Debug, Clone)]
pub struct Grid {
    lattice: Lattice,
    order: Vec<u32>,
    table: Table,
}

#[derive(Debug, Clone)]
enum Table {
    /// First sorted place of each cell, and one more.
    Dense(Vec<u32>),
    /// The cells that hold points: their keys, ascending, the first sorted place of each, and one more. Where a key is
    /// is kept in `slots` (open addressing), made on first use.
    Sparse { keys: Vec<u64>, starts: Vec<u32>, slots: OnceLock<Vec<u32>> },
}

impl Grid {
    /// Sorts `points` [m], all finite and fewer than 2³², into cells at least `cell` [m] wide.
    ///
    /// # Panics
    /// When `cell` is not positive, or a coordinate is not finite.
    pub fn new(points: &[Vec3], cell: f64) -> Grid {
        Grid::sorted(points, cell, None)
    }

    /// The same, sorted by blocks of cells, as cubic as the box allows, that would hold so many points each if they were spread evenly.
    ///
    /// # Panics
    /// As [`Grid::new`].
    pub fn in_blocks(points: &[Vec3], cell: f64, points_of_a_block: usize) -> Grid {
        Grid::sorted(points, cell, Some(points_of_a_block))
    }

    fn sorted(points: &[Vec3], cell: f64, points_of_a_block: Option<usize>) -> Grid {
        assert!(points.len() < u32::MAX as usize, "more than 2^32 points in one grid");
        let lattice = lattice_over(bounds(points), cell, points.len(), points_of_a_block);
        let mut grid = Grid { lattice, order: Vec::new(), table: Table::Dense(Vec::new()) };
        if points.is_empty() {
            return grid;
        }
        let cells = lattice.keys();
        let key = |p: &Vec3| lattice.key(lattice.cell_of(p));
        if cells <= DENSE_CELLS_PER_POINT * points.len() as f64 + 1024.0 {
            let keys: Vec<u64> = points.par_iter().map(key).collect();
            let (order, starts) = by_cell(&keys, cells as usize);
            (grid.order, grid.table) = (order, Table::Dense(starts));
        } else if cells < f64::from(u32::MAX) {
            let keys = points.par_iter().enumerate().map(|(i, p)| key(p) << 32 | i as u64).collect();
            let sorted = sorted(keys, cells as u64);
            grid.fill_sparse(&sorted, |&both| (both >> 32, both as u32));
        } else {
            let mut keys: Vec<(u64, u32)> =
                points.par_iter().enumerate().map(|(i, p)| (key(p), i as u32)).collect();
            keys.par_sort_unstable();
            grid.fill_sparse(&keys, |&both| both);
        }
        grid
    }

    /// From points sorted by key; `split` gives the key and the index.
    fn fill_sparse<T: Sync>(&mut self, sorted: &[T], split: impl Fn(&T) -> (u64, u32) + Sync) {
        let (mut keys, mut starts) = (Vec::new(), Vec::new());
        for (place, key) in (0..).zip(sorted.iter().map(|both| split(both).0)) {
            if keys.last() != Some(&key) {
                keys.push(key);
                starts.push(place);
            }
        }
        starts.push(sorted.len() as u32);
        self.order = sorted.iter().map(|both| split(both).1).collect();
        self.table = Table::Sparse { keys, starts, slots: OnceLock::new() };
    }

    /// The cells that hold points, in sorted order: keys (see [`Lattice::key`]), the first sorted place of each, and one more.
    pub fn filled(&self) -> (Cow<'_, [u64]>, Cow<'_, [u32]>) {
        match &self.table {
            Table::Sparse { keys, starts, .. } => (keys.into(), starts.into()),
            Table::Dense(all) => {
                let holds = |&cell: &usize| all[cell] < all[cell + 1];
                let cells: Vec<usize> = (0..all.len().saturating_sub(1)).filter(holds).collect();
                let starts: Vec<u32> =
                    cells.iter().map(|&c| all[c]).chain([self.order.len() as u32]).collect();
                let keys: Vec<u64> = cells.into_iter().map(|c| c as u64).collect();
                (keys.into(), starts.into())
            }
        }
    }

    /// Point indices in sorted order: by block, by cell (z slowest, x fastest), then by index.
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Its cells.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// Width of a cell [m], at least what was asked for.
    pub fn cell(&self) -> f64 {
        self.lattice.cell
    }

    /// The cell that holds `p`, clamped to the box of the points.
    pub fn cell_of(&self, p: &Vec3) -> [i64; 3] {
        self.lattice.cell_of(p)
    }

    /// Number of cells along x, y, z.
    pub fn dims(&self) -> [i64; 3] {
        self.lattice.dims
    }

    /// Sorted places of the points in the cells `x` of row (`y`, `z`): one contiguous run for each block, perhaps empty.
    pub fn row(&self, x: Range<i64>, y: i64, z: i64) -> impl Iterator<Item = Range<usize>> + use<'_> {
        self.lattice.row(x, y, z).map(|(first, count)| self.run(first, count))
    }

    /// Sorted places of the points in so many cells that follow each other.
    fn run(&self, first: u64, count: u64) -> Range<usize> {
        match &self.table {
            Table::Dense(starts) => {
                starts[first as usize] as usize..starts[(first + count) as usize] as usize
            }
            Table::Sparse { keys, starts, slots } => {
                // The cells of a row that hold points follow each other in the list.
                let from = if count > LONG_ROW {
                    keys.partition_point(|&key| key < first)
                } else {
                    let slots = slots.get_or_init(|| slots_of(keys));
                    match (first..first + count).find_map(|key| find(keys, slots, key)) {
                        Some(from) => from,
                        None => return 0..0,
                    }
                };
                let others = keys[from..].iter().take(count as usize);
                let to = from + others.take_while(|&&key| key < first + count).count();
                starts[from] as usize..starts[to] as usize
            }
        }
    }

    /// Runs of sorted places of all cells that a ball of `radius` [m] around `centre` touches, in sorted order where there are no blocks.
    /// Their points are candidates: the caller compares distances. A ball over more rows of cells than there are points gets one run of all,
    /// so that no search costs more than the points: a grain of 5 m among grains of 5 mm would look into 10⁶ rows.
    pub fn runs_near(&self, centre: Vec3, radius: f64) -> impl Iterator<Item = Range<usize>> + '_ {
        let empty = self.order.is_empty();
        let [lo, hi] = self.lattice.around(&centre, radius);
        let rows_across = [1, 2].map(|a| (hi[a] - lo[a] + 1).max(0) as f64);
        let all = (rows_across[0] * rows_across[1] > self.order.len() as f64).then_some(0..self.order.len());
        let rows = if empty || all.is_some() { 0..0 } else { lo[2]..hi[2] + 1 };
        rows.flat_map(move |z| (lo[1]..hi[1] + 1).map(move |y| (y, z)))
            .flat_map(move |(y, z)| self.row(lo[0]..hi[0] + 1, y, z))
            .chain(all)
            .filter(|run| !run.is_empty())
    }

    /// Indices of the `points` (those the grid was made of) within `radius` [m] of `centre`, in sorted order.
    pub fn within<'a>(
        &'a self,
        points: &'a [Vec3],
        centre: Vec3,
        radius: f64,
    ) -> impl Iterator<Item = u32> + 'a {
        self.runs_near(centre, radius)
            .flat_map(|run| self.order[run].iter().copied())
            .filter(move |&i| (points[i as usize] - centre).norm_squared() <= radius * radius)
    }

    /// Index of the one of the `points` (those the grid was made of) nearest to `position` [m], the lowest of several; sought within `first` [m] of it, then
    /// within twice that, and so on. `None` where there are no points, or the position is not finite.
    pub fn nearest(&self, points: &[Vec3], position: Vec3, first: f64) -> Option<u32> {
        let square = |i: u32| (points[i as usize] - position).norm_squared();
        let mut reach = first;
        while reach.is_finite() {
            let found = self.within(points, position, reach).map(|i| (square(i), i));
            if let Some((_, i)) = found.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))) {
                return Some(i);
            }
            reach *= 2.0;
        }
        None
    }
}

/// Cells at least `cell` [m] wide over the box of so many points from its lowest to its highest corner [m], in blocks, as cubic as the box allows, that
/// would hold `points_of_a_block` each if they were spread evenly, or in one.
///
/// # Panics
/// When `cell` is not positive, or a coordinate is not finite.
pub fn lattice_over(
    (lo, hi): (Vec3, Vec3),
    cell: f64,
    points: usize,
    points_of_a_block: Option<usize>,
) -> Lattice {
    assert!(cell > 0.0 && cell.is_finite(), "cell size must be positive, got {cell} m");
    if points == 0 {
        return Lattice { origin: Vec3::zeros(), cell, dims: [0; 3], block: [1; 3], blocks: [1; 3] };
    }
    let extent = hi - lo;
    assert!(extent.iter().all(|e| e.is_finite()), "coordinates must be finite");
    let cell = cell.max(extent.max() / CELLS_PER_AXIS);
    let dims = [0, 1, 2].map(|a| (extent[a] / cell).floor() as i64 + 1);
    let cells = dims.iter().map(|&d| d as f64).product::<f64>();
    // Blocks may reach beyond the last cells: their numbers must fit as well.
    let (mut block, mut blocks) = (dims, [1; 3]);
    if let Some(points_of_a_block) = points_of_a_block.filter(|_| 8.0 * cells < i64::MAX as f64) {
        block = block_of(dims, points_of_a_block as f64 * cells / points as f64);
        blocks = [0, 1, 2].map(|a| (dims[a] as u64).div_ceil(block[a] as u64) as i64);
    }
    Lattice { origin: lo, cell, dims, block, blocks }
}

/// Cells along each axis of blocks of about so many cells: as cubic as the box allows, and so that blocks fill it.
fn block_of(dims: [i64; 3], cells: f64) -> [i64; 3] {
    let mut axes = [0, 1, 2];
    axes.sort_by_key(|&a| dims[a]);
    let (mut block, mut rest) = ([1; 3], cells.max(1.0));
    for (axis, root) in axes.into_iter().zip([3.0, 2.0, 1.0]) {
        let wished = (rest.powf(1.0 / root).round()).clamp(1.0, dims[axis] as f64);
        let count = (dims[axis] as f64 / wished).ceil();
        block[axis] = (dims[axis] as f64 / count).ceil() as i64;
        rest /= block[axis] as f64;
    }
    block
}

/// Lowest and highest coordinates [m]; (∞, −∞) for no points.
pub fn bounds(points: &[Vec3]) -> (Vec3, Vec3) {
    let none = || (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    points
        .par_iter()
        .fold(none, |(lo, hi), p| (lo.inf(p), hi.sup(p)))
        .reduce(none, |a, b| (a.0.inf(&b.0), a.1.sup(&b.1)))
}

/// Where each key is, by open addressing.
fn slots_of(keys: &[u64]) -> Vec<u32> {
    let mut slots = vec![EMPTY; (2 * keys.len()).next_power_of_two()];
    for (index, &key) in (0..).zip(keys) {
        let mut slot = hash(key) as usize & (slots.len() - 1);
        while slots[slot] != EMPTY {
            slot = (slot + 1) & (slots.len() - 1);
        }
        slots[slot] = index;
    }
    slots
}

fn find(keys: &[u64], slots: &[u32], key: u64) -> Option<usize> {
    let mut slot = hash(key) as usize & (slots.len() - 1);
    loop {
        match slots[slot] {
            EMPTY => return None,
            index if keys[index as usize] == key => return Some(index as usize),
            _ => slot = (slot + 1) & (slots.len() - 1),
        }
    }
}

/// Mixes the bits of a cell key (Stafford 2011, variant 13 of the MurmurHash3 finaliser).
fn hash(key: u64) -> u64 {
    let key = (key ^ (key >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let key = (key ^ (key >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    key ^ (key >> 31)
}

#[cfg(test)]
mod tests;
