//! Velocity, solid fraction and size of the grains on a grid.
//!
//! Each cell takes the exact part of every ball that lies in it (see [`crate::ball`]), not whole balls by their centres:
//!
//! ```text
//! φ = Σ Vᵢ / V_cell      u = Σ ρᵢVᵢuᵢ / Σ ρᵢVᵢ      T = Σ ρᵢVᵢ |uᵢ − u|² / 3 Σ ρᵢVᵢ      V_i: part of ball i in the cell
//! d₁₀ = Σ wᵢdᵢ / Σ wᵢ     d₃₂ = Σ wᵢdᵢ³ / Σ wᵢdᵢ²     wᵢ = Vᵢ / (π dᵢ³/6)
//! ```
//!
//! Several frames are averaged by adding their sums. Where grains overlap, what they share counts for both.

use crate::observer::OfFrame;
use crate::sheet::{Chart, Head, Panel, Row, Summary};
use crate::{Frame, MeasureError, Run, ball, table};
use geom::Vec3;

/// Most cells of a grid.
const MOST: f64 = 1e7;

/// What is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct ProfileOptions {
    /// Number of cells along x, y, z.
    pub bins: [usize; 3],
    /// Corners of the grid [m]; `None`: the box around all grains of the first frame.
    pub corners: Option<(Vec3, Vec3)>,
    /// Whether frames are averaged.
    pub mean: bool,
    /// Other columns of `/particles` whose mass-weighted mean is wanted.
    pub fields: Vec<String>,
}

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

    /// Adds the grains of a frame; `fields` are columns of it.
    ///
    /// # Errors
    /// A material without density.
    pub fn add(&mut self, frame: &Frame, fields: &[Vec<f64>]) -> Result<(), MeasureError> {
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
                let part = ball::in_box(&p, r, &low, &(low + self.step));
                if part > 0.0 {
                    let cell = &mut self.cells[(z * self.bins[1] + y) * self.bins[0] + x];
                    cell.add(part, part / ball::volume(r), *mass, r, &v);
                    let m = mass * part / ball::volume(r);
                    cell.fields.iter_mut().zip(fields).for_each(|(sum, f)| *sum += m * f[row]);
                }
            }
        }
        self.frames += 1;
        self.time = frame.time;
        Ok(())
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

/// Measures profiles of chosen frames.
pub struct Profile {
    options: ProfileOptions,
    grid: Option<Grid>,
    bounds: Option<(Vec3, Vec3)>,
    fraction: f64,
}

impl Profile {
    /// With these options.
    ///
    /// # Errors
    /// No cells, too many cells, no room between the corners.
    pub fn new(options: ProfileOptions) -> Result<Profile, MeasureError> {
        let (low, high) = options.corners.unwrap_or((Vec3::zeros(), Vec3::repeat(1.0)));
        Grid::new(low, high, options.bins, 0)?;
        Ok(Profile { options, grid: None, bounds: None, fraction: f64::NAN })
    }

    fn fields(&self, frame: &Frame) -> Result<Vec<Vec<f64>>, MeasureError> {
        let of = |name: &String| {
            let has = || table::names(&frame.table);
            let values = frame.table.get(name).map(|v| v.to_f64());
            values.ok_or_else(|| MeasureError::Field { name: name.clone(), has: has() })
        };
        self.options.fields.iter().map(of).collect()
    }
}

impl OfFrame for Profile {
    fn heads(&self) -> Vec<Head> {
        let mut heads = Head::list(&[
            ("time", "s"),
            ("x", "m"),
            ("y", "m"),
            ("z", "m"),
            ("solid_fraction", "1"),
            ("grains", "1"),
            ("vx", "m/s"),
            ("vy", "m/s"),
            ("vz", "m/s"),
            ("speed", "m/s"),
            ("granular_temperature", "m²/s²"),
            ("d10", "m"),
            ("d32", "m"),
        ]);
        heads.extend(self.options.fields.iter().map(|f| Head { name: f.clone(), unit: "as in the run" }));
        heads
    }

    fn measure(&mut self, _: &Run, frame: &Frame) -> Result<Vec<Row>, MeasureError> {
        let fields = self.fields(frame)?;
        if frame.is_empty() && self.options.corners.is_none() && self.grid.is_none() {
            return Ok(Vec::new());
        }
        let bounds = frame.bounds();
        self.bounds = Some(self.bounds.map_or(bounds, |b| (b.0.inf(&bounds.0), b.1.sup(&bounds.1))));
        let (low, high) = self.options.corners.or(self.grid.as_ref().map(Grid::corners)).unwrap_or(bounds);
        let kept = if self.options.mean { self.grid.take() } else { None };
        let mut grid = match kept {
            Some(grid) => grid,
            None => Grid::new(low, high, self.options.bins, fields.len())?,
        };
        grid.add(frame, &fields)?;
        self.fraction = grid.solid_fraction();
        let rows = if self.options.mean { Vec::new() } else { grid.rows() };
        self.grid = Some(grid);
        Ok(rows)
    }

    fn end(&mut self) -> Result<(Vec<Row>, Summary), MeasureError> {
        let Some(grid) = &self.grid else {
            return Err(MeasureError::FewGrains { what: "a profile", most: 0, wanted: 1 });
        };
        if self.fraction == 0.0 {
            let (low, high) = self.bounds.unwrap_or_default();
            return Err(MeasureError::NothingInside { what: "grain", low: low.into(), high: high.into() });
        }
        let rows = if self.options.mean { grid.rows() } else { Vec::new() };
        let (low, high) = grid.corners();
        let summary = Summary::default()
            .with("solid_fraction", "1", self.fraction)
            .with("frames", "1", if self.options.mean { grid.frames as f64 } else { 1.0 })
            .with("cell", "m³", grid.step.product());
        let corners: Vec<String> =
            low.iter().chain(high.iter()).map(|v| geom::Shown(*v).to_string()).collect();
        Ok((rows, summary.note(format!("grid in box:{}", corners.join(",")))))
    }

    fn chart(&self, rows: &[Row]) -> Chart {
        let bins = self.options.bins;
        let last = rows.len().saturating_sub(bins.iter().product());
        let rows = &rows[last..];
        let wide: Vec<usize> = (0..3).filter(|k| bins[*k] > 1).collect();
        let name = |axis: usize| format!("{} [m]", ["x", "y", "z"][axis]);
        let time = rows.first().map_or(0.0, |r| r[0]);
        let title = if self.options.mean { "Mean profile until" } else { "Profile at" };
        let mut chart = Chart::new(format!("{title} {time:.4} s"));
        match wide[..] {
            [] | [_] => {
                let axis = wide.first().copied().unwrap_or(2);
                let (label, x) = (name(axis), axis + 1);
                chart = chart
                    .columns((&label, x), "solid fraction [1]", &[("", 4)], rows)
                    .columns((&label, x), "velocity [m/s]", &[("vx", 6), ("vy", 7), ("vz", 8)], rows)
                    .columns((&label, x), "size [m]", &[("d10", 11), ("d32", 12)], rows);
            }
            [a, b, ..] => {
                let (Some(first), Some(end)) = (rows.first(), rows.last()) else { return chart };
                let half = self.grid.as_ref().map_or(Vec3::zeros(), |g| g.step * 0.5);
                let range = [
                    first[a + 1] - half[a],
                    first[b + 1] - half[b],
                    end[a + 1] + half[a],
                    end[b + 1] + half[b],
                ];
                for (value, column) in [("solid fraction [1]", 4), ("speed [m/s]", 9)] {
                    // Of a grid with three wide axes, the layer in the middle of the last one.
                    let layer = if wide.len() == 3 { bins[2] / 2 * bins[0] * bins[1] } else { 0 };
                    let cell = |i: usize, j: usize| rows[layer + j * bins[a] + i][column];
                    let cells = (0..bins[b]).map(|j| (0..bins[a]).map(|i| cell(i, j)).collect()).collect();
                    let (x, y, value) = (name(a), name(b), value.to_owned());
                    chart.panels.push(Panel::Map { x, y, value, range, cells });
                }
            }
        }
        chart
    }
}

impl Grid {
    /// Its corners [m].
    pub fn corners(&self) -> (Vec3, Vec3) {
        let size = Vec3::new(self.bins[0] as f64, self.bins[1] as f64, self.bins[2] as f64);
        (self.low, self.low + self.step.component_mul(&size))
    }
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
        grid.add(&frame, &[]).unwrap();
        for row in grid.rows() {
            assert!((row[4] - ball::volume(0.3) / 4.0).abs() < 1e-15, "{row:?}");
            let expected = [0.25, 1.0, 2.0, -2.0, 3.0, 0.0, 0.6, 0.6];
            for (value, expected) in row[5..].iter().zip(expected) {
                assert!((value - expected).abs() < 1e-12, "{row:?}");
            }
        }
    }
}
