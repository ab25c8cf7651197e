//! Points inside a stone, on a grid, and on its surface, evenly by area.

use crate::random::even;
use crate::stone::Stone;
use geom::Vec3;
use nalgebra::Matrix3;
use rayon::prelude::*;

/// Cells of the grid along the longest side; odd, so that one lies in the middle.
const CELLS: f64 = 73.0;

/// The centres of the cells of a cubic grid; a cell is inside if its centre is.
#[derive(Clone)]
pub(crate) struct Samples {
    origin: Vec3,
    /// Width of a cell [m].
    pub cell: f64,
    dims: [usize; 3],
    /// Of each cell, x fastest: whether it is inside and not covered.
    open: Vec<bool>,
    /// Of each row, one more number than cells: how many cells before this one are open.
    before: Vec<u32>,
    /// Numbers of the cells inside.
    pub inside: Vec<u32>,
}

impl Samples {
    pub(crate) fn new(stone: &Stone) -> Samples {
        let (lo, hi) = stone.inside.bounds();
        let cell = (hi - lo).max() / CELLS;
        let dims = [0, 1, 2].map(|a| ((hi[a] - lo[a]) / cell).ceil().max(1.0) as usize);
        let mut samples =
            Samples { origin: lo, cell, dims, open: Vec::new(), before: Vec::new(), inside: Vec::new() };
        let cells = dims[0] * dims[1] * dims[2];
        samples.open =
            (0..cells).into_par_iter().map(|k| stone.inside.contains(&samples.place(k as u32))).collect();
        samples.inside = (0..cells as u32).filter(|&k| samples.open[k as usize]).collect();
        samples.before = vec![0; (dims[0] + 1) * dims[1] * dims[2]];
        (0..dims[1] * dims[2]).for_each(|row| samples.recount(row));
        samples
    }

    fn recount(&mut self, row: usize) {
        let width = self.dims[0];
        let mut sum = 0;
        for x in 0..width {
            sum += u32::from(self.open[row * width + x]);
            self.before[row * (width + 1) + x + 1] = sum;
        }
    }

    /// The centre of a cell [m].
    pub(crate) fn place(&self, cell: u32) -> Vec3 {
        let (k, [nx, ny, _]) = (cell as usize, self.dims);
        let at = Vec3::new((k % nx) as f64, (k / nx % ny) as f64, (k / nx / ny) as f64);
        self.origin + (at + Vec3::repeat(0.5)) * self.cell
    }

    /// Calls `row` with each row of cells whose centres a ball holds: number of the row, first cell and the one after the last.
    fn rows(&self, (centre, radius): (Vec3, f64), mut row: impl FnMut(usize, usize, usize)) {
        let c = (centre - self.origin) / self.cell - Vec3::repeat(0.5);
        let r = radius / self.cell;
        let range = |x: f64, reach: f64, most: usize| {
            let first = (x - reach).ceil().max(0.0) as usize;
            let last = (x + reach).floor() + 1.0;
            (first, (last.max(0.0) as usize).min(most))
        };
        let (z0, z1) = range(c.z, r, self.dims[2]);
        for z in z0..z1 {
            let rest = r * r - (z as f64 - c.z).powi(2);
            let (y0, y1) = range(c.y, rest.max(0.0).sqrt(), self.dims[1]);
            for y in y0..y1 {
                let rest = rest - (y as f64 - c.y).powi(2);
                if rest >= 0.0 {
                    let (x0, x1) = range(c.x, rest.sqrt(), self.dims[0]);
                    if x0 < x1 {
                        row(z * self.dims[1] + y, x0, x1);
                    }
                }
            }
        }
    }

    /// Number of open cells in a ball.
    pub(crate) fn gain(&self, ball: (Vec3, f64)) -> u32 {
        let (mut sum, width) = (0, self.dims[0] + 1);
        self.rows(ball, |row, x0, x1| sum += self.before[row * width + x1] - self.before[row * width + x0]);
        sum
    }

    /// Covers the cells in a ball.
    pub(crate) fn cover(&mut self, ball: (Vec3, f64)) {
        let mut rows = Vec::new();
        self.rows(ball, |row, x0, x1| rows.push((row, x0, x1)));
        for (row, x0, x1) in rows {
            let first = row * self.dims[0];
            self.open[first + x0..first + x1].fill(false);
            self.recount(row);
        }
    }

    /// Share of the inside that is not covered [–].
    pub(crate) fn uncovered(&self) -> f64 {
        let open = self.inside.iter().filter(|&&k| self.open[k as usize]).count();
        open as f64 / self.inside.len().max(1) as f64
    }

    /// Inertia of density 1 [m⁵] of all cells, and of the covered ones, each about its own centre.
    pub(crate) fn inertia(&self) -> [Matrix3<f64>; 2] {
        [true, false].map(|all| {
            let cells =
                || self.inside.iter().filter(|&&k| all || !self.open[k as usize]).map(|&k| self.place(k));
            let count = cells().count().max(1) as f64;
            let centre = cells().sum::<Vec3>() / count;
            let second: Matrix3<f64> = cells().map(|p| (p - centre) * (p - centre).transpose()).sum();
            (Matrix3::identity() * second.trace() - second) * self.cell.powi(3)
        })
    }
}

/// A point of the surface [m] and the normal there that points into the stone.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SurfacePoint {
    pub place: Vec3,
    pub inwards: Vec3,
}

/// Points spread over the surface: one for each equal part of the area, at an even place of its face.
pub(crate) fn surface(stone: &Stone, count: usize) -> Vec<SurfacePoint> {
    let total = stone.mesh.area();
    let (mut points, mut passed) = (Vec::with_capacity(count), 0.0);
    for [a, b, c] in stone.mesh.triangles() {
        let area = geom::mesh::area([a, b, c]);
        passed += area;
        let Some(inwards) = (c - a).cross(&(b - a)).try_normalize(0.0) else { continue };
        while points.len() < count && (points.len() as f64 + 0.5) / count as f64 * total < passed {
            let [u, v, _] = even(points.len());
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            points.push(SurfacePoint { place: a + (b - a) * u + (c - a) * v, inwards });
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stone::tests::block;

    #[test]
    fn cells_count_volumes_and_a_cover_is_the_union() {
        let stone = block(0.1, 0.1, 0.1);
        let mut samples = Samples::new(&stone);
        let cell = samples.cell.powi(3);
        assert!((samples.inside.len() as f64 * cell / 1e-3 - 1.0).abs() < 1e-9);
        let ball = (Vec3::repeat(0.05), 0.025);
        let volume = geom::sphere::volume(0.025);
        assert!((f64::from(samples.gain(ball)) * cell / volume - 1.0).abs() < 0.01);
        samples.cover(ball);
        samples.cover(ball);
        assert_eq!(samples.gain(ball), 0);
        assert!((1.0 - samples.uncovered() - volume / 1e-3).abs() < 0.002);
    }

    #[test]
    fn surface_points_are_even_by_area_and_their_normals_point_inwards() {
        let stone = block(0.2, 0.1, 0.1);
        let points = surface(&stone, 1000);
        assert_eq!(points.len(), 1000);
        let end = points.iter().filter(|p| p.inwards.x > 0.5).count();
        assert_eq!(end, 100, "an end is a tenth of the area");
        assert!(points.iter().all(|p| stone.inside.contains(&(p.place + p.inwards * 1e-6))));
    }
}
