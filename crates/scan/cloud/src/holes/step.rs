//! Steps: holes whose two sides are different surfaces, such as an edge and the floor behind it.
//!
//! ```text
//! step = |h_a − h_b| cos θ/w      h: heights in the middle of the hole of the planes through the surface on two opposite sides, θ: their slope,
//!                                 w: distance of these sides
//! ```
//!
//! Planes on both sides of a hole in a curved surface meet in its middle up to terms of third order: a dome, a saddle and an edge of any angle
//! have no step.

use super::hole::Hole;
use geom::Vec3;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;

/// How far a side reaches from the hole, as a share of its width, and in cells at least.
const DEPTH: (f64, f64) = (0.3, 6.0);
/// A hole with a larger step has two surfaces around it [–].
pub(crate) const MOST: f64 = 0.5;
/// Parts of the surroundings that get a plane each; an even number.
const SECTORS: usize = 8;
/// Fewest points of a plane.
const FEWEST: usize = 8;
/// Least cosine between two planes that are compared: others meet in an edge.
const ALIKE: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Least distance of two sides, in cells: no hole is narrower, and points that are nearer lie in its bends.
const NARROW: f64 = 4.0;
/// A step is larger than this many times what the points scatter around their planes.
const SURE: f64 = 3.0;

/// The plane through the points of a sector.
struct Side {
    /// Height in the middle of the hole [m].
    height: f64,
    normal: Vec3,
    /// Distance of its nearest point from the middle [m].
    near: f64,
    /// Root mean square of the distances of the points from it [m].
    rms: f64,
}

/// The largest step between opposite sides of a hole [–]; 0 where nothing is sure.
pub(crate) fn step(hole: &Hole) -> f64 {
    let middle = hole.frame.local(&hole.centre);
    let mut sectors: [Vec<Vec3>; SECTORS] = Default::default();
    for (_, p) in &hole.around {
        let from = p - middle;
        let turn = libm::atan2(from.y, from.x).rem_euclid(TAU) / TAU;
        sectors[((turn * SECTORS as f64) as usize).min(SECTORS - 1)].push(Vec3::new(from.x, from.y, p.z));
    }
    let depth = (DEPTH.0 * hole.width).max(DEPTH.1 * hole.raster.cell);
    let sides = sectors.map(|points| side(points, depth));
    let (first, second) = sides.split_at(SECTORS / 2);
    let steps = first.iter().zip(second).filter_map(|(a, b)| Some((a.as_ref()?, b.as_ref()?)));
    steps.map(|(a, b)| between(a, b, NARROW * hole.raster.cell)).fold(0.0, f64::max)
}

/// The step between two sides, which are at least `narrow` [m] apart.
fn between(a: &Side, b: &Side, narrow: f64) -> f64 {
    let (apart, width) = ((a.height - b.height).abs() * (a.normal + b.normal).normalize().z, a.near + b.near);
    let sure = apart > SURE * a.rms.max(b.rms);
    if a.normal.dot(&b.normal) > ALIKE && sure && width > narrow { apart / width } else { 0.0 }
}

/// The plane of least squares through those of some points that are nearest to the hole, up to a depth [m]; x and y count from the middle of the hole.
fn side(mut points: Vec<Vec3>, depth: f64) -> Option<Side> {
    let near = points.iter().map(|p| p.xy().norm()).fold(f64::INFINITY, f64::min);
    points.retain(|p| p.xy().norm() <= near + depth);
    if points.len() < FEWEST {
        return None;
    }
    let (mut a, mut b) = (Matrix3::zeros(), Vector3::zeros());
    for p in &points {
        let row = Vector3::new(1.0, p.x, p.y);
        a += row * row.transpose();
        b += row * p.z;
    }
    let plane = a.cholesky()?.solve(&b);
    let normal = Vec3::new(-plane.y, -plane.z, 1.0).normalize();
    let off = |p: &Vec3| (p.z - plane.dot(&Vector3::new(1.0, p.x, p.y))) * normal.z;
    let rms = (points.iter().map(|p| off(p).powi(2)).sum::<f64>() / points.len() as f64).sqrt();
    Some(Side { height: plane.x, normal, near, rms })
}
