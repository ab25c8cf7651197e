//! The star of each point: its normal, and the voids around it.
//!
//! The points near by are laid onto the plane of least squares through them, and the point's Voronoi cell is cut out of a square by
//! one bisector after the other, nearest first. Its sides give the neighbours, its corners the voids: a corner is as far from
//! three points as from no other. Points are named by their slot in the order of the cells.

use crate::{Cells, Vec3, least_axis};
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::ops::Range;

/// Points of the normal are at most this many.
const FOR_NORMAL: usize = 24;
/// Points are worked on in parts of this many.
const PART: usize = 512;
/// A neighbour so many times as far above or below the plane as it is beside the point is of another sheet, for [`voids`].
const STEEPEST: f64 = 2.0;
/// Stars of all points.
#[derive(Debug, Clone, Default)]
pub struct Stars {
    /// Unit normal of each point [–]; which of the two sides is chance. Zero where points lie on one line or at one place.
    pub normals: Vec<Vec3>,
    /// Three points around a void, the first the lowest.
    pub triangles: Vec<[u32; 3]>,
    /// Edges of the outline of the surface, lower index first, ascending: on one of their sides no void is found.
    pub outline: Vec<(u32, u32)>,
}

/// A circle through three points that holds no other.
#[derive(Debug, Clone, Copy)]
pub struct Void {
    /// Slots of the three points, ascending.
    pub corners: [u32; 3],
    /// Middle, on the plane of the point whose star it is of [m].
    pub centre: Vec3,
    /// [m]
    pub radius: f64,
}

/// A corner of the cell, and the neighbour whose bisector starts there (none: a side of the first square).
#[derive(Debug, Clone, Copy)]
struct Corner {
    at: [f64; 2],
    next: Option<u32>,
}

/// A point near by: its slot in the order, and where it is from the point in the middle [m].
#[derive(Debug, Clone, Copy)]
struct Neighbour {
    index: u32,
    to: Vec3,
}

/// Stars of all points, with voids of a radius up to `largest` [m]; the cells' width is looked over first, more when a star reaches far.
pub fn stars(cells: &Cells, largest: f64) -> Stars {
    let count = cells.len();
    let parts: Vec<Stars> = (0..count.div_ceil(PART))
        .into_par_iter()
        .map(|part| {
            let (mut stars, mut work) = (Stars::default(), StarScratch::default());
            for slot in part * PART..count.min((part + 1) * PART) {
                let (_, _, normal) = star(cells, slot as u32, largest, f64::INFINITY, &mut work);
                stars.normals.push(normal);
                finish(slot as u32, &work.near, &work.cell, largest, &mut stars);
            }
            stars
        })
        .collect();
    let mut all = Stars::default();
    all.normals.reserve_exact(count);
    all.triangles.reserve_exact(parts.iter().map(|part| part.triangles.len()).sum());
    for part in parts {
        all.normals.extend(part.normals);
        all.triangles.extend(part.triangles);
        all.outline.extend(part.outline);
    }
    all.outline.sort_unstable();
    all.outline.dedup();
    all
}

/// The voids around one point, of a radius up to `largest` [m], and its unit normal. Points of another sheet, over or under the point, are
/// left out.
pub fn voids(cells: &Cells, slot: u32, largest: f64, work: &mut StarScratch) -> (Vec3, Vec<Void>) {
    let (u, v, normal) = star(cells, slot, largest, STEEPEST, work);
    let StarScratch { near, cell, .. } = work;
    let void = |k: usize| {
        let (a, b) = void_at(cell, k, largest)?;
        let mut corners = [slot, near[a as usize].index, near[b as usize].index];
        corners.sort_unstable();
        let [x, y] = cell[k].at;
        let centre = cells.points[slot as usize] + u * x + v * y;
        Some(Void { corners, centre, radius: (x * x + y * y).sqrt() })
    };
    (normal, (0..cell.len()).filter_map(void).collect())
}

/// Memory that is used again for every point.
#[derive(Debug, Default)]
pub struct StarScratch {
    /// Squared distance [m²] (its bits are in the order of the numbers), slot.
    found: Vec<(u64, u32)>,
    near: Vec<Neighbour>,
    cell: Vec<Corner>,
    kept: Vec<Corner>,
}

/// The Voronoi cell of a point, in the memory, and its plane.
fn star(cells: &Cells, slot: u32, half: f64, steepest: f64, work: &mut StarScratch) -> (Vec3, Vec3, Vec3) {
    let (mut reach, furthest) = (cells.width, 2.0 * half);
    loop {
        neighbours(cells, slot, reach, work);
        let (u, v, normal) = plane(&work.near);
        if steepest < f64::INFINITY {
            let square = |x: f64| x * x;
            let beside = |to: &Vec3| square(to.dot(&u)) + square(to.dot(&v));
            work.near.retain(|n| square(n.to.dot(&normal)) <= steepest * steepest * beside(&n.to));
        }
        let extent = voronoi(work, &u, &v, half);
        if 2.0 * extent <= reach || reach >= furthest {
            return (u, v, normal);
        }
        reach = (2.0 * extent).min(furthest);
    }
}

/// Points within reach, nearest first, relative to the point.
fn neighbours(cells: &Cells, slot: u32, reach: f64, work: &mut StarScratch) {
    let StarScratch { found, near, .. } = work;
    let centre = cells.points[slot as usize];
    found.clear();
    let mut look = |run: Range<usize>| {
        for (other, point) in (run.start as u32..).zip(&cells.points[run]) {
            let square = (point - centre).norm_squared();
            if square <= reach * reach && other != slot {
                found.push((square.to_bits(), other));
            }
        }
    };
    match reach <= cells.width {
        true => cells.runs(slot).for_each(&mut look),
        false => cells.grid.runs_near(centre, reach).for_each(&mut look),
    }
    found.sort_unstable();
    near.clear();
    near.extend(
        found.iter().map(|&(_, index)| Neighbour { index, to: cells.points[index as usize] - centre }),
    );
}

/// Two axes and the normal of the plane of least squares through the point and those nearest to it.
fn plane(near: &[Neighbour]) -> (Vec3, Vec3, Vec3) {
    let some = &near[..near.len().min(FOR_NORMAL)];
    let count = some.len() as f64 + 1.0;
    let mean = some.iter().map(|n| n.to).sum::<Vec3>() / count;
    // The six different entries of the sum of d dᵀ; the point itself is at zero.
    let entries = |d: Vec3| [d.x * d.x, d.x * d.y, d.x * d.z, d.y * d.y, d.y * d.z, d.z * d.z];
    let mut sums = entries(mean);
    for n in some {
        let more = entries(n.to - mean);
        (0..6).for_each(|k| sums[k] += more[k]);
    }
    let [xx, xy, xz, yy, yz, zz] = sums;
    match least_axis(&Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)) {
        Some(normal) => {
            let u = across(&normal);
            (u, normal.cross(&u), normal)
        }
        None => {
            let along = near.last().map_or(Vec3::x(), |n| n.to).try_normalize(0.0).unwrap_or_else(Vec3::x);
            (along, across(&along), Vec3::zeros())
        }
    }
}

/// A unit vector at a right angle.
fn across(axis: &Vec3) -> Vec3 {
    let mut other = Vec3::zeros();
    other[axis.abs().imin()] = 1.0;
    axis.cross(&other).normalize()
}

/// The Voronoi cell in the plane, around the origin; how far its furthest corner is [m].
fn voronoi(work: &mut StarScratch, u: &Vec3, v: &Vec3, half: f64) -> f64 {
    let StarScratch { near, cell, kept, .. } = work;
    let square = [[-half, -half], [half, -half], [half, half], [-half, half]];
    cell.clear();
    cell.extend(square.map(|at| Corner { at, next: None }));
    let mut extent = half * half * 2.0;
    for (index, n) in (0u32..).zip(&*near) {
        let q = [n.to.dot(u), n.to.dot(v)];
        let square = q[0] * q[0] + q[1] * q[1];
        // Its bisector passes beyond the furthest corner.
        if square >= 4.0 * extent || square <= 0.0 {
            continue;
        }
        let beyond = |c: &Corner| c.at[0] * q[0] + c.at[1] * q[1] - 0.5 * square;
        if cell.iter().all(|c| beyond(c) <= 0.0) {
            continue;
        }
        cut(cell, kept, beyond, index);
        std::mem::swap(cell, kept);
        extent = cell.iter().map(|c| c.at[0] * c.at[0] + c.at[1] * c.at[1]).fold(0.0, f64::max);
    }
    extent.sqrt()
}

/// Keeps the corners that are not `beyond` the bisector, where that is above 0, and those that it makes.
fn cut(cell: &[Corner], kept: &mut Vec<Corner>, beyond: impl Fn(&Corner) -> f64, index: u32) {
    kept.clear();
    let Some(mut a) = cell.last() else { return };
    let mut fa = beyond(a);
    for b in cell {
        let fb = beyond(b);
        if (fa <= 0.0) != (fb <= 0.0) {
            let s = fa / (fa - fb);
            let at = [a.at[0] + s * (b.at[0] - a.at[0]), a.at[1] + s * (b.at[1] - a.at[1])];
            // Going out, the new side begins; coming back, the old one goes on.
            kept.push(Corner { at, next: if fa <= 0.0 { Some(index) } else { a.next } });
        }
        if fb <= 0.0 {
            kept.push(*b);
        }
        (a, fa) = (b, fb);
    }
}

/// The two neighbours that make a corner of the cell a void: three points make it, and it is not too far.
fn void_at(cell: &[Corner], k: usize, half: f64) -> Option<(u32, u32)> {
    let (before, [x, y]) = (cell[(k + cell.len() - 1) % cell.len()].next, cell[k].at);
    before.zip(cell[k].next).filter(|_| x * x + y * y <= half * half)
}

fn finish(i: u32, near: &[Neighbour], cell: &[Corner], half: f64, part: &mut Stars) {
    let is_void = |k: usize| void_at(cell, k, half);
    let mut last = is_void(cell.len() - 1);
    for k in 0..cell.len() {
        let void = is_void(k);
        // The side that ends here began at the last corner.
        let side = cell[(k + cell.len() - 1) % cell.len()].next;
        if let Some(a) = side.filter(|_| void.is_none() || last.is_none()) {
            let j = near[a as usize].index;
            part.outline.push((i.min(j), i.max(j)));
        }
        last = void;
        let Some((a, b)) = void else { continue };
        let (j, k) = (near[a as usize].index, near[b as usize].index);
        if i < j && i < k && j != k {
            part.triangles.push([i, j.min(k), j.max(k)]);
        }
    }
}
