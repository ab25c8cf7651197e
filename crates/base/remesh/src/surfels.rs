//! A cloud → small squares: each point stands for the surface around it.
//!
//! ```text
//! normal   least axis of the nearest neighbours; given normals are taken as they are, unless those of neighbours look to opposite sides
//! side     normals are passed on from neighbour to neighbour, the most parallel ones first, from the highest point, which looks up
//! size     area of a square = π r²/k, r the distance of the k-th neighbour
//! ```
//!
//! Passing on: Hoppe, DeRose, Duchamp, McDonald & Stuetzle (1992), doi:10.1145/133994.134011. The squares wind around the inside like the surface
//! does (Barill et al. 2018, doi:10.1145/3197517.3201337).

use geom::mesh::TriMesh;
use geom::{Grid, Vec3, least_axis};
use nalgebra::Matrix3;
use rayon::prelude::*;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Neighbours of a point.
const NEIGHBOURS: usize = 12;

/// Share of parallel neighbours whose given normals may look to opposite sides: both faces of a thin plate do, and those of random sign are half.
const OPPOSITE: f64 = 0.25;
/// Normals are parallel, up to their sign, with this cosine of the angle between them.
const PARALLEL: f64 = 0.7;

/// Squares of a cloud.
pub struct Surfels {
    /// Two triangles for each point.
    pub squares: TriMesh,
    /// Distance of the points [m].
    pub spacing: f64,
    /// Given normals that were turned to the other side.
    pub turned: usize,
}

/// Squares of a cloud; `None` when it has fewer points than [`NEIGHBOURS`] and one, or all at one place.
pub fn squares(points: &[Vec3], normals: Option<&[Vec3]>) -> Option<Surfels> {
    let near = neighbours(points)?;
    let spacing = |k: usize| {
        let far = near[k].last().map_or(0.0, |n| (points[*n as usize] - points[k]).norm());
        (std::f64::consts::PI / NEIGHBOURS as f64).sqrt() * far
    };
    let (normals, turned) = match normals {
        Some(given) if are_of_random_sign(given, &near) => {
            let passed_on = with_sides(points, &near, given.to_vec());
            let turned = given.iter().zip(&passed_on).filter(|(a, b)| a.dot(b) < 0.0).count();
            // Which side is which is not known: the fewer were wrong.
            (passed_on, turned.min(given.len() - turned))
        }
        Some(given) => (given.to_vec(), 0),
        None => (with_sides(points, &near, found_normals(points, &near)), 0),
    };
    let mut mesh = TriMesh::default();
    let mut sizes: Vec<f64> = (0..points.len()).map(spacing).collect();
    for (k, p) in points.iter().enumerate() {
        let n = normals[k].try_normalize(0.0)?;
        let across =
            n.cross(&if n.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() }).normalize() * (sizes[k] / 2.0);
        let up = n.cross(&across);
        let first = mesh.vertices.len() as u32;
        mesh.vertices.extend([p - across - up, p + across - up, p + across + up, p - across + up]);
        mesh.faces.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    // Normals that all look inwards.
    if mesh.volume() < 0.0 {
        mesh.faces.iter_mut().for_each(|f| f.swap(1, 2));
    }
    sizes.sort_by(f64::total_cmp);
    let middle = sizes[sizes.len() / 2];
    (middle > 0.0).then_some(Surfels { squares: mesh, spacing: middle, turned })
}

/// The nearest neighbours of each point, nearest first.
fn neighbours(points: &[Vec3]) -> Option<Vec<Vec<u32>>> {
    if points.len() <= NEIGHBOURS {
        return None;
    }
    let (lo, hi) = geom::grid::bounds(points);
    let extent = (hi - lo).max();
    if !(extent > 0.0) {
        return None;
    }
    // As if a sphere were covered evenly.
    let start = extent * (3.0 * NEIGHBOURS as f64 / points.len() as f64).sqrt();
    let grid = Grid::new(points, start / 2.0);
    let of = |k: usize| {
        let mut radius = start / 2.0;
        loop {
            let mut found: Vec<(f64, u32)> = grid
                .within(points, points[k], radius)
                .filter(|n| *n as usize != k)
                .map(|n| ((points[n as usize] - points[k]).norm_squared(), n))
                .collect();
            if found.len() >= NEIGHBOURS || radius > 4.0 * extent {
                found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                return found.into_iter().take(NEIGHBOURS).map(|f| f.1).collect();
            }
            radius *= 2.0;
        }
    };
    Some((0..points.len()).into_par_iter().map(of).collect())
}

/// Whether given normals of neighbours look to opposite sides too often to say where the inside is.
fn are_of_random_sign(normals: &[Vec3], near: &[Vec<u32>]) -> bool {
    let (mut parallel, mut opposite) = (0usize, 0usize);
    for (normal, near) in normals.iter().zip(near) {
        for other in near.iter().map(|n| &normals[*n as usize]) {
            let cosine = normal.dot(other) / (normal.norm() * other.norm());
            parallel += usize::from(cosine.abs() > PARALLEL);
            opposite += usize::from(cosine < -PARALLEL);
        }
    }
    opposite as f64 > OPPOSITE * parallel as f64
}

fn found_normals(points: &[Vec3], near: &[Vec<u32>]) -> Vec<Vec3> {
    let of = |k: usize| {
        let all = || near[k].iter().map(|n| points[*n as usize]).chain([points[k]]);
        let mean = all().sum::<Vec3>() / (near[k].len() + 1) as f64;
        let spread: Matrix3<f64> = all().map(|p| (p - mean) * (p - mean).transpose()).sum();
        least_axis(&spread).unwrap_or_else(Vec3::z)
    };
    (0..points.len()).into_par_iter().map(of).collect()
}

/// Normals with their sides, passed on from neighbour to neighbour.
fn with_sides(points: &[Vec3], near: &[Vec<u32>], mut normals: Vec<Vec3>) -> Vec<Vec3> {
    // Neighbours both ways.
    let mut both: Vec<Vec<u32>> = near.to_vec();
    for (k, list) in near.iter().enumerate() {
        list.iter().for_each(|n| both[*n as usize].push(k as u32));
    }
    let mut done = vec![false; points.len()];
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|a, b| points[*b].z.total_cmp(&points[*a].z));
    for start in order {
        if done[start] {
            continue;
        }
        if normals[start].z < 0.0 {
            normals[start] = -normals[start];
        }
        // Less parallel neighbours come later: 10⁹ steps from 0 to 1.
        let key =
            |a: usize, b: usize, normals: &[Vec3]| ((1.0 - normals[a].dot(&normals[b]).abs()) * 1e9) as u64;
        let mut open = BinaryHeap::from([Reverse((0, start as u32, start as u32))]);
        while let Some(Reverse((_, from, to))) = open.pop() {
            let (from, to) = (from as usize, to as usize);
            if done[to] {
                continue;
            }
            done[to] = true;
            if normals[from].dot(&normals[to]) < 0.0 {
                normals[to] = -normals[to];
            }
            for next in both[to].iter().filter(|n| !done[**n as usize]) {
                open.push(Reverse((key(to, *next as usize, &normals), to as u32, *next)));
            }
        }
    }
    normals
}
