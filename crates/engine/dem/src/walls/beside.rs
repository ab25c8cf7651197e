//! Meshes of several walls that keep their places to each other: one surface, so that a particle on a seam between two touches it once.
//!
//! Each wall looks at the triangles of the others near a particle as at its own, in one order for all of them, and so comes to the same contacts;
//! it takes those that its own triangles bear.

use super::{Nearby, Triangles, WallBody};
use geom::Vec3;
use laws::contact::seams::{self, FARTHER, Member, Nearest};

/// Finds out which walls are one surface: meshes that nothing but the same motion moves, and that no periodic face tears apart.
pub fn find(walls: &mut [WallBody], periodic: bool) {
    let joins = |w: &WallBody| w.triangles().is_some() && !w.answers() && !(periodic && w.motion.moves());
    for own in 0..walls.len() {
        let wall = &walls[own];
        let with = |&k: &usize| k != own && joins(&walls[k]) && walls[k].motion == wall.motion;
        let beside = if joins(wall) { (0..walls.len()).filter(with).collect() } else { Vec::new() };
        walls[own].beside = beside;
    }
}

/// As [`seams::count`] of those in `nearby`, with the triangles of the walls beside wall number `own`. `image`: of the k-th of its triangles, the number of its
/// partner, and the centre of the particle as its image sees it [m].
pub fn count(
    walls: &[WallBody],
    own: usize,
    nearby: &mut Nearby,
    image: impl Fn(usize) -> (u32, Vec3),
    (radius, reach): (f64, f64),
) {
    let limit = seams::limit(radius, reach);
    let Nearby { near, together, order } = nearby;
    if !near.iter().any(|n| n.is_within(limit)) {
        return;
    }
    let (parts, count) = (walls[own].parts(), near.len());
    let mut first = 0;
    together.clear();
    for wall in (0..walls.len()).filter(|w| *w == own || walls[own].beside.contains(w)) {
        if wall == own {
            first = together.len();
            together.extend_from_slice(near);
            continue;
        }
        let Some(Triangles { corners, .. }) = walls[wall].triangles() else { continue };
        let mut last = None;
        for k in 0..count {
            let (partner, centre) = image(k);
            // Triangles of one image follow each other.
            if last.replace(partner / parts) == Some(partner / parts) {
                continue;
            }
            let add = |part: u32| together.push(Nearest::of(corners[part as usize], centre));
            walls[wall].parts_near(centre, limit * FARTHER, partner >= parts, add);
        }
    }
    order.resize(together.len(), Member::default());
    seams::count(together, order, radius, reach);
    near.copy_from_slice(&together[first..first + count]);
}
