//! Velocity, solid fraction and size of the grains on a grid.
//!
//! Each cell takes the exact part of every ball that lies in it (see [`crate::ball`]), not whole balls by their centres:
//!
//! ```text
//! φ = Σ Vᵢ / V_cell      u = Σ ρᵢVᵢuᵢ / Σ ρᵢVᵢ      T = Σ ρᵢVᵢ |uᵢ − u|² / 3 Σ ρᵢVᵢ      V_i: part of ball i in the cell
//! d₁₀ = Σ wᵢdᵢ / Σ wᵢ     d₃₂ = Σ wᵢdᵢ³ / Σ wᵢdᵢ²     wᵢ = Vᵢ / (π dᵢ³/6)
//! ```
//!
//! A turned grid ([`Turn`]) takes positions and velocities along its own axes. Several frames are averaged by adding their sums. Where grains overlap, the shared volume counts for both.

mod observe;
mod turn;

pub use observe::{BoxOfFrames, Profile, ProfileOptions};
pub use turn::Turn;

use crate::sheet::Row;
use crate::{Frame, MeasureError, ball};
use geom::Vec3;

/// Most cells of a grid.
const MOST: f64 = 1e7;

/// Sums of one cell.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cell {
    /// Volume of grains [m³].
    pub volume: f64,
    mass: f64,
    momentum: Vec3,
    square: f64,
    count: f64,
    /// Σ w d, Σ w d², Σ w d³.
    sizes: [f64; 3],
    fields: Vec<f64>,
}

/// Sums on a grid.
#[derive(Debug, Clone)]
pub struct Grid {
    low: Vec3,
    step: Vec3,
    bins: [usize; 3],
    cells: Vec<Cell>,
    frames: u64,
    time: f64,
}

impl Grid {
    /// An empty grid between two corners [m].
    ///
    /// # Errors
    /// No cells, too many cells, no room between the corners.
    pub fn new(low: Vec3, high: Vec3, bins: [usize; 3], fields: usize) -> Result<Grid, MeasureError> {
        let count: f64 = bins.iter().map(|n| *n as f64).product();
        if !(1.0..=MOST).contains(&count) {
            return Err(MeasureError::Cells { what: "profile", count, most: MOST });
        }
        let size = high - low;
        if !size.iter().all(|s| *s > 0.0 && s.is_finite()) {
            return Err(MeasureError::EmptyShape { volume: size.product().max(0.0) });
        }
        let step = Vec3::new(size.x / bins[0] as f64, size.y / bins[1] as f64, size.z / bins[2] as f64);
        let cell = Cell { fields: vec![0.0; fields], ..Cell::default() };
        Ok(Grid { low, step, bins, cells: vec![cell; count as usize], frames: 0, time: 0.0 })
    }

    /// Adds the grains of a frame, as far as they are between the corners of `room` [m]; `fields` are columns of it.
    ///
    /// # Errors
    /// A material without density.
    pub fn add(
        &mut self,
        frame: &Frame,
        room: &(Vec3, Vec3),
        fields: &[Vec<f64>],
    ) -> Result<(), MeasureError> {
        let masses = frame.masses()?;
        for (row, mass) in masses.iter().enumerate() {
            let (p, v, r) = (frame.position[row], frame.velocity[row], frame.radius[row]);
            let range = |k: usize| {
                let cell = |x: f64| ((x - self.low[k]) / self.step[k]).floor().max(0.0) as usize;
                cell(p[k] - r)..(cell(p[k] + r) + 1).min(if p[k] + r < self.low[k] {
                    0
                } else {
                    self.bins[k]
                })
            };
            let [xs, ys, zs] = [0, 1, 2].map(range);
            for (z, y, x) in cells(zs, ys, xs) {
                let low = self.low + self.step.component_mul(&Vec3::new(x as f64, y as f64, z as f64));
                let (low, high) = (low.sup(&room.0), (low + self.step).inf(&room.1));
                if (0..3).any(|k| low[k] >= high[k]) {
                    continue;
                }
                let part = ball::in_box(&p, r, &low, &high);
                if part > 0.0 {
                    let cell = &mut self.cells[(z * self.bins[1] + y) * self.bins[0] + x];
                    cell.add(part * frame.share(row), part / ball::volume(r), *mass, r, &v);
                    let m = mass * part / ball::volume(r);
                    cell.fields.iter_mut().zip(fields).for_each(|(sum, f)| *sum += m * f[row]);
                }
            }
        }
        self.frames += 1;
        self.time = frame.time;
        Ok(())
    }

    /// Its corners [m].
    pub fn corners(&self) -> (Vec3, Vec3) {
        let size = Vec3::new(self.bins[0] as f64, self.bins[1] as f64, self.bins[2] as f64);
        (self.low, self.low + self.step.component_mul(&size))
    }

    /// Volume of a cell [m³].
    pub fn cell(&self) -> f64 {
        self.step.product()
    }

    /// A row for each cell: time, its centre, solid fraction, velocity, …
    pub fn rows(&self) -> Vec<Row> {
        let volume = self.step.product() * self.frames as f64;
        let row = |(k, c): (usize, &Cell)| {
            let (x, yz) = (k % self.bins[0], k / self.bins[0]);
            let at = Vec3::new(x as f64, (yz % self.bins[1]) as f64, (yz / self.bins[1]) as f64);
            let centre = self.low + self.step.component_mul(&at.add_scalar(0.5));
            let (u, frames) = (c.momentum / c.mass, self.frames as f64);
            let heat = (c.square / c.mass - u.norm_squared()).max(0.0) / 3.0;
            let heat = if c.mass > 0.0 { heat } else { f64::NAN };
            let sizes = [c.sizes[0] / c.count, c.sizes[2] / c.sizes[1]];
            let mut row = vec![self.time, centre.x, centre.y, centre.z, c.volume / volume, c.count / frames];
            row.extend([u.x, u.y, u.z, u.norm(), heat, sizes[0], sizes[1]]);
            row.extend(c.fields.iter().map(|f| f / c.mass));
            row
        };
        self.cells.iter().enumerate().map(row).collect()
    }

    /// Volume of grains over volume of the grid [–].
    pub fn solid_fraction(&self) -> f64 {
        let sum: f64 = self.cells.iter().map(|c| c.volume).sum();
        sum / (self.step.product() * (self.cells.len() as u64 * self.frames) as f64)
    }
}

impl Cell {
    fn add(&mut self, part: f64, share: f64, mass: f64, radius: f64, v: &Vec3) {
        let (m, d) = (mass * share, 2.0 * radius);
        self.volume += part;
        self.mass += m;
        self.momentum += v * m;
        self.square += v.norm_squared() * m;
        self.count += share;
        for (k, sum) in self.sizes.iter_mut().enumerate() {
            *sum += share * [d, d * d, d * d * d][k];
        }
    }
}

fn cells(
    zs: std::ops::Range<usize>,
    ys: std::ops::Range<usize>,
    xs: std::ops::Range<usize>,
) -> impl Iterator<Item = (usize, usize, usize)> {
    zs.flat_map(move |z| {
        let xs = xs.clone();
        ys.clone().flat_map(move |y| xs.clone().map(move |x| (z, y, x)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One ball astride four cells: each holds a quarter, and all quantities are those of the ball.
    #[test]
    fn a_ball_on_an_edge_is_shared() {
        let mut grid = Grid::new(Vec3::zeros(), Vec3::new(2.0, 1.0, 2.0), [2, 1, 2], 0).unwrap();
        let frame = Frame {
            id: vec![7],
            position: vec![Vec3::new(1.0, 0.5, 1.0)],
            velocity: vec![Vec3::new(1.0, 2.0, -2.0)],
            radius: vec![0.3],
            material: vec![0],
            mass: vec![5.0],
            ..Frame::default()
        };
        grid.add(&frame, &crate::periodic::PeriodicBox::default().corners(), &[]).unwrap();
        for row in grid.rows() {
            assert!((row[4] - ball::volume(0.3) / 4.0).abs() < 1e-15, "{row:?}");
            let expected = [0.25, 1.0, 2.0, -2.0, 3.0, 0.0, 0.6, 0.6];
            for (value, expected) in row[5..].iter().zip(expected) {
                assert!((value - expected).abs() < 1e-12, "{row:?}");
            }
        }
    }
}
