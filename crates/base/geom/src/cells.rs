//! Points in the order of the cell grid, with the runs of neighbouring cells computed once per cell.
//!
//! The samplers search the neighbours of most points, many times, and at several radii. One lookup for all
//! points of a cell, and positions that are contiguous in memory, are several times faster than a search in
//! the grid point by point.

use crate::{Grid, Vec3};
use rayon::prelude::*;
use std::ops::Range;

/// Threads take this many cells or slots at a time.
const PART: usize = 1024;

/// The cells that hold points, sorted: the key of each, and its first slot; behind them the number of slots.
struct Filled<'a> {
    dims: [i64; 3],
    keys: &'a [u64],
    starts: &'a [u32],
}

/// The surroundings of a cell that holds points.
#[derive(Debug, Clone)]
struct Cell {
    /// Slots in the 27 cells around it: at most nine contiguous runs.
    rows: [(u32, u32); 9],
    /// How many of these runs are in use.
    used: u8,
}

/// Points sorted by cell; a *slot* is an index in this order.
#[derive(Debug, Clone)]
pub struct Cells {
    /// Positions by slot [m].
    pub points: Vec<Vec3>,
    /// The grid that the order comes from; it serves searches wider than a cell.
    pub grid: Grid,
    /// Width of a cell, which is also the largest radius of a search [m].
    pub width: f64,
    cells: Vec<Cell>,
    cell_of: Vec<u32>,
}

impl Cells {
    /// Sorts `points` [m] into cells for searches up to `reach` [m].
    pub fn new(points: &[Vec3], reach: f64) -> Cells {
        let grid = Grid::new(points, reach);
        let order = grid.order();
        let sorted: Vec<Vec3> = order.par_iter().map(|&i| points[i as usize]).collect();
        let (keys, starts) = grid.filled();
        let filled = Filled { dims: grid.dims(), keys: &keys, starts: &starts };
        let mut cell_of = vec![0; order.len()];
        for (cell, run) in (0..).zip(starts.windows(2)) {
            cell_of[run[0] as usize..run[1] as usize].fill(cell);
        }
        let mut cells = vec![Cell { rows: [(0, 0); 9], used: 0 }; keys.len()];
        cells.par_chunks_mut(PART).enumerate().for_each(|(part, cells)| filled.rows(part * PART, cells));
        drop((keys, starts));
        Cells { points: sorted, width: grid.cell(), grid, cells, cell_of }
    }

    /// Cells that hold points in cubes of `wide` cells a side: the coordinates of each cube, and the runs of slots of its cells; sorted
    /// by cube.
    pub fn cubes(&self, wide: i64) -> Vec<([i64; 3], Vec<Range<usize>>)> {
        let (keys, starts) = self.grid.filled();
        let filled = Filled { dims: self.grid.dims(), keys: &keys, starts: &starts };
        let cubes = self.grid.dims().map(|n| n / wide + 1);
        let mut by_cube: Vec<(u64, u32)> = (0..keys.len() as u32)
            .into_par_iter()
            .with_min_len(PART)
            .map(|cell| {
                let [x, y, z] = filled.at(cell as usize).map(|c| c / wide);
                (((z * cubes[1] + y) * cubes[0] + x) as u64, cell)
            })
            .collect();
        by_cube.par_sort_unstable();
        let runs = |cube: &[(u64, u32)]| {
            let (key, [nx, ny, _]) = (cube[0].0 as i64, cubes);
            let run = |cell: usize| starts[cell] as usize..starts[cell + 1] as usize;
            (
                [key % nx, key / nx % ny, key / nx / ny],
                cube.iter().map(|&(_, cell)| run(cell as usize)).collect(),
            )
        };
        by_cube.chunk_by(|a, b| a.0 == b.0).map(runs).collect()
    }

    /// Number of the cell that holds a slot.
    #[inline(always)]
    pub fn cell(&self, slot: u32) -> u32 {
        self.cell_of[slot as usize]
    }

    /// Index of the point at each slot.
    pub fn order(&self) -> &[u32] {
        self.grid.order()
    }

    /// The slot of each point, by index.
    pub fn slots(&self) -> Vec<u32> {
        let mut slots = vec![0; self.len()];
        for (slot, &i) in (0..).zip(self.order()) {
            slots[i as usize] = slot;
        }
        slots
    }

    /// Whether there are no points.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Runs of slots that hold every point within one cell width of the point at `slot`.
    #[inline(always)]
    pub fn runs(&self, slot: u32) -> impl Iterator<Item = Range<usize>> + '_ {
        let cell = &self.cells[self.cell_of[slot as usize] as usize];
        cell.rows[..cell.used as usize].iter().map(|&(a, b)| a as usize..b as usize)
    }

    /// Calls `f` with the slot and the squared distance [m²] of each point nearer than `radius` [m]
    /// to the one at `slot`, and for that point itself.
    #[inline(always)]
    pub fn each_near(&self, slot: u32, radius: f64, mut f: impl FnMut(u32, f64)) {
        debug_assert!(radius <= self.width);
        let centre = self.points[slot as usize];
        for run in self.runs(slot) {
            for (other, point) in (run.start as u32..).zip(&self.points[run]) {
                let square = apart(point, &centre);
                if square < radius * radius {
                    f(other, square);
                }
            }
        }
    }

    /// Number of points nearer than `radius` [m] to the one at `slot`, that point included; counting may stop past `enough`.
    #[inline(always)]
    pub fn count_near(&self, slot: u32, radius: f64, enough: u32) -> u32 {
        let centre = self.points[slot as usize];
        let mut count = 0;
        for part in self.runs(slot).flat_map(|run| self.points[run].chunks(enough.clamp(64, 4096) as usize)) {
            // Without a branch: about half of the candidates are near, which cannot be predicted.
            count += part.iter().map(|p| (apart(p, &centre) < radius * radius) as u32).sum::<u32>();
            if count > enough {
                break;
            }
        }
        count
    }

    /// `f(slot)` for every slot, in parallel; the parts have a fixed size.
    pub fn map<T: Send>(&self, f: impl Fn(u32) -> T + Sync + Send) -> Vec<T> {
        (0..self.len() as u32).into_par_iter().with_min_len(PART).map(f).collect()
    }

    /// Number of cells that hold a point.
    pub fn occupied(&self) -> usize {
        self.cells.len()
    }
}

/// Squared distance [m²].
#[inline(always)]
pub fn apart(p: &Vec3, q: &Vec3) -> f64 {
    let (x, y, z) = (p.x - q.x, p.y - q.y, p.z - q.z);
    x * x + y * y + z * z
}

impl Filled<'_> {
    /// Coordinates of a cell in the grid.
    fn at(&self, cell: usize) -> [i64; 3] {
        let (key, [nx, ny, _]) = (self.keys[cell] as i64, self.dims);
        [key % nx, key / nx % ny, key / nx / ny]
    }

    /// Finds the rows of cells around each cell from `first` on. Cells are sorted (z slowest, x fastest), so the rows of successive cells
    /// only move forward: nine pointers pass the list once, without a search.
    fn rows(&self, first: usize, cells: &mut [Cell]) {
        let [nx, ny, nz] = self.dims;
        let at: Vec<[i64; 3]> = (first..first + cells.len()).map(|cell| self.at(cell)).collect();
        for (dz, dy) in (-1..2).flat_map(|dz| (-1..2).map(move |dy| (dz, dy))) {
            let shift = (dz * ny + dy) * nx;
            let mut from = self.keys.partition_point(|&k| (k as i64) < self.keys[first] as i64 + shift - 1);
            for ((index, around), &[x, y, z]) in (first..).zip(cells.iter_mut()).zip(&at) {
                if y + dy < 0 || z + dz < 0 || y + dy >= ny || z + dz >= nz {
                    continue;
                }
                let middle = self.keys[index] as i64 + shift;
                let (lowest, highest) = (middle - (x > 0) as i64, middle + (x + 1 < nx) as i64);
                while from < self.keys.len() && (self.keys[from] as i64) < lowest {
                    from += 1;
                }
                let mut to = from;
                while to < self.keys.len() && self.keys[to] as i64 <= highest {
                    to += 1;
                }
                if to > from {
                    around.rows[around.used as usize] = (self.starts[from], self.starts[to]);
                    around.used += 1;
                }
            }
        }
    }
}
