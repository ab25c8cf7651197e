//! Points in the order of the cell grid, with the runs of neighbouring places worked out once per cell.
//!
//! The samplers ask for the neighbours of most points, often, and at several radii: looking cells up once for
//! all points of a cell, and walking positions that lie side by side in memory, is several times faster
//! than asking the grid point by point.

use geom::{Grid, Vec3};
use rayon::prelude::*;
use std::ops::Range;

/// A cell that holds points.
#[derive(Debug, Clone)]
struct Cell {
    /// Its own places.
    own: (u32, u32),
    /// Places in the 27 cells around it: at most nine contiguous runs.
    rows: [(u32, u32); 9],
    /// Runs in use.
    used: u8,
}

/// Points sorted by cell; a *place* is an index in this order.
#[derive(Debug, Clone)]
pub(crate) struct Cells {
    /// Positions by place [m].
    pub points: Vec<Vec3>,
    /// Index of the point at each place.
    pub order: Vec<u32>,
    /// Width of a cell, and the largest radius that may be asked for [m].
    pub width: f64,
    cells: Vec<Cell>,
    cell_of: Vec<u32>,
}

impl Cells {
    /// Sorts `points` [m] into cells for searches up to `reach` [m].
    pub fn new(points: &[Vec3], reach: f64) -> Cells {
        let grid = Grid::new(points, reach);
        let order = grid.order().to_vec();
        let sorted: Vec<Vec3> = order.par_iter().map(|&i| points[i as usize]).collect();
        let at: Vec<[i64; 3]> = sorted.par_iter().map(|p| grid.cell_of(p)).collect();
        let mut own = Vec::new();
        let mut cell_of = Vec::with_capacity(order.len());
        for run in at.chunk_by(|a, b| a == b) {
            let start = cell_of.len() as u32;
            cell_of.extend(std::iter::repeat_n(own.len() as u32, run.len()));
            own.push((start, start + run.len() as u32));
        }
        let cells = own.par_iter().map(|&own| cell_around(&grid, at[own.0 as usize], own)).collect();
        Cells { points: sorted, order, width: grid.cell(), cells, cell_of }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Runs of places that hold every point within one cell width of the point at `place`.
    pub fn runs(&self, place: u32) -> impl Iterator<Item = Range<usize>> + '_ {
        let cell = &self.cells[self.cell_of[place as usize] as usize];
        cell.rows[..cell.used as usize].iter().map(|&(a, b)| a as usize..b as usize)
    }

    /// Places, and squared distances [m²], of the points nearer than `radius` [m] to the one at `place`; itself too.
    pub fn near(&self, place: u32, radius: f64) -> impl Iterator<Item = (u32, f64)> + '_ {
        debug_assert!(radius <= self.width);
        let centre = self.points[place as usize];
        self.runs(place).flatten().filter_map(move |other| {
            let square = (self.points[other] - centre).norm_squared();
            (square < radius * radius).then_some((other as u32, square))
        })
    }

    /// For each place, `f` of the place; in parallel, cell by cell.
    pub fn map<T: Send>(&self, f: impl Fn(u32) -> T + Sync) -> Vec<T> {
        let parts: Vec<&[Cell]> = self.cells.chunks(256).collect();
        let mapped: Vec<Vec<T>> = parts
            .into_par_iter()
            .map(|part| part.iter().flat_map(|cell| cell.own.0..cell.own.1).map(&f).collect())
            .collect();
        mapped.into_iter().flatten().collect()
    }

    /// Number of cells that hold a point.
    pub fn occupied(&self) -> usize {
        self.cells.len()
    }
}

fn cell_around(grid: &Grid, [x, y, z]: [i64; 3], own: (u32, u32)) -> Cell {
    let mut cell = Cell { own, rows: [(0, 0); 9], used: 0 };
    for (dy, dz) in (-1..2).flat_map(|dz| (-1..2).map(move |dy| (dy, dz))) {
        let run = grid.row(x - 1..x + 2, y + dy, z + dz);
        if !run.is_empty() {
            cell.rows[cell.used as usize] = (run.start as u32, run.end as u32);
            cell.used += 1;
        }
    }
    cell
}
