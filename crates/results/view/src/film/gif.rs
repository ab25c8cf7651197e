//! A film as GIF: it plays for ever; of each picture only what changed is stored.

use super::Palette;
use crate::{Image, ViewError};
use gif::{DisposalMethod, Encoder, Frame, Repeat};
use std::{borrow::Cow, io::Write};

/// The index that stands for "as before".
const SAME: u8 = 255;

/// A GIF in the making.
pub struct Gif<W: Write> {
    encoder: Encoder<W>,
    palette: Palette,
    /// Time a picture is shown [1/100 s].
    delay: u16,
    size: [u16; 2],
    /// What is seen before the next picture.
    shown: Vec<u8>,
}

impl<W: Write> Gif<W> {
    /// Begins a film of pictures of `width` x `height` pixels, each shown for `delay` hundredths of a second.
    ///
    /// # Errors
    /// Pictures larger than a GIF can be; a write that fails.
    pub fn new(out: W, [width, height]: [u32; 2], palette: Palette, delay: u16) -> Result<Gif<W>, ViewError> {
        let [Ok(w), Ok(h)] = [width, height].map(u16::try_from) else {
            return Err(ViewError::Size { width, height });
        };
        let mut colours: Vec<u8> = palette.colours.iter().flatten().copied().collect();
        colours.resize(3 * 256, 0);
        let mut encoder = Encoder::new(out, w, h, &colours).map_err(ViewError::Gif)?;
        encoder.set_repeat(Repeat::Infinite).map_err(ViewError::Gif)?;
        Ok(Gif { encoder, palette, delay, size: [w, h], shown: Vec::new() })
    }

    /// Adds a picture.
    ///
    /// # Errors
    /// A picture of another size; a write that fails.
    pub fn add(&mut self, image: &Image) -> Result<(), ViewError> {
        let [w, h] = self.size.map(u32::from);
        if [image.width, image.height] != [w, h] {
            return Err(ViewError::Size { width: image.width, height: image.height });
        }
        let indices: Vec<u8> = image.rgba.chunks_exact(4).map(|p| self.palette.index(p)).collect();
        let [left, top, right, bottom] = self.changed(&indices);
        let width = usize::from(self.size[0]);
        let row = |y: usize| y * width + left..y * width + right;
        let mut buffer = Vec::with_capacity((right - left) * (bottom - top));
        for y in top..bottom {
            let before = self.shown.get(row(y));
            buffer.extend(indices[row(y)].iter().enumerate().map(|(n, &new)| {
                let same = before.is_some_and(|b| b[n] == new);
                if same { SAME } else { new }
            }));
        }
        let frame = Frame {
            delay: self.delay,
            dispose: DisposalMethod::Keep,
            transparent: Some(SAME),
            left: left as u16,
            top: top as u16,
            width: (right - left) as u16,
            height: (bottom - top) as u16,
            buffer: Cow::Owned(buffer),
            ..Frame::default()
        };
        self.encoder.write_frame(&frame).map_err(ViewError::Gif)?;
        self.shown = indices;
        Ok(())
    }

    /// Ends the film.
    ///
    /// # Errors
    /// A write that fails.
    pub fn finish(self) -> Result<W, ViewError> {
        self.encoder.into_inner().map_err(ViewError::Gif)
    }

    /// Left, top, right, bottom of what differs from what is shown; at least one pixel.
    fn changed(&self, new: &[u8]) -> [usize; 4] {
        let [w, h] = self.size.map(usize::from);
        if self.shown.is_empty() {
            return [0, 0, w, h];
        }
        let differs = |at: usize| new[at] != self.shown[at];
        let mut places = (0..w * h).filter(|&at| differs(at)).map(|at| [at % w, at / w]);
        let Some([x, y]) = places.next() else { return [0, 0, 1, 1] };
        let grow =
            |[l, t, r, b]: [usize; 4], [x, y]: [usize; 2]| [l.min(x), t.min(y), r.max(x + 1), b.max(y + 1)];
        places.fold([x, y, x + 1, y + 1], grow)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(dot: usize) -> Image {
        let mut rgba = vec![255; 64 * 64 * 4];
        for y in 10..14 {
            for x in dot..dot + 4 {
                rgba[4 * (y * 64 + x)..][..3].copy_from_slice(&[200, 40, 40]);
            }
        }
        Image { width: 64, height: 64, rgba, subject: 64, outside: [0; 2] }
    }

    fn film() -> Vec<u8> {
        let pictures = [picture(5), picture(20), picture(20)];
        let mut gif =
            Gif::new(Vec::new(), [64, 64], Palette::of(&pictures, crate::Map::Viridis, [255; 3]), 4)
                .expect("begun");
        pictures.iter().for_each(|p| gif.add(p).expect("added"));
        gif.finish().expect("ended")
    }

    #[test]
    fn pictures_laid_over_each_other_show_what_was_drawn() {
        let bytes = film();
        let mut decoder = gif::DecodeOptions::new().read_info(&bytes[..]).expect("a GIF");
        let palette: Vec<u8> = decoder.global_palette().expect("one").to_vec();
        let mut screen = vec![0u8; 64 * 64];
        let mut frames = 0;
        while let Some(frame) = decoder.read_next_frame().expect("whole") {
            let (w, at) = (usize::from(frame.width), [usize::from(frame.left), usize::from(frame.top)]);
            for (n, &index) in frame.buffer.iter().enumerate().filter(|(_, i)| **i != SAME) {
                screen[(at[1] + n / w) * 64 + at[0] + n % w] = index;
            }
            assert_eq!(frame.delay, 4);
            let dot = [5, 20, 20][frames];
            for (n, &index) in screen.iter().enumerate() {
                let inside = (dot..dot + 4).contains(&(n % 64)) && (10..14).contains(&(n / 64));
                let red = palette[3 * usize::from(index) + 1] < 100;
                assert_eq!(red, inside, "frame {frames}, pixel {n}");
            }
            frames += 1;
        }
        assert_eq!(frames, 3);
    }

    #[test]
    fn the_same_film_is_the_same_bytes() {
        assert_eq!(film(), film());
    }
}
