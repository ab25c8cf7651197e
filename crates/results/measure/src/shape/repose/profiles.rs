//! Median heights of a surface over bins of distance, in sectors or lanes.

use super::HeapSurface;
use crate::shape::sector::sector;
use crate::statistics::median;
use std::f64::consts::PI;

/// Place of each part, and distance and height [m] of its bins.
pub(super) type Profiles = Vec<(f64, Vec<[f64; 2]>)>;

/// Around the axis: where that is, and the profile of each sector with its azimuth [rad].
pub(super) fn sectors(surface: &HeapSurface, count: usize, bin: f64) -> ([f64; 2], Profiles) {
    let middle = surface.middle();
    let turn = 2.0 * PI / count as f64;
    let of = |[x, y, _]: [f64; 3]| {
        let (x, y) = (x - middle[0], y - middle[1]);
        (sector([x, y], count), (x * x + y * y).sqrt())
    };
    (middle, profiles(surface, count, bin, of, |k| (k as f64 + 0.5) * turn))
}

/// Away from the wall: where that and the middle are, and the profile of each lane with its place across [m].
pub(super) fn lanes(surface: &HeapSurface, count: usize, bin: f64) -> ([f64; 2], Profiles) {
    let (low, rays) = surface.grid;
    let width = rays[1] as f64 * surface.step / count as f64;
    let of = |[x, y, _]: [f64; 3]| ((((y - low[1]) / width) as usize).min(count - 1), x - low[0]);
    let middle = low[1] + 0.5 * width * count as f64;
    ([low[0], middle], profiles(surface, count, bin, of, |k| low[1] + (k as f64 + 0.5) * width))
}

/// Median heights of the bins of each part; `of` gives a point's part and distance.
fn profiles(
    surface: &HeapSurface,
    count: usize,
    bin: f64,
    of: impl Fn([f64; 3]) -> (usize, f64),
    place: impl Fn(usize) -> f64,
) -> Profiles {
    let mut bins: Vec<Vec<(Vec<f64>, Vec<f64>)>> = vec![Vec::new(); count];
    let mut put = |point: [f64; 3], height: f64| {
        let (part, distance) = of(point);
        let bins = &mut bins[part];
        let k = (distance / bin) as usize;
        if bins.len() <= k {
            bins.resize(k + 1, Default::default());
        }
        bins[k].0.push(distance);
        bins[k].1.push(height);
    };
    let (low, rays) = surface.grid;
    let mut covered = vec![false; rays[0] * rays[1]];
    for p in &surface.points {
        let [i, j] = [0, 1].map(|k| libm::round((p[k] - low[k]) / surface.step) as usize);
        covered[j * rays[0] + i] = true;
        put(*p, (p[2] - surface.ground).max(0.0));
    }
    for (k, _) in covered.iter().enumerate().filter(|(_, covered)| !**covered) {
        let [i, j] = [k % rays[0], k / rays[0]].map(|n| n as f64);
        put([low[0] + i * surface.step, low[1] + j * surface.step, 0.0], 0.0);
    }
    let middle = |(mut at, mut heights): (Vec<f64>, Vec<f64>)| [median(&mut at), median(&mut heights)];
    let filled = |bins: Vec<(Vec<f64>, Vec<f64>)>| {
        bins.into_iter().filter(|b| !b.0.is_empty()).map(middle).collect::<Vec<_>>()
    };
    bins.into_iter().enumerate().map(|(k, bins)| (place(k), filled(bins))).collect()
}
