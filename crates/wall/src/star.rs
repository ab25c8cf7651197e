//! The star of each point: its normal, its neighbours, and the voids around it.
//!
//! The points near by are laid onto the plane of least squares through them, and the point's Voronoi cell is cut out of a square by
//! one bisector after the other, nearest first. Its sides give the neighbours, its corners the voids: a corner is as far from
//! three points as from no other. Two neighbours are a *pair* when no other one lies in the ball whose diameter they are
//! (Gabriel & Sokal 1969, doi:10.2307/2412323); on an even lattice these are the lattice's edges, without diagonals.

use geom::{Grid, Vec3};
use nalgebra::{Matrix3, SymmetricEigen};
use rayon::prelude::*;

/// Half width of the first square, and so the largest void that is looked for, in nearest distances.
const SQUARE: f64 = 3.0;
/// Points within this many nearest distances are looked at first; more when the cell reaches far.
const FIRST_REACH: f64 = 2.8;
/// Points of the normal are at most this many.
const FOR_NORMAL: usize = 24;
/// A point as near as this to the border of the ball counts as inside: on a square lattice there is no diagonal.
const ON_BORDER: f64 = 1e-9;

/// Stars of all points.
#[derive(Debug, Clone, Default)]
pub struct Stars {
    /// Unit normal of each point [–]; which of the two sides is chance. Zero where points lie on one line or at one place.
    pub normals: Vec<Vec3>,
    /// Neighbours i < j of the Gabriel graph, ascending.
    pub pairs: Vec<(u32, u32)>,
    /// Three points around a void, the first the lowest.
    pub triangles: Vec<[u32; 3]>,
    /// Largest circle through three points that is told from the outline of the wall [m].
    pub largest: f64,
}

/// One point's own.
struct Star {
    normal: Vec3,
    pairs: Vec<u32>,
    triangles: Vec<[u32; 3]>,
}

/// A corner of the cell, and the neighbour whose bisector starts there (none: a side of the first square).
#[derive(Clone, Copy)]
struct Corner {
    at: [f64; 2],
    next: Option<u32>,
}

/// Stars of points [m], all finite and apart, whose nearest distance is about `nearest` [m].
pub fn stars(points: &[Vec3], nearest: f64) -> Stars {
    let grid = Grid::new(points, FIRST_REACH * nearest);
    let stars: Vec<Star> =
        (0..points.len() as u32).into_par_iter().map(|i| star(points, &grid, i, nearest)).collect();
    let mut all = Stars { largest: SQUARE * nearest, ..Stars::default() };
    for (i, star) in (0u32..).zip(stars) {
        all.normals.push(star.normal);
        all.pairs.extend(star.pairs.iter().map(|&j| (i, j)));
        all.triangles.extend(star.triangles);
    }
    all
}

fn star(points: &[Vec3], grid: &Grid, i: u32, nearest: f64) -> Star {
    let mut reach = FIRST_REACH * nearest;
    let furthest = 2.0 * SQUARE * nearest;
    loop {
        let near = neighbours(points, grid, i, reach);
        let (u, v, normal) = plane(&near);
        let cell = voronoi(&near, &u, &v, SQUARE * nearest);
        let extent = cell.iter().map(|c| c.at[0].hypot(c.at[1])).fold(0.0, f64::max);
        if 2.0 * extent <= reach || reach >= furthest {
            return finish(points, i, normal, &near, &cell, SQUARE * nearest);
        }
        reach = (2.0 * extent).min(furthest);
    }
}

/// Points within reach, nearest first, relative to the point.
fn neighbours(points: &[Vec3], grid: &Grid, i: u32, reach: f64) -> Vec<(f64, u32, Vec3)> {
    let centre = points[i as usize];
    let mut near: Vec<(f64, u32, Vec3)> = grid
        .within(points, centre, reach)
        .filter(|&j| j != i)
        .map(|j| {
            let to = points[j as usize] - centre;
            (to.norm_squared(), j, to)
        })
        .collect();
    near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    near
}

/// Two axes and the normal of the plane of least squares through the point and those nearest to it.
fn plane(near: &[(f64, u32, Vec3)]) -> (Vec3, Vec3, Vec3) {
    let some = &near[..near.len().min(FOR_NORMAL)];
    let count = some.len() as f64 + 1.0;
    let mean = some.iter().map(|n| n.2).sum::<Vec3>() / count;
    let mut spread: Matrix3<f64> = mean * mean.transpose();
    for (_, _, p) in some {
        spread += (p - mean) * (p - mean).transpose();
    }
    let eigen = SymmetricEigen::new(spread);
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let axis = |k: usize| eigen.eigenvectors.column(order[k]).into_owned();
    let flat = eigen.eigenvalues[order[1]] > 1e-12 * eigen.eigenvalues[order[0]];
    (axis(0), axis(1), if flat { axis(2) } else { Vec3::zeros() })
}

/// The Voronoi cell in the plane, around the origin.
fn voronoi(near: &[(f64, u32, Vec3)], u: &Vec3, v: &Vec3, half: f64) -> Vec<Corner> {
    let square = [[-half, -half], [half, -half], [half, half], [-half, half]];
    let mut cell: Vec<Corner> = square.iter().map(|&at| Corner { at, next: None }).collect();
    let mut kept = Vec::with_capacity(16);
    let mut extent = half * half * 2.0;
    for (index, (_, _, p)) in (0u32..).zip(near) {
        let q = [p.dot(u), p.dot(v)];
        let square = q[0] * q[0] + q[1] * q[1];
        // Its bisector passes beyond the furthest corner.
        if square >= 4.0 * extent || square <= 0.0 {
            continue;
        }
        cut(&cell, &mut kept, q, index);
        std::mem::swap(&mut cell, &mut kept);
        extent = cell.iter().map(|c| c.at[0] * c.at[0] + c.at[1] * c.at[1]).fold(0.0, f64::max);
    }
    cell
}

/// Keeps what is nearer to the origin than to `q`.
fn cut(cell: &[Corner], kept: &mut Vec<Corner>, q: [f64; 2], index: u32) {
    kept.clear();
    let beyond = |c: &Corner| c.at[0] * q[0] + c.at[1] * q[1] - 0.5 * (q[0] * q[0] + q[1] * q[1]);
    for k in 0..cell.len() {
        let (a, b) = (cell[k], cell[(k + 1) % cell.len()]);
        let (fa, fb) = (beyond(&a), beyond(&b));
        if fa <= 0.0 {
            kept.push(a);
        }
        if (fa <= 0.0) != (fb <= 0.0) {
            let s = fa / (fa - fb);
            let at = [a.at[0] + s * (b.at[0] - a.at[0]), a.at[1] + s * (b.at[1] - a.at[1])];
            // Going out, the new side begins; coming back, the old one goes on.
            kept.push(Corner { at, next: if fa <= 0.0 { Some(index) } else { a.next } });
        }
    }
}

fn finish(
    points: &[Vec3],
    i: u32,
    normal: Vec3,
    near: &[(f64, u32, Vec3)],
    cell: &[Corner],
    half: f64,
) -> Star {
    let sides: Vec<u32> = cell.iter().filter_map(|c| c.next).collect();
    let in_ball = |a: u32, b: u32| {
        let (p, q) = (near[a as usize].2, near[b as usize].2);
        (q - 0.5 * p).norm_squared() < (0.25 + ON_BORDER) * p.norm_squared()
    };
    // Any point in the ball of i and j takes j's side away or is a neighbour itself, up to the bend of the sheet.
    let mut pairs: Vec<u32> = sides
        .iter()
        .filter(|&&a| near[a as usize].1 > i && !sides.iter().any(|&b| b != a && in_ball(a, b)))
        .map(|&a| near[a as usize].1)
        .collect();
    pairs.sort_unstable();
    pairs.dedup();
    let mut triangles = Vec::new();
    for k in 0..cell.len() {
        let before = cell[(k + cell.len() - 1) % cell.len()].next;
        let (Some(a), Some(b)) = (before, cell[k].next) else { continue };
        let (j, k2) = (near[a as usize].1, near[b as usize].1);
        let inside = cell[k].at[0].hypot(cell[k].at[1]) <= half;
        if inside && i < j && i < k2 && j != k2 && points.len() > 2 {
            triangles.push([i, j.min(k2), j.max(k2)]);
        }
    }
    Star { normal, pairs, triangles }
}
