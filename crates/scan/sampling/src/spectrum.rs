//! Radial power spectrum and anisotropy of points on a surface.
//!
//! ```text
//! P(k) = | Σⱼ wⱼ e^{−i k·xⱼ} − W(k) |² / Σⱼ wⱼ²        wⱼ = exp(−|xⱼ|²/2σ²),   W(k) = (Σⱼ wⱼ) exp(−|k|²σ²/2)
//! ```
//!
//! A direct sum over round patches: around points spread over the cloud (10 spacings apart), the points within 3 σ are laid
//! onto their plane of least squares (at their distance in space from the patch's centre), scaled by the patch's own mean spacing s = √(area per point), and summed against
//! 24 wave directions and 64 wave numbers ν = |k| s/2π. Directions start from one axis of the cloud (its longest), laid into
//! each plane, so that rows that follow the cloud add up. W removes the window's own transform. P → 1 for random points;
//! blue noise is ≪ 1 below ν = 1 and has no sharp peak. (Ulichney 1988, doi:10.1109/5.3288; Lagae & Dutré 2008,
//! doi:10.1111/j.1467-8659.2007.01100.x, on the plane; here patch by patch.)
//!
//! Anisotropy at ν: the variance over directions of the power, over its mean squared, times the number of
//! patches: 1 when directions differ only by random scatter (the −10 dB of Ulichney for ten patches), and large for rows.

use crate::cells::Cells;
use crate::poisson::poisson;
use geom::{Grid, PrincipalAxes, Vec3};
use rayon::prelude::*;
use serde::Serialize;

const PATCHES: usize = 96;
const DIRECTIONS: usize = 24;
const WAVES: usize = 64;
/// Widest wave number, in waves per mean spacing.
const HIGHEST: f64 = 3.2;
/// σ of the window in mean spacings; the patch ends at 3 σ.
const SIGMA: f64 = 4.0;
const PATCH: f64 = 3.0;
/// A patch counts when its middle is its centre within this many σ, else the border of the sheet runs through it.
const OFF_CENTRE: f64 = 0.2;

/// Radial power spectrum, averaged over patches and directions.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Spectrum {
    /// Wave numbers, in waves per mean spacing √(area per point) [–].
    pub wave_number: Vec<f64>,
    /// Power; 1 for random points [–].
    pub power: Vec<f64>,
    /// Anisotropy; 1 when directions differ only by random scatter [–].
    pub anisotropy: Vec<f64>,
    /// Patches in the average.
    pub patches: usize,
}

impl Spectrum {
    /// Highest power and where it is, above ν = 0.5 [–].
    pub fn peak(&self) -> (f64, f64) {
        let pairs =
            self.wave_number.iter().copied().zip(self.power.iter().copied()).filter(|(v, _)| *v > 0.5);
        pairs.fold((0.0, 0.0), |best, (v, p)| if p > best.1 { (v, p) } else { best })
    }

    /// Mean power below ν = 0.5 [–]: what unevenness of large extent is left.
    pub fn low(&self) -> f64 {
        let low: Vec<f64> =
            self.wave_number.iter().zip(&self.power).filter(|(v, _)| **v < 0.5).map(|(_, p)| *p).collect();
        low.iter().sum::<f64>() / low.len().max(1) as f64
    }

    /// Mean anisotropy over all wave numbers from ν = 0.5 [–].
    pub fn mean_anisotropy(&self) -> f64 {
        let high: Vec<f64> = self
            .wave_number
            .iter()
            .zip(&self.anisotropy)
            .filter(|(v, _)| **v > 0.5)
            .map(|(_, a)| *a)
            .collect();
        high.iter().sum::<f64>() / high.len().max(1) as f64
    }
}

/// The spectrum of points [m] whose nearest distance is about `spacing` [m]; `None` where no patch of a sheet is found.
pub fn spectrum(points: &[Vec3], spacing: f64) -> Option<Spectrum> {
    if points.len() < 100 || !(spacing > 0.0 && spacing.is_finite()) {
        return None;
    }
    let reach = 1.5 * PATCH * SIGMA * spacing;
    let grid = Grid::new(points, reach);
    let axis = longest_axis(points);
    let centres = centres(points, spacing);
    let patches: Vec<Vec<f64>> = centres
        .par_iter()
        .filter_map(|&c| patch_power(points, &grid, points[c as usize], reach, axis))
        .collect();
    if patches.is_empty() {
        return None;
    }
    Some(average(&patches))
}

/// Centres of patches, spread over the cloud, far enough apart that patches share little and scatter independently.
fn centres(points: &[Vec3], spacing: f64) -> Vec<u32> {
    let apart = 2.5 * SIGMA * spacing;
    let all = poisson(&Cells::new(points, apart), apart, 0, None);
    all.iter().copied().step_by(all.len().div_ceil(2 * PATCHES)).collect()
}

/// Power of one patch for each direction and wave number.
fn patch_power(points: &[Vec3], grid: &Grid, centre: Vec3, reach: f64, axis: Vec3) -> Option<Vec<f64>> {
    let near: Vec<Vec3> = grid.within(points, centre, reach).map(|i| points[i as usize] - centre).collect();
    if near.len() < 60 {
        return None;
    }
    let [u, v, normal] = plane(&near, axis)?;
    // The sheet alone: points off the plane by more than a sixth of the reach lie on another one, or on a bend.
    let flat: Vec<[f64; 2]> =
        near.iter().filter(|p| p.dot(&normal).abs() < reach / 6.0).map(|p| unroll(p, &u, &v)).collect();
    let spacing = mean_spacing(&flat, reach);
    let scale = 1.0 / spacing;
    let sigma = (reach * scale / PATCH).min(SIGMA);
    let mut placed: Vec<([f64; 2], f64)> = Vec::with_capacity(flat.len());
    for p in &flat {
        let x = [p[0] * scale, p[1] * scale];
        let off = (x[0] * x[0] + x[1] * x[1]) / (sigma * sigma);
        if off < PATCH * PATCH {
            placed.push((x, libm::exp(-0.5 * off)));
        }
    }
    let total: f64 = placed.iter().map(|(_, w)| w).sum();
    let middle = placed.iter().fold([0.0; 2], |m, (x, w)| [m[0] + w * x[0] / total, m[1] + w * x[1] / total]);
    let off_centre = (middle[0] * middle[0] + middle[1] * middle[1]).sqrt();
    if placed.len() < 60 || off_centre > OFF_CENTRE * sigma {
        return None;
    }
    let squares: f64 = placed.iter().map(|(_, w)| w * w).sum();
    Some(
        (0..DIRECTIONS)
            .flat_map(|d| direction_power(&placed, d, total, sigma).map(move |p| p / squares))
            .collect(),
    )
}

/// |sum|² at each wave number along one direction; the phase of the next wave number is the last one turned on.
fn direction_power(
    placed: &[([f64; 2], f64)],
    direction: usize,
    total: f64,
    sigma: f64,
) -> impl Iterator<Item = f64> {
    let angle = std::f64::consts::PI * direction as f64 / DIRECTIONS as f64;
    let (sin, cos) = libm::sincos(angle);
    let step = 2.0 * std::f64::consts::PI * HIGHEST / WAVES as f64;
    let mut sums = [(0.0, 0.0); WAVES];
    for (x, w) in placed {
        let (s, c) = libm::sincos(step * (x[0] * cos + x[1] * sin));
        let (mut re, mut im) = (*w, 0.0);
        for sum in &mut sums {
            (re, im) = (re * c - im * s, re * s + im * c);
            sum.0 += re;
            sum.1 += im;
        }
    }
    sums.into_iter().enumerate().map(move |(n, (re, im))| {
        let k = step * (n + 1) as f64 * sigma;
        let re = re - total * libm::exp(-0.5 * k * k);
        re * re + im * im
    })
}

/// Coordinates in the plane, at the distance that the point has in space: a bent sheet is laid flat, not foreshortened.
fn unroll(p: &Vec3, u: &Vec3, v: &Vec3) -> [f64; 2] {
    let flat = [p.dot(u), p.dot(v)];
    let length = (flat[0] * flat[0] + flat[1] * flat[1]).sqrt();
    let stretch = if length > 0.0 { p.norm() / length } else { 1.0 };
    flat.map(|x| x * stretch)
}

/// Two axes in the plane of least squares, the first along `axis` where it can be, and the normal.
fn plane(near: &[Vec3], axis: Vec3) -> Option<[Vec3; 3]> {
    let normal = PrincipalAxes::of(near.iter()).normal();
    let along = axis - normal * axis.dot(&normal);
    if along.norm() < 0.2 {
        return None;
    }
    let u = along.normalize();
    Some([u, normal.cross(&u), normal])
}

fn longest_axis(points: &[Vec3]) -> Vec3 {
    let (lo, hi) = geom::grid::bounds(points);
    let mut axis = Vec3::zeros();
    axis[(hi - lo).imax()] = 1.0;
    axis
}

/// √(area per point) in the middle of the patch [m].
fn mean_spacing(flat: &[[f64; 2]], reach: f64) -> f64 {
    let disk = 0.6 * reach;
    let inside = flat.iter().filter(|p| p[0] * p[0] + p[1] * p[1] < disk * disk).count().max(1);
    (std::f64::consts::PI * disk * disk / inside as f64).sqrt()
}

fn average(patches: &[Vec<f64>]) -> Spectrum {
    let count = patches.len() as f64;
    let mut mean = vec![0.0; DIRECTIONS * WAVES];
    for patch in patches {
        for (m, p) in mean.iter_mut().zip(patch) {
            *m += p / count;
        }
    }
    let at = |wave: usize| (0..DIRECTIONS).map(move |d| d * WAVES + wave);
    let power: Vec<f64> =
        (0..WAVES).map(|w| at(w).map(|i| mean[i]).sum::<f64>() / DIRECTIONS as f64).collect();
    let spread =
        |w: usize| at(w).map(|i| (mean[i] - power[w]).powi(2)).sum::<f64>() / (DIRECTIONS - 1) as f64;
    Spectrum {
        wave_number: (1..=WAVES).map(|n| HIGHEST * n as f64 / WAVES as f64).collect(),
        anisotropy: (0..WAVES)
            .map(|w| if power[w] > 0.0 { count * spread(w) / (power[w] * power[w]) } else { 0.0 })
            .collect(),
        power,
        patches: patches.len(),
    }
}
