//! A photograph → which share of each pixel the stone covers.
//!
//! ```text
//! region    values above (or below) Otsu's level → opened, closed → the largest region, without holes
//! coverage  near its edge  (l − B)/(F − B),  l light of the pixel, F and B means of the light on the stone and off it nearby
//! ```
//!
//! The level only decides what is stone. The edge is where the light is half way between both sides, wherever the stone is lit more or less.

mod beside;
mod edge;
mod warning;

use crate::photograph::Photograph;
use crate::raster::Raster;
use crate::threshold::otsu;
use serde::{Deserialize, Serialize};

pub use warning::{MaskWarning, among};

/// Whether the stone is brighter than what is behind it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Polarity {
    /// The stone is bright.
    Bright,
    /// The stone is dark.
    Dark,
}

/// How a mask is found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Default)]
pub struct MaskSettings {
    /// Stone bright or dark; none: what most of the frame is not.
    pub polarity: Option<Polarity>,
    /// Stored value between stone and background, 0–255; none: Otsu's.
    pub level: Option<u8>,
    /// Narrower than about twice this is no stone [px]; none: from the size of the photograph.
    pub open: Option<f64>,
    /// Gaps narrower than about twice this are stone [px]; none: as `open`.
    pub close: Option<f64>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Mask {
    /// Pixels of a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Share of each pixel that is stone, 0–255.
    pub coverage: Vec<u8>,
    /// What was found on the way; none for a given mask.
    pub found: Option<Found>,
}

/// What was found on the way to a mask.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// Stored value between stone and background, 0–255.
    pub level: u8,
    /// Stone bright or dark.
    pub polarity: Polarity,
    /// Share of the variance between the two classes, 0 to 1 [–].
    pub separation: f64,
    /// Width of the edge from stone to background [px]; 0 when there is no edge.
    pub edge_width: f64,
    /// Pixels of other regions that were left out.
    pub left_out: usize,
    /// Share of the frame that is of the class of the stone [–].
    pub frame: f64,
}

impl Mask {
    /// A mask from elsewhere: grey values 0–255.
    pub fn given(width: usize, height: usize, coverage: Vec<u8>) -> Mask {
        Mask { width, height, coverage, found: None }
    }

    /// Pixels that are stone by half or more.
    pub fn raster(&self) -> Raster {
        let pixels = self.coverage.iter().map(|c| *c > 127).collect();
        Raster { width: self.width, height: self.height, pixels }
    }

    /// First and last column and row of the stone: x₀, y₀, x₁, y₁ [px]; none when empty.
    pub fn bounds(&self) -> Option<[usize; 4]> {
        let stone = (0..self.coverage.len()).filter(|k| self.coverage[*k] > 127);
        stone.map(|k| (k % self.width, k / self.width)).fold(None, |b: Option<[usize; 4]>, (x, y)| {
            let [x0, y0, x1, y1] = b.unwrap_or([x, y, x, y]);
            Some([x0.min(x), y0.min(y), x1.max(x), y1.max(y)])
        })
    }

    /// Area of the stone [px²].
    pub fn area(&self) -> f64 {
        self.coverage.iter().map(|c| f64::from(*c)).sum::<f64>() / 255.0
    }

    /// Pixels of the stone on the frame.
    pub fn on_frame(&self) -> usize {
        self.raster().on_frame()
    }
}

/// Finds the mask of a photograph; an empty one when nothing stands out.
pub fn find_mask(photograph: &Photograph, settings: &MaskSettings) -> Mask {
    let (width, height) = (photograph.width, photograph.height);
    let values = photograph.encoded();
    let split = otsu(&values);
    let level = settings.level.or(split.map(|s| s.level)).unwrap_or(127);
    let bright = Raster { width, height, pixels: values.iter().map(|v| *v > level).collect() };
    let frame = bright.frame().count() as f64;
    let bright_frame = bright.on_frame() as f64 / frame;
    let by_frame = if bright_frame < 0.5 { Polarity::Bright } else { Polarity::Dark };
    let polarity = settings.polarity.unwrap_or(by_frame);
    let stone = match polarity {
        Polarity::Bright => bright,
        Polarity::Dark => Raster { pixels: bright.pixels.iter().map(|p| !p).collect(), ..bright },
    };
    let open = settings.open.unwrap_or_else(|| radius(width, height));
    let close = settings.close.unwrap_or(open);
    // Cracks close first: a stone of pieces would fall apart when it is opened.
    let (region, left_out) = stone.closed(close).filled().opened(open).largest();
    let region = if split.is_some() {
        region.filled()
    } else {
        Raster { pixels: vec![false; width * height], ..region }
    };
    let (coverage, edge_width) = edge::soft(photograph, &region);
    let on_frame = if polarity == Polarity::Bright { bright_frame } else { 1.0 - bright_frame };
    let separation = split.map_or(0.0, |s| s.separation);
    let found = Found { level, polarity, separation, edge_width, left_out, frame: on_frame };
    Mask { width, height, coverage, found: Some(found) }
}

/// A thousandth of the diagonal [px], and at least 1.
fn radius(width: usize, height: usize) -> f64 {
    ((width as f64).hypot(height as f64) / 1000.0).round().max(1.0)
}

/// The middle one of some values; 0 of none.
pub(crate) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
