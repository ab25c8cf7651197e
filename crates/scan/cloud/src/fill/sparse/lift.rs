//! The height of the surface at a void: that of a quadratic through the scanned points around it.

use super::voids::SurfaceVoid;
use super::{Surface, WIDEST};
use crate::holes::flat::frame::Frame;
use crate::holes::surface::sheet::widest_gap;
use geom::{Grid, Quadratic, Vec3};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// How far the points are that the quadratic goes through, in radii of the void.
pub(super) const REACH: f64 = 3.5;
/// They are thinned to one in each square of this share of the reach.
const SQUARE: f64 = 0.125;
/// What the quadratic may leave, as a share of the reach: a surface that is rougher gets no point. A third of the distance of neighbours.
const ROUGH: f64 = 0.1;
/// Below this share of the reach, what it leaves does not matter.
const SMOOTH: f64 = 0.01;
/// Least kurtosis of what it leaves [–]: 1 for two sheets of as many points, 1.8 for even numbers between two limits, 3 for normal noise.
const TWO_SHEETS: f64 = 1.6;
/// Points farther above or below the plane than beside the void, times this, are of another sheet or around an edge [–].
const STEEPEST: f64 = 1.0;
/// Largest curvature, over one per distance of neighbours [–]: what bends more, such as the rim of a plate from side to side, was not seen.
const BENT: f64 = 0.5;
/// The scanned points around leave no wider gap [degrees]: at the rim it is 180.
const GAP: f64 = 200.0;
/// Least distance of an added point from all others, in radii of its void.
pub(super) const CLOSEST: f64 = 0.8;

/// The position of each void's point on the surface [m]; none where there is no smooth surface.
pub(super) fn all(surface: &Surface, voids: &[SurfaceVoid]) -> Vec<Option<Vec3>> {
    let scanned = &surface.points[..surface.scanned];
    let lift = |void: &SurfaceVoid| one(scanned, &surface.grid, void, reach(surface, void));
    voids.par_iter().map(lift).collect()
}

/// Where the scan is sparser than the void is wide, as far as it takes [m].
fn reach(surface: &Surface, void: &SurfaceVoid) -> f64 {
    let widest = void.corners.iter().map(|&c| surface.widest[c as usize]).sum::<f64>() / 3.0;
    REACH * void.radius.max(widest / WIDEST)
}

fn one(scanned: &[Vec3], grid: &Grid, void: &SurfaceVoid, reach: f64) -> Option<Vec3> {
    let frame = Frame::new(void.at, &[void.normal])?;
    let near = grid.within(scanned, void.at, reach).map(|i| frame.local(&scanned[i as usize]));
    let beside = |p: &Vec3| (p.x * p.x + p.y * p.y).max(void.radius * void.radius);
    let near: Vec<Vec3> = near.filter(|p| p.z * p.z <= STEEPEST * STEEPEST * beside(p)).collect();
    let (gap, _) = widest_gap(&near, &Vec3::z())?;
    let fit = Quadratic::fit(&means(&near, SQUARE * reach)).filter(|_| gap <= GAP.to_radians())?;
    let squares = near.iter().map(|p| p.z - fit.height(p.x, p.y)).map(|off| off * off);
    let count = near.len() as f64;
    let (square, fourth) = squares.fold((0.0, 0.0), |sums, s| (sums.0 + s / count, sums.1 + s * s / count));
    let is_two = square.sqrt() > SMOOTH * reach && fourth < TWO_SHEETS * square * square;
    let ([_, _, _, uu, uv, vv], scale) = fit.parts();
    let curvature = (2.0 * uu.abs()).max(2.0 * vv.abs()).max(uv.abs()) / (scale * scale);
    let is_bent = curvature * reach / REACH > BENT;
    let is_smooth = square.sqrt() <= ROUGH * reach && !is_two && !is_bent;
    let height = fit.height(0.0, 0.0);
    (is_smooth && height.abs() <= void.radius).then(|| frame.world(&Vec3::new(0.0, 0.0, height)))
}

/// Mean position of the points of each square.
fn means(points: &[Vec3], square: f64) -> Vec<Vec3> {
    let mut sums: BTreeMap<[i64; 2], (Vec3, f64)> = BTreeMap::new();
    for p in points {
        let sum = sums.entry([p.x, p.y].map(|c| (c / square).floor() as i64)).or_insert((Vec3::zeros(), 0.0));
        *sum = (sum.0 + *p, sum.1 + 1.0);
    }
    sums.into_values().map(|(sum, count)| sum / count).collect()
}
