//! Cuts holes out of a cloud, and compares what is found with what was cut.

use crate::bodies::{Body, Random};
use cloud::Cloud;
use cloud::fill::{Filled, Settings};
use geom::{Grid, Vec3};
use rayon::prelude::*;
use stream::Table;

/// Least and greatest diameter of a hole, in local spacings.
const SIZES: (f64, f64) = (3.0, 60.0);
/// Widest hole, as a share of the body: wider ones are left open by default.
const WIDEST: f64 = 0.15;
/// Neighbours that a local spacing is measured by.
const NEIGHBOURS: usize = 24;

/// A hole that was cut: a ball without points.
pub struct Cut {
    pub centre: Vec3,
    /// Of the ball [m].
    pub radius: f64,
    /// 1/√density around it before the cut [m].
    pub spacing: f64,
    /// What was cut out [m].
    pub points: Vec<Vec3>,
}

/// How one hole was filled.
#[derive(Clone)]
pub struct Score {
    /// Diameter in local spacings.
    pub size: f64,
    pub found: bool,
    /// Squares of the distances of the added points from the surface, in local spacings, and their number.
    pub squares: (f64, usize),
    /// Hausdorff distance of the added points and those that were cut, in local spacings.
    pub hausdorff: f64,
}

impl Score {
    /// Of the points that were put into a hole.
    pub fn of(body: Body, cut: &Cut, inside: &[Vec3], found: bool) -> Score {
        let off = |p: &Vec3| body.off(p).unwrap_or_else(|| off_scan(cut, p)) / cut.spacing;
        let squares = inside.iter().map(|p| off(p).powi(2)).sum();
        let nearest = |of: &[Vec3], p: &Vec3| of.iter().map(|q| (q - p).norm()).fold(f64::INFINITY, f64::min);
        let farthest = |of: &[Vec3], to: &[Vec3]| of.iter().map(|p| nearest(to, p)).fold(0.0, f64::max);
        let hausdorff = farthest(&cut.points, inside).max(farthest(inside, &cut.points)) / cut.spacing;
        Score { size: 2.0 * cut.radius / cut.spacing, found, squares: (squares, inside.len()), hausdorff }
    }

    /// Root mean square distance from the surface, in local spacings; none without points.
    pub fn rms(&self) -> Option<f64> {
        (self.squares.1 > 0).then(|| (self.squares.0 / self.squares.1 as f64).sqrt())
    }
}

/// How one cloud was filled.
#[derive(Clone)]
pub struct Outcome {
    pub points: usize,
    pub scores: Vec<Score>,
    /// Holes that are none.
    pub false_finds: usize,
}

/// Fills a cloud without cuts; scans have holes of their own.
pub fn fill(points: Vec<Vec3>) -> Result<Filled, String> {
    let cloud = Cloud { attributes: Table::with_rows(points.len()), points, ..Cloud::default() };
    cloud::fill(cloud, &Settings { bridge: true, ..Settings::default() }).map_err(|why| why.to_string())
}

/// Distance of the `NEIGHBOURS`th neighbour as a spacing.
fn spacing(points: &[Vec3], grid: &Grid, p: &Vec3, start: f64) -> f64 {
    let mut reach = start;
    loop {
        let mut near: Vec<f64> =
            grid.within(points, *p, reach).map(|j| (points[j as usize] - p).norm()).collect();
        if near.len() > NEIGHBOURS {
            near.sort_by(f64::total_cmp);
            return near[NEIGHBOURS] * (std::f64::consts::PI / NEIGHBOURS as f64).sqrt();
        }
        reach *= 1.5;
    }
}

/// Whether the points in a ring around a place leave no gap in it, seen along the normal of the ball's points.
fn is_whole(points: &[Vec3], near: &[u32], p: &Vec3, radius: f64) -> bool {
    let all: Vec<Vec3> = near.iter().map(|&i| points[i as usize] - p).collect();
    let spread: nalgebra::Matrix3<f64> = all.iter().map(|d| d * d.transpose()).sum();
    let eigen = nalgebra::SymmetricEigen::new(spread);
    let normal: Vec3 = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into();
    let u = normal.cross(&Vec3::ith(normal.iamin(), 1.0)).normalize();
    let v = normal.cross(&u);
    let mut sectors = [false; 24];
    for d in all.iter().filter(|d| d.norm() > radius) {
        let turn = d.dot(&v).atan2(d.dot(&u)) / std::f64::consts::TAU + 0.5;
        sectors[(turn * 24.0) as usize % 24] = true;
    }
    sectors.iter().all(|filled| *filled)
}

/// Up to `count` holes at random, apart from each other, where the cloud is whole; the cloud without them.
pub fn cut(points: &[Vec3], count: usize, seed: u64) -> (Vec<Vec3>, Vec<Cut>) {
    let mut random = Random(seed ^ 0x5eed);
    let (lo, hi) = geom::grid::bounds(points);
    let widest = WIDEST * (hi - lo).norm();
    let start = (hi - lo).norm() / (points.len() as f64).sqrt();
    let grid = Grid::new(points, start);
    let mut cuts: Vec<Cut> = Vec::new();
    for _ in 0..60 * count {
        if cuts.len() == count {
            break;
        }
        let centre = points[(random.next() * points.len() as f64) as usize];
        let size = SIZES.0 * (SIZES.1 / SIZES.0).powf(random.next());
        let spacing = spacing(points, &grid, &centre, start);
        let radius = 0.5 * size * spacing;
        let apart = |other: &Cut| {
            (other.centre - centre).norm() > 1.5 * (radius + other.radius) + 12.0 * spacing.max(other.spacing)
        };
        if 2.0 * radius > widest || !cuts.iter().all(apart) {
            continue;
        }
        let reach = 1.25 * radius + 4.0 * spacing;
        let near: Vec<u32> = grid.within(points, centre, reach).collect();
        if !is_whole(points, &near, &centre, radius) {
            continue;
        }
        let inside = near.iter().map(|&i| points[i as usize]).filter(|p| (p - centre).norm() < radius);
        cuts.push(Cut { centre, radius, spacing, points: inside.collect() });
    }
    let stays = |p: &&Vec3| cuts.iter().all(|cut| (*p - cut.centre).norm() >= cut.radius);
    (points.par_iter().filter(stays).copied().collect(), cuts)
}

/// Distance of a place from the plane through the nearest points that were cut.
fn off_scan(cut: &Cut, p: &Vec3) -> f64 {
    let mut near: Vec<(f64, &Vec3)> = cut.points.iter().map(|q| ((q - p).norm_squared(), q)).collect();
    near.sort_by(|a, b| a.0.total_cmp(&b.0));
    near.truncate(10);
    let mean = near.iter().map(|(_, q)| *q).sum::<Vec3>() / near.len().max(1) as f64;
    if near.len() < 6 {
        return (p - mean).norm();
    }
    let spread: nalgebra::Matrix3<f64> =
        near.iter().map(|(_, q)| (*q - mean) * (*q - mean).transpose()).sum();
    let eigen = nalgebra::SymmetricEigen::new(spread);
    let normal: Vec3 = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into();
    (p - mean).dot(&normal).abs()
}

/// Fills the cloud without the cuts and says what became of them; `own` are holes that the whole cloud has.
pub fn outcome(body: Body, points: Vec<Vec3>, cuts: &[Cut], own: &[(Vec3, f64)]) -> Result<Outcome, String> {
    let count = points.len();
    let filled = fill(points)?;
    let holes = &filled.report.holes;
    let added = &filled.cloud.points[count..];
    let centre = |h: &cloud::fill::HoleReport| Vec3::from(h.centre);
    let of = |cut: &Cut| {
        let found = holes.iter().any(|h| {
            let close = (centre(h) - cut.centre).norm() < cut.radius.max(2.0 * cut.spacing);
            close && h.width > 0.5 * cut.radius && h.added > 0
        });
        let inside: Vec<Vec3> =
            added.iter().filter(|p| (*p - cut.centre).norm() < cut.radius).copied().collect();
        Score::of(body, cut, &inside, found)
    };
    let is_false = |h: &&cloud::fill::HoleReport| {
        let of_cut = |c: &Cut| (centre(h) - c.centre).norm() < c.radius + 4.0 * c.spacing + 0.5 * h.width;
        let known = |(p, width): &(Vec3, f64)| (centre(h) - p).norm() < 0.75 * (width + h.width);
        !cuts.iter().any(of_cut) && !own.iter().any(known)
    };
    Ok(Outcome {
        points: count,
        scores: cuts.par_iter().map(of).collect(),
        false_finds: holes.iter().filter(is_false).count(),
    })
}
