//! A raster of heights: the lowest points, openings, and smooth surfaces between what is known.

use geom::{Vec3, grid};
use rayon::prelude::*;

/// Cells as low as a pit that may be around it.
const ALIKE: usize = 2;

/// Heights by cell; NaN where nothing is known.
#[derive(Debug, Clone)]
pub struct Heights {
    /// Width of a cell [m].
    pub cell: f64,
    low: Vec3,
    size: [usize; 2],
    z: Vec<f64>,
}

impl Heights {
    /// The lowest of the finite `points` [m] in each cell [m].
    pub fn lowest(points: &[Vec3], cell: f64) -> Heights {
        let (low, high) = grid::bounds(points);
        let size = [0, 1].map(|a| ((high[a] - low[a]) / cell) as usize + 1);
        let mut all = Heights { cell, low, size, z: vec![f64::NAN; size[0] * size[1]] };
        for p in points {
            let [x, y] = [0, 1].map(|a| (((p[a] - low[a]) / cell) as usize).min(size[a] - 1));
            let z = &mut all.z[y * size[0] + x];
            // Of NaN and a number, the number.
            *z = z.min(p.z);
        }
        all
    }

    /// Cells along the longer side.
    pub fn widest(&self) -> usize {
        self.size[0].max(self.size[1])
    }

    /// The same without some cells.
    pub fn without(&self, gone: &[bool]) -> Heights {
        let z = self.z.iter().zip(gone).map(|(z, gone)| if *gone { f64::NAN } else { *z }).collect();
        Heights { z, ..*self }
    }

    /// Erosion, then dilation, by squares that reach so many cells to each side and lie wholly within the raster; a side of the raster that is too
    /// short for any has shorter ones. Every cell has a height.
    pub fn opened(&self, reach: usize) -> Heights {
        let reach = self.size.map(|n| reach.min((n - 1) / 2));
        let mut eroded = self.each_square(&self.z, reach, f64::min);
        let [nx, ny] = self.size;
        let within = |at: usize, reach: usize, n: usize| at >= reach && at + reach < n;
        for (k, z) in eroded.iter_mut().enumerate() {
            if !(within(k % nx, reach[0], nx) && within(k / nx, reach[1], ny)) {
                *z = f64::NEG_INFINITY;
            }
        }
        Heights { z: self.each_square(&eroded, reach, f64::max), ..*self }
    }

    /// Whether each cell is lower by more than `step` [m] than all but two of the cells around it, up to two away; not where few are known.
    pub fn pits(&self, step: f64) -> Vec<bool> {
        let [nx, ny] = self.size;
        let is_pit = |k: usize| {
            let [x, y] = [k % nx, k / nx];
            let rows = y.saturating_sub(2)..(y + 3).min(ny);
            let around = rows.flat_map(|y| &self.z[y * nx + x.saturating_sub(2)..y * nx + (x + 3).min(nx)]);
            let known: Vec<f64> = around.copied().filter(|z| !z.is_nan()).collect();
            // The cell itself is one of them.
            let alike = known.iter().filter(|z| *z - self.z[k] <= step).count();
            !self.z[k].is_nan() && alike <= ALIKE + 1 && known.len() > 3 * ALIKE
        };
        (0..self.z.len()).into_par_iter().map(is_pit).collect()
    }

    /// Whether each cell is higher by more than `step` [m] than in another raster of the same size; not where there is no height.
    pub fn above_by(&self, other: &Heights, step: f64) -> Vec<bool> {
        self.z.iter().zip(&other.z).map(|(z, other)| z - other > step).collect()
    }

    /// The least or greatest of the squares around each cell: along rows, then along columns.
    fn each_square(&self, z: &[f64], reach: [usize; 2], better: fn(f64, f64) -> f64) -> Vec<f64> {
        let [nx, ny] = self.size;
        let rows: Vec<f64> = z.par_chunks(nx).flat_map_iter(|row| running(row, reach[0], better)).collect();
        let turned = turned(&rows, nx);
        let columns: Vec<f64> =
            turned.par_chunks(ny).flat_map_iter(|column| running(column, reach[1], better)).collect();
        self::turned(&columns, ny)
    }

    /// Every cell gets a height, those without one the lowest of those around.
    pub fn lowered(self) -> Heights {
        if self.is_known() {
            return self;
        }
        let coarse = self.halved(|z: &mut dyn Iterator<Item = f64>| z.fold(f64::NAN, f64::min)).lowered();
        let [nx, _] = self.size;
        let fill = |(k, z): (usize, &f64)| {
            if z.is_nan() { coarse.z[k / nx / 2 * coarse.size[0] + k % nx / 2] } else { *z }
        };
        let z = self.z.par_iter().enumerate().map(fill).collect();
        Heights { z, ..self }
    }

    /// Whether all cells have a height, or none: there is nothing to fill, or nothing to fill with.
    fn is_known(&self) -> bool {
        self.z.iter().all(|z| z.is_nan()) || self.z.iter().all(|z| !z.is_nan())
    }

    /// Every cell gets a height, those without one by the cells around: means of coarser and coarser rasters, and back by interpolation (the
    /// pull and push of Gortler et al. 1996, doi:10.1145/237170.237200).
    pub fn filled(self) -> Heights {
        if self.is_known() {
            return self;
        }
        let mean = |z: &mut dyn Iterator<Item = f64>| {
            let (sum, count) = z.fold((0.0, 0.0), |(sum, count), z| (sum + z, count + 1.0));
            sum / count
        };
        let coarse = self.halved(mean).filled();
        let [nx, _] = self.size;
        let fill = |(k, z): (usize, &f64)| {
            let place = [k % nx, k / nx].map(|c| 0.5 * (c as f64 - 0.5));
            if z.is_nan() { coarse.between(place).0 } else { *z }
        };
        let z = self.z.par_iter().enumerate().map(fill).collect();
        Heights { z, ..self }
    }

    /// What stands for the known ones of two by two cells.
    fn halved(&self, of: impl Fn(&mut dyn Iterator<Item = f64>) -> f64 + Sync) -> Heights {
        let [nx, ny] = self.size;
        let size = [nx.div_ceil(2), ny.div_ceil(2)];
        let one = |k: usize| {
            let [x, y] = [2 * (k % size[0]), 2 * (k / size[0])];
            let four = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
            let there = four.iter().filter(|(x, y)| *x < nx && *y < ny).map(|(x, y)| self.z[y * nx + x]);
            of(&mut there.filter(|z| !z.is_nan()))
        };
        let z = (0..size[0] * size[1]).into_par_iter().map(one).collect();
        Heights { cell: 2.0 * self.cell, size, z, ..*self }
    }

    /// Height [m] and slope [–] at a position [m] of a raster without gaps.
    pub fn at(&self, p: &Vec3) -> (f64, f64) {
        let (z, slope) = self.between([0, 1].map(|a| (p[a] - self.low[a]) / self.cell - 0.5));
        (z, slope / self.cell)
    }

    /// Height, and slope for each cell, between the four middles of cells around.
    fn between(&self, place: [f64; 2]) -> (f64, f64) {
        let at = [0, 1].map(|a| place[a].clamp(0.0, (self.size[a] - 1) as f64));
        let cell = [0, 1].map(|a| (at[a] as usize).min(self.size[a].saturating_sub(2)));
        let [u, v] = [0, 1].map(|a| at[a] - cell[a] as f64);
        let z = |x: usize, y: usize| {
            let [x, y] = [(cell[0] + x).min(self.size[0] - 1), (cell[1] + y).min(self.size[1] - 1)];
            self.z[y * self.size[0] + x]
        };
        let (a, b, c, d) = (z(0, 0), z(1, 0), z(0, 1), z(1, 1));
        let height = (a * (1.0 - u) + b * u) * (1.0 - v) + (c * (1.0 - u) + d * u) * v;
        let along_x = (b - a) * (1.0 - v) + (d - c) * v;
        let along_y = (c - a) * (1.0 - u) + (d - b) * u;
        (height, (along_x * along_x + along_y * along_y).sqrt())
    }
}

/// Rows as columns; each row has `width` values.
fn turned(z: &[f64], width: usize) -> Vec<f64> {
    let height = z.len() / width;
    (0..z.len()).into_par_iter().map(|k| z[k % height * width + k / height]).collect()
}

/// For each value the best within `reach` places, NaN where there is none: three passes for any reach (van Herk 1992,
/// doi:10.1016/0167-8655(92)90069-C).
fn running(z: &[f64], reach: usize, better: fn(f64, f64) -> f64) -> Vec<f64> {
    let span = 2 * reach + 1;
    let (mut ahead, mut behind) = (z.to_vec(), z.to_vec());
    for k in 1..z.len() {
        if k % span != 0 {
            ahead[k] = better(ahead[k], ahead[k - 1]);
        }
    }
    for k in (0..z.len().saturating_sub(1)).rev() {
        if (k + 1) % span != 0 {
            behind[k] = better(behind[k], behind[k + 1]);
        }
    }
    let end = z.len().saturating_sub(1);
    let one = |k: usize| {
        let (from, to) = (k.saturating_sub(reach), (k + reach).min(end));
        match from / span == to / span {
            // Both ends are in one block, at a border: one of them is the block's own.
            true if from % span == 0 => ahead[to],
            true => behind[from],
            false => better(behind[from], ahead[to]),
        }
    };
    (0..z.len()).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(k: usize) -> f64 {
        f64::from((k as u32).wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24)
    }

    #[test]
    fn running_best_is_that_of_brute_force() {
        for n in [1, 2, 5, 17, 64] {
            let z: Vec<f64> = (0..n).map(|k| if k % 7 == 3 { f64::NAN } else { noise(k) }).collect();
            for reach in [0, 1, 2, 5, 40] {
                for better in [f64::min, f64::max] {
                    let brute = |k: usize| {
                        let some = &z[k.saturating_sub(reach)..(k + reach + 1).min(n)];
                        some.iter().copied().fold(f64::NAN, better)
                    };
                    let found = running(&z, reach, better);
                    for (k, found) in found.iter().enumerate() {
                        let wanted = brute(k);
                        assert!(*found == wanted || found.is_nan() && wanted.is_nan(), "{n} {reach} {k}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_plane_is_filled_as_a_plane() {
        let at = |k: usize| {
            let [x, y] = [k % 40, k / 40].map(|c| c as f64);
            let hole = (10.0..16.0).contains(&x) && (8.0..15.0).contains(&y);
            if hole { f64::NAN } else { 0.1 * x - 0.2 * y }
        };
        let raster =
            Heights { cell: 1.0, low: Vec3::zeros(), size: [40, 30], z: (0..1200).map(at).collect() };
        let filled = raster.filled();
        for k in 0..1200 {
            let [x, y] = [k % 40, k / 40].map(|c| c as f64);
            assert!((filled.z[k] - (0.1 * x - 0.2 * y)).abs() < 0.4, "{x} {y} {}", filled.z[k]);
        }
        let (z, slope) = filled.at(&Vec3::new(30.25, 20.75, 9.0));
        assert!((z - (0.1 * 29.75 - 0.2 * 20.25)).abs() < 1e-12 && (slope - 0.05f64.sqrt()).abs() < 1e-12);
    }
}
