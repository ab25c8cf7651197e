//! A picture as a PNG file, made row by row: what is held is the file, never the whole picture.
//!
//! Each row has the filter after which its bytes, taken as signed, have the least sum (W3C, PNG Specification, Third
//! Edition, 12.7), and the rows are compressed by fdeflate: the bytes that the crate png makes of a whole picture at
//! `Compression::Fast`.

use super::Drawn;
use crate::ViewError;
use fdeflate::Compressor;
use std::io::Write;

/// Bytes of a pixel.
const PIXEL: usize = 3;

/// Up, sub, average, Paeth: the filters in the order in which they are tried, by their numbers in the file.
const FILTERS: [u8; 4] = [2, 1, 3, 4];

/// A picture as a PNG file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Png {
    /// Width and height [pixel].
    pub size: [u32; 2],
    /// Longer side of what is shown, without text and planes [pixel].
    pub subject: u32,
    /// Grains that lie outside, where the camera was placed by the program, and all grains; a clump is one.
    pub outside: [usize; 2],
    /// The compressed rows.
    data: Vec<u8>,
}

impl Png {
    /// Writes the file.
    ///
    /// # Errors
    /// A write that fails, more than 2 GB of compressed rows.
    pub fn write(&self, out: impl Write) -> Result<(), ViewError> {
        let mut encoder = png::Encoder::new(out, self.size[0], self.size[1]);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header().map_err(ViewError::Png)?;
        writer.write_chunk(png::chunk::IDAT, &self.data).map_err(ViewError::Png)?;
        writer.finish().map_err(ViewError::Png)
    }
}

/// The rows of a PNG file in the making.
pub(super) struct Rows {
    size: [u32; 2],
    compressor: Compressor<Vec<u8>>,
    /// The row before, and this one.
    plain: [Vec<u8>; 2],
    /// This row after a filter, which the first byte names: the best so far, and the one that is tried.
    filtered: [Vec<u8>; 2],
}

impl Rows {
    /// Begins a file of a picture of this width and height [pixel].
    pub fn new(size: [u32; 2]) -> Result<Rows, ViewError> {
        let width = size[0] as usize * PIXEL;
        let compressor = Compressor::new(Vec::new()).map_err(|e| ViewError::Png(e.into()))?;
        Ok(Rows {
            size,
            compressor,
            plain: [vec![0; width], vec![0; width]],
            filtered: [vec![0; width + 1], vec![0; width + 1]],
        })
    }

    /// Adds the next rows, four bytes a pixel.
    pub fn add(&mut self, rgba: &[u8]) -> Result<(), ViewError> {
        for row in rgba.chunks_exact(4 * self.size[0] as usize) {
            self.plain.swap(0, 1);
            let pixels = self.plain[1].chunks_exact_mut(PIXEL).zip(row.chunks_exact(4));
            pixels.for_each(|(to, from)| to.copy_from_slice(&from[..PIXEL]));
            let mut least = u64::MAX;
            for filter in FILTERS {
                let cost = filtered(filter, &self.plain, &mut self.filtered[1]);
                if cost <= least {
                    least = cost;
                    self.filtered.swap(0, 1);
                }
                if cost == 0 {
                    break;
                }
            }
            self.compressor.write_data(&self.filtered[0]).map_err(|e| ViewError::Png(e.into()))?;
        }
        Ok(())
    }

    /// The file.
    pub fn finish(self, Drawn { subject, outside }: Drawn) -> Result<Png, ViewError> {
        let data = self.compressor.finish().map_err(|e| ViewError::Png(e.into()))?;
        Ok(Png { size: self.size, subject, outside, data })
    }
}

/// The second of two rows after a filter, and the sum of its bytes, taken as signed.
fn filtered(filter: u8, [before, row]: &[Vec<u8>; 2], out: &mut [u8]) -> u64 {
    out[0] = filter;
    let out = &mut out[1..];
    match filter {
        2 => apply(before, row, out, |_, above, _| above),
        1 => apply(before, row, out, |left, _, _| left),
        3 => apply(before, row, out, |left, above, _| (left & above) + ((left ^ above) >> 1)),
        _ => apply(before, row, out, paeth),
    }
    // 16 bits hold the sum of a part, and processors add many of those at a time.
    let of_part = |part: &[u8]| part.iter().map(|b| u16::from(b.cast_signed().unsigned_abs())).sum::<u16>();
    out.chunks(256).map(|part| u64::from(of_part(part))).sum()
}

/// Subtracts from each byte what is guessed from those to its left, above, and above left.
fn apply(before: &[u8], row: &[u8], out: &mut [u8], guess: impl Fn(u8, u8, u8) -> u8) {
    for k in 0..PIXEL {
        out[k] = row[k].wrapping_sub(guess(0, before[k], 0));
    }
    let left = row.iter().zip(before);
    let rest = out[PIXEL..].iter_mut().zip(row[PIXEL..].iter().zip(&before[PIXEL..]));
    for ((out, (byte, above)), (left, corner)) in rest.zip(left) {
        *out = byte.wrapping_sub(guess(*left, *above, *corner));
    }
}

/// The neighbour that is nearest to left + above − corner; left before above before corner.
fn paeth(left: u8, above: u8, corner: u8) -> u8 {
    let [a, b, c] = [left, above, corner].map(i16::from);
    let [to_left, to_above, to_corner] = [(b - c).abs(), (a - c).abs(), (a + b - 2 * c).abs()];
    if to_left <= to_above && to_left <= to_corner {
        left
    } else if to_above <= to_corner {
        above
    } else {
        corner
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Flat parts, ramps, edges and noise, so that each filter is the best of some row.
    fn picture(width: usize, height: usize) -> Vec<u8> {
        let mut state = 7u32;
        let mut noise = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        let mut rgba = Vec::new();
        for y in 0..height {
            for x in 0..width {
                let value = match y % 12 {
                    0..3 => 255,
                    3..5 => (3 * x) as u8,
                    5..7 => (2 * y + x * x / 40) as u8,
                    7..9 => (20 * (x / 9 + y)) as u8,
                    9 => noise(),
                    _ => 100 + noise() / 16,
                };
                rgba.extend([value, value.wrapping_add(9), value / 2, 255]);
            }
        }
        rgba
    }

    #[test]
    fn a_file_made_row_by_row_has_the_bytes_of_one_made_whole() {
        for [width, height] in [[64, 64], [301, 97], [100, 300]] {
            let rgba = picture(width, height);
            let size = [width as u32, height as u32];
            let mut rows = Rows::new(size).unwrap();
            rgba.chunks(4 * width * 5).for_each(|part| rows.add(part).unwrap());
            let mut own = Vec::new();
            rows.finish(Drawn { subject: 0, outside: [0; 2] }).unwrap().write(&mut own).unwrap();
            let mut whole = Vec::new();
            let mut encoder = png::Encoder::new(&mut whole, size[0], size[1]);
            encoder.set_color(png::ColorType::Rgb);
            encoder.set_compression(png::Compression::Fast);
            let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
            let mut writer = encoder.write_header().unwrap();
            writer.write_image_data(&rgb).unwrap();
            writer.finish().unwrap();
            assert!(own == whole, "{width} x {height}: {} and {} bytes", own.len(), whole.len());
        }
    }
}
