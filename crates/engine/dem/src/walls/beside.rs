//! Meshes of several walls that keep their places to each other: one surface, so that a particle on a seam between two touches it once.
//!
//! Each wall looks at the triangles of the others near a particle as at its own, in one order for all of them, and so comes to the same contacts;
//! it takes those that its own triangles bear.

use super::seams::{self, Nearest};
use super::{Surface, WallBody};
use geom::Vec3;

/// Finds out which walls are one surface: meshes that nothing but the same motion moves, and that no periodic face tears apart.
pub fn find(walls: &mut [WallBody], periodic: bool) {
    let joins = |w: &WallBody| {
        matches!(w.surface, Surface::Triangles { .. }) && !w.answers() && !(periodic && w.motion.moves())
    };
    for own in 0..walls.len() {
        let wall = &walls[own];
        let with = |&k: &usize| k != own && joins(&walls[k]) && walls[k].motion == wall.motion;
        let beside = if joins(wall) { (0..walls.len()).filter(with).collect() } else { Vec::new() };
        walls[own].beside = beside;
    }
}

/// As [`seams::count`], with the triangles of the walls beside wall number `own`. `image`: of the k-th of its triangles, the number of its partner, and
/// the centre of the particle as its image sees it [m].
pub fn count(
    walls: &[WallBody],
    own: usize,
    near: &mut [Nearest],
    image: impl Fn(usize) -> (u32, Vec3),
    (radius, reach): (f64, f64),
) {
    let limit = seams::limit(radius, reach);
    if !near.iter().any(|n| n.is_within(limit)) {
        return;
    }
    let parts = walls[own].parts();
    let mut all: Vec<(Nearest, Option<usize>)> = Vec::new();
    for wall in (0..walls.len()).filter(|w| *w == own || walls[own].beside.contains(w)) {
        if wall == own {
            all.extend(near.iter().enumerate().map(|(k, n)| (*n, Some(k))));
            continue;
        }
        let Surface::Triangles { corners, .. } = &walls[wall].surface else { continue };
        let mut last = None;
        for k in 0..near.len() {
            let (partner, centre) = image(k);
            // Triangles of one image follow each other.
            if last.replace(partner / parts) == Some(partner / parts) {
                continue;
            }
            let add = |part: u32| all.push((Nearest::of(corners[part as usize], centre), None));
            // A little farther, so that what is at the limit is found by all of them.
            walls[wall].parts_near(centre, limit * (1.0 + 1e-9), partner >= parts, add);
        }
    }
    let mut together: Vec<Nearest> = all.iter().map(|a| a.0).collect();
    seams::count(&mut together, radius, reach);
    for (of, (_, slot)) in together.iter().zip(&all) {
        if let Some(k) = slot {
            near[*k] = *of;
        }
    }
}
