//! The edge of a region at a fraction of a pixel, in linear light.

use super::beside::{Beside, Sums};
use super::median;
use crate::photograph::Photograph;
use crate::raster::{Nearby, Raster};
use rayon::prelude::*;
use std::ops::Range;

/// Least half width of the band around the edge [px], and the most that blur makes of it.
const BAND: [f64; 2] = [3.0, 24.0];
/// Least difference of light between stone and background for an edge between pixels [–].
const CONTRAST: f64 = 0.01;

/// Rows that are worked on together.
const STRIP: usize = 128;

/// One pixel of the band.
#[derive(Clone)]
struct Near {
    pixel: usize,
    /// Share that the stone covers [–].
    coverage: f64,
    /// Difference of the light of both sides over the slope [px]; none where the pixel is not on the edge.
    width: Option<f64>,
}

/// Coverage of each pixel, 0–255, and the width of the edge [px].
pub(super) fn soft(photograph: &Photograph, region: &Raster) -> (Vec<u8>, f64) {
    let width = |near: &[Near]| median(near.iter().filter_map(|n| n.width).collect());
    let nearby = [false, true].map(|value| Nearby::new(region, value));
    let edge = |reach: f64| {
        let [rest, stone] = [0, 1].map(|side| nearby[side].within(reach));
        region.like(rest.into_iter().zip(stone).map(|(rest, stone)| rest && stone).collect())
    };
    let band = |reach: f64| band(photograph, region, &edge, reach);
    let (mut near, mut reach) = (band(BAND[0]), BAND[0]);
    // A blurred edge is wider than the first band, and then its sides are farther apart.
    for _ in 0..3 {
        let wanted = (0.8 * width(&near)).clamp(BAND[0], BAND[1]);
        if wanted < 1.2 * reach {
            break;
        }
        (near, reach) = (band(wanted), wanted);
    }
    let width = width(&near);
    let mut coverage: Vec<u8> = region.pixels.iter().map(|p| if *p { 255 } else { 0 }).collect();
    near.iter().for_each(|n| coverage[n.pixel] = (255.0 * n.coverage).round() as u8);
    // What the softer edge has split off.
    let soft = Raster { pixels: coverage.iter().map(|c| *c > 127).collect(), ..region.clone() };
    let kept = soft.largest().0.filled();
    let beside = kept.grown(1.5);
    for (k, c) in coverage.iter_mut().enumerate() {
        if kept.pixels[k] {
            *c = (*c).max(128);
        } else {
            *c = if beside.pixels[k] { (*c).min(127) } else { 0 };
        }
    }
    (coverage, width)
}

/// Coverage of the pixels within `reach` of the edge of a region; `edge` gives the pixels so near to it.
fn band(photograph: &Photograph, region: &Raster, edge: &impl Fn(f64) -> Raster, reach: f64) -> Vec<Near> {
    // Light beyond the blurred part of the edge, on both sides.
    let (edge, blurred) = (edge(reach), edge(0.8 * reach));
    let beside = Beside { photograph, region, blurred: &blurred, reach: (1.4 * reach + 2.0) as usize };
    let rows = edge.rows();
    let strips: Vec<Vec<Near>> = rows
        .step_by(STRIP)
        .collect::<Vec<usize>>()
        .into_par_iter()
        .map(|first| strip(&beside, &edge, first..(first + STRIP).min(region.height)))
        .collect();
    strips.concat()
}

/// The band in some rows.
fn strip(beside: &Beside, edge: &Raster, rows: Range<usize>) -> Vec<Near> {
    let w = edge.width;
    let mut near = Vec::new();
    let mut sums: Option<Sums> = None;
    for y in rows {
        let row = &edge.pixels[y * w..(y + 1) * w];
        let Some(first) = row.iter().position(|p| *p) else { continue };
        let last = row.iter().rposition(|p| *p).unwrap_or(first);
        let sums = sums.get_or_insert_with(|| beside.sums());
        beside.go_to(sums, y);
        let mut window = beside.window(sums, first);
        for (x, _) in row.iter().enumerate().take(last + 1).skip(first).filter(|(_, p)| **p) {
            beside.slide(sums, &mut window, x);
            near.extend(of_pixel(beside.photograph, [x, y], window.means()));
        }
    }
    near
}

/// A pixel, by the means of the light off and on the stone around it; none where they hardly differ, or one side is not near.
fn of_pixel(photograph: &Photograph, [x, y]: [usize; 2], [off, on]: [f64; 2]) -> Option<Near> {
    let (w, h) = (photograph.width, photograph.height);
    // NaN when one side is not near.
    if !((on - off).abs() > CONTRAST) {
        return None;
    }
    let light = |x: usize, y: usize| f64::from(photograph.light[y * w + x]);
    let coverage = ((light(x, y) - off) / (on - off)).clamp(0.0, 1.0);
    let edge = (0.25..0.75).contains(&coverage) && x > 0 && y > 0 && x + 1 < w && y + 1 < h;
    let width = edge.then(|| {
        let slope = [light(x + 1, y) - light(x - 1, y), light(x, y + 1) - light(x, y - 1)];
        2.0 * (on - off).abs() / slope[0].hypot(slope[1]).max(1e-9)
    });
    Some(Near { pixel: y * w + x, coverage, width })
}
