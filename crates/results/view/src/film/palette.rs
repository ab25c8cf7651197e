//! The colours of a film: 255 that fit its pictures best, the same ones on every run.

use crate::{Image, Map};
use color_quant::NeuQuant;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Colours of a film; one more index stands for "as before".
const COLOURS: usize = 255;

/// Bits of each part of a colour that are distinguished.
const BITS: usize = 6;

/// So many of them are steps of the colour map, for the colour bar and the grains.
const STEPS: usize = 64;

/// Of the others, a colour is counted once for each doubling of its share: many dark grains must not take the colours
/// of a few bright ones.
const PER_DOUBLING: usize = 4;

/// The colours of all pictures of a film.
#[derive(Debug, Clone, PartialEq)]
pub struct Palette {
    /// Red, green, blue of each index.
    pub(super) colours: Vec<[u8; 3]>,
    /// The index for each colour of [`BITS`] bits a part.
    nearest: Vec<u8>,
}

impl Palette {
    /// The colours that fit `images`, some pictures of the film: the paper, steps of the `map` they are coloured by, and
    /// for all else a self-organising map (A. H. Dekker 1994, Network: Computation in Neural Systems 5, 351), learnt
    /// in a fixed order.
    pub fn of(images: &[Image], map: Map, paper: [u8; 3]) -> Palette {
        let mut seen: BTreeMap<[u8; 3], usize> = BTreeMap::new();
        for pixel in images.iter().flat_map(|image| image.rgba.chunks_exact(4)) {
            *seen.entry([pixel[0], pixel[1], pixel[2]].map(|c| c >> (8 - BITS))).or_default() += 1;
        }
        let step = |n: usize| map.at(n as f64 / (STEPS - 1) as f64).map(|c| (255.0 * c).round() as u8);
        let mut colours: Vec<[u8; 3]> = [paper].into_iter().chain((0..STEPS).map(step)).collect();
        let lesson = |(bin, count): (&[u8; 3], &usize)| {
            let [r, g, b] = bin.map(middle);
            [r, g, b, 255].repeat(1 + PER_DOUBLING * count.ilog2() as usize)
        };
        let lessons: Vec<u8> = seen.iter().flat_map(lesson).collect();
        if !lessons.is_empty() {
            let learnt = NeuQuant::new(1, COLOURS - colours.len(), &lessons).color_map_rgb();
            colours.extend(learnt.chunks_exact(3).map(|c| [c[0], c[1], c[2]]));
        }
        let nearest = (0..1usize << (3 * BITS)).into_par_iter().map(|bin| closest(&colours, bin)).collect();
        Palette { colours, nearest }
    }

    /// The index of the colour nearest to a pixel.
    pub(super) fn index(&self, pixel: &[u8]) -> u8 {
        let bin = pixel.iter().take(3).fold(0, |bin, &c| bin << BITS | usize::from(c) >> (8 - BITS));
        self.nearest.get(bin).copied().unwrap_or(0)
    }
}

/// The middle of the parts that share their first bits; the brightest stays whole, so that white is white.
fn middle(bits: u8) -> u8 {
    let first = bits << (8 - BITS);
    if usize::from(bits) + 1 == 1 << BITS { 255 } else { first | 1 << (7 - BITS) }
}

fn closest(colours: &[[u8; 3]], bin: usize) -> u8 {
    let part = |n: usize| middle((bin >> (n * BITS)) as u8 & ((1 << BITS) - 1) as u8);
    let wanted = [part(2), part(1), part(0)];
    // Green counts most to the eye, blue least.
    let far = |colour: &[u8; 3]| -> i32 {
        let part = |k: usize| (i32::from(colour[k]) - i32::from(wanted[k])).pow(2);
        3 * part(0) + 6 * part(1) + part(2)
    };
    let found = colours.iter().enumerate().min_by_key(|(n, colour)| (far(colour), *n));
    found.map_or(0, |(n, _)| n as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_stays_white_and_a_colour_seen_comes_back_nearly() {
        let mut image =
            Image { width: 64, height: 64, rgba: vec![255; 64 * 64 * 4], subject: 64, outside: [0; 2] };
        for (n, pixel) in image.rgba.chunks_exact_mut(4).enumerate().take(600) {
            pixel[..3].copy_from_slice(&[(n / 4) as u8, 90, 200 - (n / 4) as u8]);
        }
        let palette = Palette::of(std::slice::from_ref(&image), Map::Viridis, [255; 3]);
        assert_eq!(palette.colours[palette.index(&[255, 255, 255, 255]) as usize], [255; 3]);
        for pixel in image.rgba.chunks_exact(4) {
            let shown = palette.colours[palette.index(pixel) as usize];
            assert!((0..3).all(|k| shown[k].abs_diff(pixel[k]) < 12), "{pixel:?} {shown:?}");
        }
    }
}
