//! The voids of a surface that are wider than wanted.

use super::{SparseSearch, Surface};
use crate::holes::surface::sheet::widest_gap;
use geom::star::{StarScratch, Void, voids};
use geom::{Cells, Vec3};
use rayon::prelude::*;
use std::collections::HashMap;

/// Points that one thread takes at a time.
const PART: usize = 256;
/// The middle of a void is inside when the points within two radii leave no wider gap around it [degrees].
const GAP: f64 = 150.0;

/// A void of the surface.
pub(super) struct SurfaceVoid {
    /// Numbers of its three points, in the order of the cells.
    pub corners: [u32; 3],
    /// Radius of the circle; of an edge that is halved, half its length [m].
    pub radius: f64,
    /// Where a point would come, on the plane [m].
    pub at: Vec3,
    /// Normal of the plane.
    pub normal: Vec3,
    /// Whether `at` is the middle of the circle, and the surface lies all around it.
    pub is_inside: bool,
}

/// The voids around the `active` points, each once; `limits` gives, for the mean α of the corners, the least and the largest radius [m].
pub(super) fn find(
    surface: &Surface,
    active: &[u32],
    search: &SparseSearch,
    limits: &(dyn Fn(f64) -> (f64, f64) + Sync),
) -> Vec<SurfaceVoid> {
    if active.is_empty() {
        return Vec::new();
    }
    let cells = Cells::new(&surface.points, search.spacing);
    let order = cells.order();
    let mut slots = vec![0u32; order.len()];
    (0u32..).zip(order).for_each(|(slot, &i)| slots[i as usize] = slot);
    let look = |part: &[u32]| {
        let mut work = StarScratch::default();
        let mut found: Vec<(Void, Vec3)> = Vec::new();
        for &i in part {
            let (least, most) = limits(surface.widest[i as usize]);
            let (normal, around) = voids(&cells, slots[i as usize], most, &mut work);
            found.extend(around.into_iter().filter(|void| void.radius > least).map(|void| (void, normal)));
        }
        found
    };
    let found: Vec<Vec<(Void, Vec3)>> = active.par_chunks(PART).map(look).collect();
    let mut found: Vec<(Void, Vec3)> = found.into_iter().flatten().collect();
    for (void, _) in &mut found {
        void.corners = void.corners.map(|slot| order[slot as usize]);
        void.corners.sort_unstable();
    }
    // Seen from two or three corners: the first in the order of the active points counts.
    found.sort_by_key(|(void, _)| void.corners);
    found.dedup_by_key(|(void, _)| void.corners);
    let place = |(void, normal): &(Void, Vec3)| place(surface, &cells, void, *normal, limits);
    let placed: Vec<Option<SurfaceVoid>> = found.par_iter().map(place).collect();
    let in_region =
        |v: &SurfaceVoid| search.regions.is_empty() || search.regions.iter().any(|s| s.contains(&v.at));
    placed.into_iter().flatten().filter(in_region).collect()
}

/// Where a void of the surface gets its point; none for one that is too wide or too small.
fn place(
    surface: &Surface,
    cells: &Cells,
    void: &Void,
    normal: Vec3,
    limits: &(dyn Fn(f64) -> (f64, f64) + Sync),
) -> Option<SurfaceVoid> {
    let mean = void.corners.iter().map(|&c| surface.widest[c as usize]).sum::<f64>() / 3.0;
    let (least, most) = limits(mean);
    if normal == Vec3::zeros() || void.radius > most {
        return None;
    }
    let (corners, radius, at) = (void.corners, void.radius, void.centre);
    if is_inside(surface, cells, void, &normal) {
        return Some(SurfaceVoid { corners, radius, at, normal, is_inside: true });
    }
    let [a, b, c] = corners.map(|c| surface.points[c as usize]);
    let longest = |best: (Vec3, Vec3), edge: (Vec3, Vec3)| {
        if (edge.0 - edge.1).norm_squared() > (best.0 - best.1).norm_squared() { edge } else { best }
    };
    let (p, q) = [(b, c), (a, c)].into_iter().fold((a, b), longest);
    let radius = 0.5 * (p - q).norm();
    (radius > least).then(|| SurfaceVoid { corners, radius, at: (p + q) * 0.5, normal, is_inside: false })
}

fn is_inside(surface: &Surface, cells: &Cells, void: &Void, normal: &Vec3) -> bool {
    let near = cells.grid.within(&surface.points, void.centre, 2.0 * void.radius);
    let offsets: Vec<Vec3> = near.map(|i| surface.points[i as usize] - void.centre).collect();
    widest_gap(&offsets, normal).is_some_and(|(gap, _)| gap <= GAP.to_radians())
}

/// Points that were added in this round, in cells as wide as the widest void.
pub(super) struct Fresh {
    width: f64,
    cells: HashMap<[i64; 3], Vec<Vec3>>,
}

impl Fresh {
    pub fn new(width: f64) -> Fresh {
        Fresh { width, cells: HashMap::new() }
    }

    fn cell(&self, p: &Vec3) -> [i64; 3] {
        [0, 1, 2].map(|a| (p[a] / self.width).floor() as i64)
    }

    pub fn add(&mut self, p: Vec3) {
        self.cells.entry(self.cell(&p)).or_default().push(p);
    }

    /// Whether a point is nearer than `distance` [m], at most the width of a cell.
    pub fn any(&self, p: &Vec3, distance: f64) -> bool {
        let [x, y, z] = self.cell(p);
        let beside = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let near = |q: &Vec3| (q - p).norm_squared() < distance * distance;
        beside.filter_map(|cell| self.cells.get(&cell)).flatten().any(near)
    }
}
