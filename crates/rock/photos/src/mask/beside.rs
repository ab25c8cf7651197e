//! Means of the light around a pixel, on the stone and off it, beyond the blurred part of the edge.
//!
//! The square around a pixel slides along its row, and the sums of its columns from row to row. They are whole numbers, so that what
//! leaves is exactly what came in, and sums do not depend on where they began.

use crate::photograph::Photograph;
use crate::raster::Raster;
use std::ops::Range;

/// One pixel in a sum, whose lower bits are of its light.
const ONE: u64 = 1 << 40;
/// A light of 1 in a sum: squares of 71 × 71 pixels stay below [`ONE`].
const LIGHT: f32 = (1u64 << 24) as f32;

/// Where light is summed.
pub(super) struct Beside<'a> {
    pub photograph: &'a Photograph,
    pub region: &'a Raster,
    /// What is too near to the edge.
    pub blurred: &'a Raster,
    /// Half the side of the square [px].
    pub reach: usize,
}

/// Sums over the columns of a square, off the stone and on it.
pub(super) struct Sums {
    columns: Vec<[u64; 2]>,
    /// Rows that are in them.
    rows: Range<usize>,
}

/// Sums over the square around a pixel.
pub(super) struct Window {
    sums: [u64; 2],
    /// Columns that are in them.
    columns: Range<usize>,
}

impl Beside<'_> {
    /// Of no rows.
    pub fn sums(&self) -> Sums {
        Sums { columns: vec![[0; 2]; self.region.width], rows: 0..0 }
    }

    /// From `reach` before a place to `reach` behind it, within a size.
    fn around(&self, at: usize, size: usize) -> Range<usize> {
        at.saturating_sub(self.reach)..(at + self.reach + 1).min(size)
    }

    /// Has the columns sum up the rows around `y`, which is below the row before.
    pub fn go_to(&self, sums: &mut Sums, y: usize) {
        let rows = self.around(y, self.region.height);
        let fresh = sums.rows.end.max(rows.start);
        if fresh > sums.rows.end {
            sums.columns.fill([0; 2]);
        } else {
            (sums.rows.start..rows.start).for_each(|y| self.add(sums, y, u64::wrapping_sub));
        }
        (fresh..rows.end).for_each(|y| self.add(sums, y, u64::wrapping_add));
        sums.rows = rows;
    }

    fn add(&self, sums: &mut Sums, y: usize, with: impl Fn(u64, u64) -> u64) {
        let row = y * self.region.width..(y + 1) * self.region.width;
        let pixels = self.region.pixels[row.clone()].iter().zip(&self.blurred.pixels[row.clone()]);
        let lights = &self.photograph.light[row];
        for (column, ((is_stone, is_blurred), light)) in sums.columns.iter_mut().zip(pixels.zip(lights)) {
            let value = if *is_blurred { 0 } else { ONE + (light.clamp(0.0, 1.0) * LIGHT) as u64 };
            let [off, on] = if *is_stone { [0, value] } else { [value, 0] };
            *column = [with(column[0], off), with(column[1], on)];
        }
    }

    /// Around the pixel of a column.
    pub fn window(&self, sums: &Sums, x: usize) -> Window {
        let columns = self.around(x, sums.columns.len());
        let sum = |side: usize| sums.columns[columns.clone()].iter().map(|c| c[side]).sum();
        Window { sums: [sum(0), sum(1)], columns }
    }

    /// On to the pixel of a later column.
    pub fn slide(&self, sums: &Sums, window: &mut Window, x: usize) {
        let columns = self.around(x, sums.columns.len());
        for side in 0..2 {
            let sum = |columns: Range<usize>| -> u64 { sums.columns[columns].iter().map(|c| c[side]).sum() };
            let kept = window.columns.end.max(columns.start);
            if kept > window.columns.end {
                window.sums[side] = sum(columns.clone());
            } else {
                window.sums[side] += sum(kept..columns.end);
                window.sums[side] -= sum(window.columns.start..columns.start);
            }
        }
        window.columns = columns;
    }
}

impl Window {
    /// Mean light off the stone and on it; NaN where there is none.
    pub fn means(&self) -> [f64; 2] {
        self.sums.map(|sum| (sum % ONE) as f64 / f64::from(LIGHT) / (sum / ONE) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_a_look_at_every_pixel_says() {
        let (w, h) = (31, 29);
        let shade = |k: usize| (k * 7919 % 256) as f32 / 256.0;
        let photograph = Photograph { width: w, height: h, light: (0..w * h).map(shade).collect() };
        let raster =
            |of: &dyn Fn(usize) -> bool| Raster { width: w, height: h, pixels: (0..w * h).map(of).collect() };
        let region = raster(&|k| (k % w + k / w) % 23 > 9);
        let blurred = raster(&|k| k * 31 % 5 == 0);
        let beside = Beside { photograph: &photograph, region: &region, blurred: &blurred, reach: 3 };
        let mut sums = beside.sums();
        for y in [0, 1, 2, 9, 10, 17, 28] {
            beside.go_to(&mut sums, y);
            let mut window = beside.window(&sums, 0);
            for x in [0, 1, 2, 5, 12, 13, 29, 30] {
                beside.slide(&sums, &mut window, x);
                let near =
                    |k: &usize| (k % w).abs_diff(x) <= 3 && (k / w).abs_diff(y) <= 3 && !blurred.pixels[*k];
                let wanted = [false, true].map(|side| {
                    let lights = (0..w * h).filter(near).filter(|k| region.pixels[*k] == side).map(shade);
                    let (sum, n) = lights.fold((0.0, 0.0), |(sum, n), l| (sum + f64::from(l), n + 1.0));
                    sum / n
                });
                let found = window.means();
                for (found, wanted) in found.into_iter().zip(wanted) {
                    let agree = (found - wanted).abs() < 1e-12 || found.is_nan() && wanted.is_nan();
                    assert!(agree, "{x}, {y}: {found}, {wanted}");
                }
            }
        }
    }
}
