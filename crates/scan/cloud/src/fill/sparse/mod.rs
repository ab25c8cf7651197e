//! Sparse surface: points are added where a scan has too few for a spacing that will be asked for.
//!
//! ```text
//! void      a circle through three points, on the plane of one of them, that holds no other (`geom::star`); its radius is ρ
//! wanted    no void with ρ > 0.6 S: then points about S apart can be chosen everywhere
//! surface   ρ ≤ α, with α = min(1.5 s, 1.25 c), s = 1/√density around a point, c the scale of the search for holes: a wider void is a
//!           hole or the outside (α-shape; Edelsbrunner, Kirkpatrick & Seidel 1983, doi:10.1109/TIT.1983.1056714)
//! ```
//!
//! Voids of the surface get a point in their middle, the widest first, until none is left (refinement of a Delaunay triangulation;
//! Chew 1989). At the rim, where the middle lies outside, the longest edge of the triangle is halved. The height is that of a quadratic
//! through the scanned points around (`lift`). Added points keep the α of their corners, so that no hole closes from its rim.

mod lift;
mod voids;

use super::settings::{FillError, MOST};
use crate::neighbours::{connected, density, distances};
use geom::{Grid, Shape, Vec3};
use serde::Serialize;
use std::collections::{BTreeSet, HashSet};
use std::f64::consts::PI;
use voids::{Fresh, SurfaceVoid, find};

/// Neighbours that the density around a point is measured by.
const NEIGHBOURS: usize = 32;
/// Widest void of the surface, in 1/√density: 0.1 % of random points have a wider one.
const WIDEST: f64 = 1.5;
/// The same in scales of the search for holes, which sees what is wider.
const SCALES: f64 = 1.25;
/// Widest void that may stay, in spacings: with 0.5 the chosen points are hardly more even, and twice as many are added.
const WANTED: f64 = 0.6;
/// Points per area of the finest filling, times the widest void squared.
const PACKED: f64 = 1.2;
/// In one round, voids down to this share of the widest get a point.
const ROUND: f64 = 0.5;
/// Most rounds: they end when no void is left, after a dozen.
const MOST_ROUNDS: usize = 200;
/// How far from a sparse point the points are that count, in the widest α.
const MARGIN: f64 = 2.5;
/// A void this many times wider than wanted counts as left sparse.
const LEFT: f64 = 1.25;

/// The spacing that is wanted, and where.
pub(crate) struct SparseSearch<'a> {
    /// The spacing that will be asked for, S [m].
    pub spacing: f64,
    /// Scale of the search for holes, c [m].
    pub scale: f64,
    /// Only in these shapes; everywhere when there is none.
    pub regions: &'a [Shape],
}

impl SparseSearch<'_> {
    /// Radius of the widest void that may stay [m].
    fn wanted(&self) -> f64 {
        WANTED * self.spacing
    }
}

/// What was done where the scan is sparse.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct SparseReport {
    /// The spacing that will be asked for [m].
    pub spacing: f64,
    /// Points added.
    pub added: usize,
    /// Places where they were added.
    pub places: usize,
    /// Voids that stay too wide.
    pub left: usize,
    pub left_places: usize,
    /// Diameter of the widest void there [m].
    pub widest_left: f64,
    /// Where that is [m].
    pub widest_at: Option<[f64; 3]>,
}

/// Points that were added, and for each the row of a point of the cloud nearby.
#[derive(Default)]
pub(crate) struct Added {
    pub points: Vec<Vec3>,
    pub like: Vec<u32>,
}

/// The part of the cloud around its sparse places, and what was added to it.
struct Surface {
    /// Positions [m], those of the cloud first.
    points: Vec<Vec3>,
    /// How many are of the cloud.
    scanned: usize,
    grid: Grid,
    /// α of each [m].
    widest: Vec<f64>,
    /// Row of the cloud.
    like: Vec<u32>,
}

/// Adds points to the sparse places of finite `points` [m].
pub(crate) fn fill(points: &[Vec3], search: &SparseSearch) -> Result<(Added, SparseReport), FillError> {
    let mut report = SparseReport { spacing: search.spacing, ..SparseReport::default() };
    if points.len() < density::FEWEST {
        return Ok((Added::default(), report));
    }
    let widest = widest(points, search.scale);
    let sparse: Vec<u32> =
        (0..).zip(&widest).filter(|(_, w)| **w > search.wanted()).map(|(i, _)| i).collect();
    if sparse.is_empty() {
        return Ok((Added::default(), report));
    }
    let area: f64 = sparse.iter().map(|&i| (widest[i as usize] / WIDEST).powi(2)).sum();
    let wanted = PACKED * area / search.wanted().powi(2);
    if wanted > MOST {
        return Err(FillError::TooManySparse { spacing: search.spacing, points: wanted });
    }
    let (mut surface, sparse) = Surface::around(points, &widest, &sparse);
    surface.refine(&sparse, search);
    let scanned = surface.scanned;
    let all = sparse.into_iter().chain(scanned as u32..surface.points.len() as u32).collect();
    surface.report_left(all, search, &mut report);
    let added = Added { points: surface.points.split_off(scanned), like: surface.like.split_off(scanned) };
    report.added = added.points.len();
    report.places = count_places(&added.points, search.spacing);
    Ok((added, report))
}

/// α of each point [m].
fn widest(points: &[Vec3], scale: f64) -> Vec<f64> {
    let count = NEIGHBOURS.min(points.len() - 1);
    // Of a disc of radius R, the mean distance from the middle is 2R/3.
    let per_mean = 1.5 * (PI / count as f64).sqrt();
    let distances = distances::mean_distances(points, count);
    distances.into_iter().map(|mean| (WIDEST * per_mean * mean).min(SCALES * scale)).collect()
}

/// How many groups of points, two spacings apart, there are.
fn count_places(points: &[Vec3], spacing: f64) -> usize {
    connected::parts(points, 2.0 * spacing).into_iter().collect::<BTreeSet<u32>>().len()
}

impl Surface {
    /// The points near sparse ones, and the numbers of these among them.
    fn around(points: &[Vec3], widest: &[f64], sparse: &[u32]) -> (Surface, Vec<u32>) {
        let reach = MARGIN * sparse.iter().map(|&i| widest[i as usize]).fold(0.0, f64::max);
        let cell = |p: &Vec3| [0, 1, 2].map(|a| (p[a] / reach).floor() as i64);
        let mut cells: HashSet<[i64; 3]> = HashSet::new();
        for [x, y, z] in sparse.iter().map(|&i| cell(&points[i as usize])).collect::<BTreeSet<_>>() {
            let beside = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
            cells.extend(beside);
        }
        let rows = (0u32..).zip(points).filter(|(_, p)| cells.contains(&cell(p))).map(|(row, _)| row);
        let rows: Vec<u32> = rows.collect();
        let number = |row: &u32| rows.binary_search(row).unwrap_or(0) as u32;
        let near: Vec<Vec3> = rows.iter().map(|&row| points[row as usize]).collect();
        let mut wide: Vec<f64> = sparse.iter().map(|&i| widest[i as usize]).collect();
        let middle = wide.len() / 2;
        let typical = *wide.select_nth_unstable_by(middle, f64::total_cmp).1;
        let surface = Surface {
            grid: Grid::new(&near, lift::REACH / WIDEST * typical),
            points: near,
            scanned: rows.len(),
            widest: rows.iter().map(|&row| widest[row as usize]).collect(),
            like: rows.clone(),
        };
        let sparse = sparse.iter().map(number).collect();
        (surface, sparse)
    }

    /// Adds points until the voids around the `active` ones, and around what was added, are small enough.
    fn refine(&mut self, active: &[u32], search: &SparseSearch) {
        let limits = |widest: f64| (search.wanted(), widest);
        let mut found = find(self, active, search, &limits);
        for _ in 0..MOST_ROUNDS {
            let Some(most) = found.iter().map(|v| v.radius).reduce(f64::max) else { return };
            let (now, mut later): (Vec<_>, Vec<_>) =
                found.into_iter().partition(|v| v.radius >= ROUND * most);
            let lifted = lift::all(self, &now);
            let first = self.points.len() as u32;
            let fresh = self.take(&now, &lifted, most);
            // A void that a point came to lie in is no longer one; what is left of it is a void of that point.
            later.retain(|void| !fresh.any(&void.at, void.radius));
            let added: Vec<u32> = (first..self.points.len() as u32).collect();
            later.extend(find(self, &added, search, &limits));
            found = later;
        }
    }

    /// Adds the lifted middles of voids, the widest first, that are not in the void of one before, nor too near to another point.
    fn take(&mut self, voids: &[SurfaceVoid], lifted: &[Option<Vec3>], most: f64) -> Fresh {
        let before: Vec<Vec3> = self.points[self.scanned..].to_vec();
        let grid = Grid::new(&before, most);
        let mut fresh = Fresh::new(most);
        let mut order: Vec<usize> = (0..voids.len()).collect();
        order.sort_by(|&a, &b| voids[b].radius.total_cmp(&voids[a].radius).then(a.cmp(&b)));
        for k in order {
            let (void, Some(at)) = (&voids[k], lifted[k]) else { continue };
            let least = lift::CLOSEST * void.radius;
            let scanned = &self.points[..self.scanned];
            let is_close = self.grid.within(scanned, at, least).next().is_some()
                || grid.within(&before, at, least).next().is_some();
            if !is_close && !fresh.any(&at, void.radius) {
                fresh.add(at);
                self.push(at, void);
            }
        }
        fresh
    }

    /// Adds a point in the middle of a void.
    fn push(&mut self, at: Vec3, void: &SurfaceVoid) {
        let corners = void.corners.map(|c| c as usize);
        let far = |c: &usize| (self.points[*c] - at).norm_squared();
        let nearest = corners.into_iter().min_by(|a, b| far(a).total_cmp(&far(b)));
        let like = nearest.map_or(0, |c| self.like[c]);
        self.widest.push(corners.iter().map(|&c| self.widest[c]).sum::<f64>() / 3.0);
        self.like.push(like);
        self.points.push(at);
    }

    /// What stays sparse around the given points.
    fn report_left(&self, around: Vec<u32>, search: &SparseSearch, report: &mut SparseReport) {
        let found = find(self, &around, search, &|widest: f64| (LEFT * search.wanted(), 2.0 * widest));
        let inside: Vec<&SurfaceVoid> = found.iter().filter(|v| v.is_inside).collect();
        let middles: Vec<Vec3> = inside.iter().map(|v| v.at).collect();
        (report.left, report.left_places) = (inside.len(), count_places(&middles, search.spacing));
        if let Some(void) = inside.iter().max_by(|a, b| a.radius.total_cmp(&b.radius)) {
            (report.widest_left, report.widest_at) = (2.0 * void.radius, Some(void.at.into()));
        }
    }
}
