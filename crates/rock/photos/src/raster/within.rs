//! Which pixels have one of a value nearby.

use super::Raster;
use rayon::prelude::*;

/// Rows that are worked on together.
const ROWS: usize = 32;

/// Largest radius [px].
pub const WIDEST: f64 = 250.0;

/// Distance of each pixel to the nearest one of a value along its row, up to 255 [px].
pub(crate) struct Nearby {
    width: usize,
    height: usize,
    across: Vec<u8>,
}

impl Nearby {
    /// Of the pixels of a value.
    pub fn new(raster: &Raster, value: bool) -> Nearby {
        let (width, height) = (raster.width, raster.height);
        let mut across = vec![0; width * height];
        let rows = across.par_chunks_mut(width).zip(raster.pixels.par_chunks(width));
        rows.for_each(|(to, row)| along(row, value, to));
        Nearby { width, height, across }
    }

    /// Whether a pixel of the value is within `radius` of each pixel [px], at most [`WIDEST`]: its distance along some row nearby is at
    /// most half the chord of the disc there.
    pub fn within(&self, radius: f64) -> Vec<bool> {
        let (w, h) = (self.width, self.height);
        let chords = half_chords(radius);
        let mut near = vec![false; w * h];
        near.par_chunks_mut(ROWS * w).enumerate().for_each(|(n, near)| {
            for (near, y) in near.chunks_mut(w).zip(n * ROWS..) {
                for (off, &half) in chords.iter().enumerate() {
                    let above = y.checked_sub(off);
                    let below = Some(y + off).filter(|below| off > 0 && *below < h);
                    for row in above.into_iter().chain(below) {
                        reach(near, &self.across[row * w..(row + 1) * w], half);
                    }
                }
            }
        });
        near
    }
}

/// Pixels that are at most `half` from one of the value in another row.
fn reach(near: &mut [bool], across: &[u8], half: u8) {
    near.iter_mut().zip(across).for_each(|(near, across)| *near |= *across <= half);
}

/// Half of the chord of a disc at each distance from its middle, in whole pixels.
fn half_chords(radius: f64) -> Vec<u8> {
    let square = radius.min(WIDEST).powi(2);
    let inside = |dx: u32, dy: u32| f64::from(dx * dx + dy * dy) <= square;
    let chord = |dy: u32| (0..=u8::MAX).take_while(|dx| inside(u32::from(*dx), dy)).last();
    (0..).map_while(chord).collect()
}

/// Distance of each pixel to the nearest one of a value along its row [px].
fn along(row: &[bool], value: bool, to: &mut [u8]) {
    let mut last = u8::MAX;
    for (to, pixel) in to.iter_mut().zip(row) {
        last = if *pixel == value { 0 } else { last.saturating_add(1) };
        *to = last;
    }
    last = u8::MAX;
    for to in to.iter_mut().rev() {
        last = last.saturating_add(1).min(*to);
        *to = last;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_a_look_at_every_pixel_says() {
        let mut seed = 12345u32;
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            seed >> 8
        };
        for (w, h) in [(1, 9), (9, 1), (23, 17), (40, 31)] {
            let pixels: Vec<bool> = (0..w * h).map(|_| next() % 79 == 0).collect();
            let raster = Raster { width: w, height: h, pixels };
            for radius in [0.0, 1.0, 1.5, 5.0, 7.3, 100.0] {
                let found = Nearby::new(&raster, true).within(radius);
                for (k, found) in found.into_iter().enumerate() {
                    let square = |j: usize| (k % w).abs_diff(j % w).pow(2) + (k / w).abs_diff(j / w).pow(2);
                    let mut near = (0..w * h).filter(|j| raster.pixels[*j]).map(square);
                    let wanted = near.any(|d| d as f64 <= radius * radius);
                    assert_eq!(found, wanted, "{w} × {h}, {radius}, {k}");
                }
            }
        }
    }
}
