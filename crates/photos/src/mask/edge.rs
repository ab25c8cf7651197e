//! The edge of a region at a fraction of a pixel, in linear light.

use crate::photograph::Photograph;
use crate::raster::Raster;
use rayon::prelude::*;

/// Least half width of the band around the edge [px], and the most that blur makes of it.
const BAND: [f64; 2] = [3.0, 24.0];
/// Least difference of light between stone and background for an edge between pixels [–].
const CONTRAST: f64 = 0.01;

/// One pixel of the band.
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
    let (to_stone, to_rest) = (region.squared_distance(true), region.squared_distance(false));
    let distance = |k: usize| if region.pixels[k] { to_rest[k] } else { to_stone[k] };
    let band = |reach: f64| band(photograph, region, &distance, reach);
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

/// Coverage of the pixels within `reach` of the edge of a region; `distance` is the square of that to the other side [px²].
fn band(
    photograph: &Photograph,
    region: &Raster,
    distance: &(impl Fn(usize) -> u32 + Sync),
    reach: f64,
) -> Vec<Near> {
    let limit = (reach * reach) as u32;
    let pixels: Vec<usize> = (0..region.pixels.len()).filter(|k| distance(*k) <= limit).collect();
    let near = |&pixel: &usize| near(photograph, region, distance, pixel, reach);
    pixels.par_iter().filter_map(near).collect()
}

fn near(
    photograph: &Photograph,
    region: &Raster,
    distance: &impl Fn(usize) -> u32,
    pixel: usize,
    reach: f64,
) -> Option<Near> {
    let (w, h) = (region.width, region.height);
    let (x, y) = (pixel % w, pixel / w);
    let r = (1.4 * reach + 2.0) as usize;
    // Light beyond the blurred part of the edge, on both sides.
    let beyond = (0.8 * reach).powi(2) as u32;
    let (mut sum, mut count) = ([0.0; 2], [0.0; 2]);
    for v in y.saturating_sub(r)..(y + r + 1).min(h) {
        for u in x.saturating_sub(r)..(x + r + 1).min(w) {
            let k = v * w + u;
            if distance(k) > beyond {
                let side = usize::from(region.pixels[k]);
                sum[side] += f64::from(photograph.light[k]);
                count[side] += 1.0;
            }
        }
    }
    let [off, on] = [0, 1].map(|side| sum[side] / count[side]);
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
    Some(Near { pixel, coverage, width })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}
