//! Whether two sheets of a surface lie closer than the spacing: both faces of a plate, a fold.
//!
//! Around some of the points, the neighbours within 2.5 spacings are laid onto their plane. Their heights over it are two sheets when
//!
//! ```text
//! the best split in two leaves at most a tenth of their variance (Otsu 1979, doi:10.1109/TSMC.1979.4310076),
//! the means of the two are more than a tenth of the spacing apart and less than the spacing,
//! and both lie all around the point, not side by side as on the two sides of a step.
//! ```
//!
//! and a quadratic through them leaves at least a third of their variance: one bent sheet, whose points on a lattice lie in few heights,
//! leaves almost none. Where it leaves less, the heights over the quadratic are looked at instead: two sheets that are bent.
//!
//! Even heights leave a quarter, heights of normal noise 0.36 and an edge a quarter, however rough the surface.

use geom::{Grid, PrincipalAxes, Quadratic, Vec3};
use rayon::prelude::*;
use serde::Serialize;

/// Points that are looked at, at most.
const SOME: usize = 2048;
/// Neighbourhood, in spacings.
const REACH: f64 = 2.5;
/// Fewest neighbours, and of each sheet.
const FEWEST: (usize, usize) = (12, 4);
/// Most of the variance that a split in two sheets leaves [–].
const LEFT: f64 = 0.1;
/// Least of the variance that a quadratic leaves of two sheets [–].
const NOT_BENT: f64 = 0.33;
/// Least distance of two sheets, in spacings.
const APART: f64 = 0.1;
/// Largest distance of the middles of the two along the plane, in spacings.
const BESIDE: f64 = 0.8;
/// Least share of the points that is reported.
const TOLD: f64 = 0.02;

/// Two sheets.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Sheets {
    /// Share of the points that have another sheet so near [–].
    pub share: f64,
    /// Least distance of the two [m].
    pub apart: f64,
    /// Where [m].
    pub at: [f64; 3],
}

/// Where two sheets of points [m] are closer than their `spacing` [m]; none for single ones.
pub fn closer_than(points: &[Vec3], spacing: f64) -> Option<Sheets> {
    let reach = REACH * spacing;
    let grid = Grid::new(points, reach);
    let step = points.len().div_ceil(SOME).max(1);
    let some: Vec<u32> = grid.order().iter().copied().step_by(step).collect();
    let found: Vec<Option<f64>> = some
        .par_iter()
        .map(|&i| {
            let centre = points[i as usize];
            let near: Vec<Vec3> =
                grid.within(points, centre, reach).map(|j| points[j as usize] - centre).collect();
            apart(&near, spacing)
        })
        .collect();
    let share = found.iter().flatten().count() as f64 / some.len().max(1) as f64;
    let nearest = found.iter().zip(&some).filter_map(|(apart, i)| apart.map(|a| (a, *i)));
    let (apart, i) = nearest.min_by(|a, b| a.0.total_cmp(&b.0))?;
    (share >= TOLD).then(|| Sheets { share, apart, at: points[i as usize].into() })
}

/// Distance of the two sheets that the positions make [m]; none for one sheet.
fn apart(near: &[Vec3], spacing: f64) -> Option<f64> {
    if near.len() < FEWEST.0 {
        return None;
    }
    let principal = PrincipalAxes::of(near.iter());
    let (mean, normal) = (principal.middle, principal.normal());
    let heights: Vec<(f64, Vec3)> = near.iter().map(|p| ((p - mean).dot(&normal), *p)).collect();
    let over = over_quadratic(&heights, &normal)?;
    let variance = |heights: &[(f64, Vec3)]| heights.iter().map(|h| h.0 * h.0).sum::<f64>();
    let is_bent = variance(&over) < NOT_BENT * variance(&heights);
    split(if is_bent { over } else { heights }, &normal, spacing)
}

/// Distance of the two sheets that heights of mean 0 [m] fall into.
fn split(mut heights: Vec<(f64, Vec3)>, normal: &Vec3, spacing: f64) -> Option<f64> {
    let count = heights.len() as f64;
    heights.sort_by(|a, b| a.0.total_cmp(&b.0));
    let whole: f64 = heights.iter().map(|h| h.0 * h.0).sum();
    let (mut below, mut best) = (0.0, (0.0, 0));
    for k in 1..heights.len() {
        below += heights[k - 1].0;
        // Σ h = 0: the upper sheet's sum is minus the lower one's.
        let between = below * below * (1.0 / k as f64 + 1.0 / (count - k as f64));
        if between > best.0 {
            best = (between, k);
        }
    }
    let (between, k) = best;
    if k < FEWEST.1 || heights.len() - k < FEWEST.1 || whole - between > LEFT * whole {
        return None;
    }
    let height = |part: &[(f64, Vec3)]| part.iter().map(|h| h.0).sum::<f64>() / part.len() as f64;
    let middle = |part: &[(f64, Vec3)]| part.iter().map(|h| h.1).sum::<Vec3>() / part.len() as f64;
    let off = middle(&heights[k..]) - middle(&heights[..k]);
    let (apart, beside) =
        (height(&heights[k..]) - height(&heights[..k]), (off - normal * off.dot(normal)).norm());
    (apart > APART * spacing && apart < spacing && beside < BESIDE * spacing).then_some(apart)
}

/// Heights over the quadratic through positions with heights over their plane, their mean taken off [m].
fn over_quadratic(heights: &[(f64, Vec3)], normal: &Vec3) -> Option<Vec<(f64, Vec3)>> {
    let u = normal.cross(&Vec3::ith(normal.iamin(), 1.0)).normalize();
    let v = normal.cross(&u);
    let laid: Vec<Vec3> = heights.iter().map(|(h, p)| Vec3::new(p.dot(&u), p.dot(&v), *h)).collect();
    let fit = Quadratic::fit(&laid)?;
    let over: Vec<f64> = laid.iter().map(|p| p.z - fit.height(p.x, p.y)).collect();
    let middle = over.iter().sum::<f64>() / over.len() as f64;
    Some(over.iter().map(|h| h - middle).zip(heights.iter().map(|h| h.1)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random() -> impl FnMut() -> f64 {
        let mut state = 9u64;
        move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    /// 900 shaken positions of a lattice of spacing 1 with a height.
    fn sheet(mut height: impl FnMut(f64, f64, f64) -> f64) -> Vec<Vec3> {
        let mut next = random();
        let mut position = |i: usize| {
            let (x, y) = ((i % 30) as f64 + 0.4 * next(), (i / 30) as f64 + 0.4 * next());
            Vec3::new(x, y, height(x, y, next()))
        };
        (0..900).map(&mut position).collect()
    }

    #[test]
    fn two_sheets_are_told_and_one_is_not_however_rough_bent_or_folded() {
        for apart in [0.15, 0.5, 0.9] {
            let two = sheet(|_, _, chance| if chance < 0.5 { 0.0 } else { apart });
            let told = closer_than(&two, 1.0).unwrap();
            assert!((told.apart / apart - 1.0).abs() < 0.25 && told.share > 0.3, "{apart}: {told:?}");
        }
        assert_eq!(
            closer_than(&sheet(|_, _, chance| if chance < 0.5 { 0.0 } else { 1.6 }), 1.0),
            None,
            "wide enough"
        );
        assert_eq!(closer_than(&sheet(|_, _, _| 0.0), 1.0), None);
        assert_eq!(closer_than(&sheet(|_, _, chance| chance), 1.0), None, "rough");
        assert_eq!(closer_than(&sheet(|x, _, chance| (x - 15.0).abs() + 0.1 * chance), 1.0), None, "an edge");
        assert_eq!(
            closer_than(&sheet(|x, _, chance| f64::from(u8::from(x > 15.0)) * 0.8 + 0.05 * chance), 1.0),
            None
        );
        assert_eq!(closer_than(&sheet(|x, y, _| 0.05 * (x * x - y * y)), 1.0), None, "bent");
    }

    /// The points of a lattice of a smooth wave lie in few heights, and are one sheet; a second sheet under the same wave is found.
    #[test]
    fn a_wave_on_a_lattice_is_one_sheet() {
        let wave = |x: f64| 0.02 * (20.0 * x).sin();
        for step in [0.004, 0.008, 0.012] {
            let at = |i: usize| (step * (i % 100) as f64, step * (i / 100) as f64);
            let one: Vec<Vec3> = (0..5000).map(at).map(|(x, y)| Vec3::new(x, y, wave(x))).collect();
            assert_eq!(closer_than(&one, step), None, "{step}");
            for apart in [0.25, 0.5, 0.8] {
                let beside =
                    |(x, y): (f64, f64)| Vec3::new(x + 0.5 * step, y, wave(x + 0.5 * step) + apart * step);
                let two = [one.clone(), (0..5000).map(at).map(beside).collect()].concat();
                let told = closer_than(&two, step).unwrap();
                assert!(
                    (told.apart / (apart * step) - 1.0).abs() < 0.3 && told.share > 0.3,
                    "{step} {apart}: {told:?}"
                );
            }
        }
    }
}
