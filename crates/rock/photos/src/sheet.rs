//! A contact sheet: photographs with the outlines of their masks, to check by eye.

use crate::mask::Mask;
use crate::photograph::{Photograph, PhotographError, encode, png};

/// Width of one photograph on the sheet [px].
const WIDTH: usize = 320;
/// Photographs of a row, at least.
const ROW: usize = 6;
/// Width of a sheet of smaller ones [px].
const SHEET: usize = 1960;
/// Between them [px].
const GAP: usize = 6;

/// Digits of 3 × 5 pixels, a row three bits.
const DIGITS: [[u8; 5]; 10] = [
    [7, 5, 5, 5, 7],
    [2, 6, 2, 2, 7],
    [7, 1, 7, 4, 7],
    [7, 1, 3, 1, 7],
    [5, 5, 7, 1, 1],
    [7, 4, 7, 1, 7],
    [7, 4, 7, 5, 7],
    [7, 1, 2, 2, 2],
    [7, 5, 7, 5, 7],
    [7, 5, 7, 1, 7],
];

/// One photograph of a sheet.
#[derive(Debug, Clone)]
pub struct Thumbnail {
    width: usize,
    height: usize,
    pixels: Vec<[u8; 3]>,
}

impl Thumbnail {
    /// A photograph, the background darker, the edge of the mask red.
    pub fn new(photograph: &Photograph, mask: &Mask) -> Thumbnail {
        let (w, h) = (photograph.width, photograph.height);
        let width = WIDTH.min(w);
        let height = (h * width / w).max(1);
        let from = |x: usize, y: usize| {
            [x * w / width, ((x + 1) * w).div_ceil(width), y * h / height, ((y + 1) * h).div_ceil(height)]
        };
        let mut pixels = Vec::with_capacity(width * height);
        for y in 0..height {
            for x in 0..width {
                let [x0, x1, y0, y1] = from(x, y);
                let block = (y0..y1.min(h)).flat_map(|v| (x0..x1.min(w)).map(move |u| v * w + u));
                let (mut light, mut least, mut most, mut n) = (0.0, 255, 0, 0.0);
                for k in block {
                    light += photograph.light[k];
                    (least, most) = (mask.coverage[k].min(least), mask.coverage[k].max(most));
                    n += 1.0;
                }
                let value = encode(light / n);
                pixels.push(match (least > 127, most > 127) {
                    (true, _) => [value; 3],
                    (false, true) => [255, 40, 30],
                    _ => [value / 2; 3],
                });
            }
        }
        Thumbnail { width, height, pixels }
    }

    /// A photograph as it is.
    pub fn plain(photograph: &Photograph) -> Thumbnail {
        let pixels = photograph.light.iter().map(|l| [encode(*l); 3]).collect();
        Thumbnail { width: photograph.width, height: photograph.height, pixels }
    }
}

/// The sheet as PNG: in reading order, numbered from 1; doubtful ones (`warned`) with an orange number.
///
/// # Errors
/// A sheet that is too large for PNG.
pub fn sheet(thumbnails: &[Thumbnail], warned: &[bool]) -> Result<Vec<u8>, PhotographError> {
    let cell = [
        thumbnails.iter().map(|t| t.width).max().unwrap_or(1) + GAP,
        thumbnails.iter().map(|t| t.height).max().unwrap_or(1) + GAP,
    ];
    let columns = ROW.max(SHEET / cell[0]).min(thumbnails.len()).max(1);
    let (width, height) =
        (columns * cell[0] + GAP, thumbnails.len().div_ceil(columns).max(1) * cell[1] + GAP);
    let mut out = vec![[60u8; 3]; width * height];
    for (n, t) in thumbnails.iter().enumerate() {
        let (left, top) = (GAP + n % columns * cell[0], GAP + n / columns * cell[1]);
        for (y, row) in t.pixels.chunks(t.width).enumerate() {
            let start = (top + y) * width + left;
            out[start..start + t.width].copy_from_slice(row);
        }
        let colour = if warned.get(n).copied().unwrap_or(false) { [255, 150, 0] } else { [255; 3] };
        number(&mut out, width, [left + 4, top + 4], n + 1, colour);
    }
    png(width, height, out.as_flattened())
}

/// Draws a number with pixels of 3 × 3.
fn number(out: &mut [[u8; 3]], width: usize, [left, top]: [usize; 2], value: usize, colour: [u8; 3]) {
    for (place, digit) in value.to_string().bytes().enumerate() {
        let rows = DIGITS[usize::from(digit - b'0')];
        for (k, on) in (0..15).map(|k| (k, rows[k / 3] >> (2 - k % 3) & 1 == 1)).filter(|k| k.1) {
            debug_assert!(on);
            let (x, y) = (left + 3 * (4 * place + k % 3), top + 3 * (k / 3));
            for pixel in (0..9).map(|p| (y + p / 3) * width + x + p % 3) {
                if let Some(pixel) = out.get_mut(pixel) {
                    *pixel = colour;
                }
            }
        }
    }
}
