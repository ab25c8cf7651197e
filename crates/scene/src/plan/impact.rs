//! Foretells from the height of the drop whether a first impact is deeper than the overlap guard allows.
//!
//! Grains fall from where they are, or come in, straight down to the wall below them: v² = v₀² + 2 g h. Later impacts, off other walls and
//! onto grains, are not foretold.

use super::Insertion;
use crate::advice::of_stiffness;
use dem::deep_impact;
use dem::setup::{Body, Particle, Setup, Wall, WallShape};
use geom::{Shown, Vec3};

/// Grains that are followed: those that are highest, and as many others.
const FOLLOWED: usize = 32;
/// Faces and spheres of walls that are looked at for them all.
const LOOKED_AT: usize = 4_000_000;

/// A grain, or one that will come in.
struct Start {
    position: Vec3,
    velocity: Vec3,
}

/// A warning for the deepest impact, where the guard would stop the run.
pub(super) fn warning(setup: &Setup, insertions: &[Insertion]) -> Option<String> {
    let down = setup.gravity.try_normalize(0.0)?;
    let parts: usize = setup.walls.iter().map(parts).sum();
    let starts = starts(setup, insertions, &down);
    let most = (LOOKED_AT / parts.max(1)).clamp(1, starts.len().max(1));
    let mut worst: Option<(f64, String)> = None;
    for start in starts.iter().step_by(starts.len().div_ceil(most).max(1)) {
        let below = |wall: &&Wall| Some((fall(wall, &start.position, &down)?, (*wall).clone()));
        let hit = setup
            .walls
            .iter()
            .filter(|w| !w.moves())
            .filter_map(|w| below(&w))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((height, wall)) = hit else { continue };
        let along = start.velocity.dot(&down);
        // Local damping takes its share of the weight of what falls.
        let pull = setup.gravity.norm() * (1.0 - setup.local_damping.unwrap_or(0.0));
        let speed = (along * along + 2.0 * pull * height).sqrt();
        let Some(impact) = deep_impact(setup, &wall, speed) else { continue };
        if worst.as_ref().is_none_or(|w| impact.share > w.0) {
            let (share, limit) = (100.0 * impact.share, 100.0 * setup.guards.overlap);
            let text = format!(
                "grains of radius {} m fall {height:.3} m onto wall '{}' and would overlap it by {share:.0} % of their radius, where guards.overlap \
                 ({limit:.0} %) stops the run: stiffen the material{}, or let them fall less deep",
                Shown(impact.radius),
                wall.name,
                of_stiffness(Some(&impact.stiffer))
            );
            worst = Some((impact.share, text));
        }
    }
    worst.map(|(_, text)| text)
}

/// Where grains start: the highest, others evenly among the rest, and the middle of each insertion.
fn starts(setup: &Setup, insertions: &[Insertion], down: &Vec3) -> Vec<Start> {
    let grain = |p: &Particle| Start { position: p.position, velocity: p.velocity };
    let clump = |b: &Body| Start { position: b.position, velocity: b.velocity };
    let coming = insertions.iter().flat_map(|i| &i.feeds).map(|feed| {
        let (position, velocity) = feed.leaves();
        Start { position, velocity }
    });
    let (particles, placed) = (&setup.particles, &setup.clumps.placed);
    let all = some(particles, |p| p.position.dot(down)).map(grain);
    all.chain(some(placed, |b| b.position.dot(down)).map(clump)).chain(coming).collect()
}

/// The lowest by a key, and as many others evenly among the rest.
fn some<T>(all: &[T], key: impl Fn(&T) -> f64) -> impl Iterator<Item = &T> {
    let mut order: Vec<(f64, usize)> = all.iter().map(key).zip(0..).collect();
    if order.len() > FOLLOWED {
        order.select_nth_unstable_by(FOLLOWED, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    }
    let rest = order.len().saturating_sub(FOLLOWED).div_ceil(FOLLOWED).max(1);
    let among =
        move |(k, (_, at)): (usize, (f64, usize))| (k < FOLLOWED || k.is_multiple_of(rest)).then(|| &all[at]);
    order.into_iter().enumerate().filter_map(among)
}

fn parts(wall: &Wall) -> usize {
    match &wall.shape {
        WallShape::Plane(_) => 1,
        WallShape::Mesh(mesh) => mesh.faces.len(),
        WallShape::Spheres(spheres) => spheres.len(),
    }
}

/// How far a point falls until it meets the wall [m].
fn fall(wall: &Wall, from: &Vec3, down: &Vec3) -> Option<f64> {
    match &wall.shape {
        WallShape::Plane(plane) => {
            let toward = -plane.normal.dot(down);
            let height = plane.signed_distance(from) / toward;
            (toward > 0.0 && height >= 0.0).then_some(height)
        }
        WallShape::Mesh(mesh) => {
            let corner = |v: u32| mesh.vertices.get(v as usize);
            let face = |f: &[u32; 3]| Some([corner(f[0])?, corner(f[1])?, corner(f[2])?]);
            let heights = mesh.faces.iter().filter_map(|f| through(face(f)?, from, down));
            heights.min_by(f64::total_cmp)
        }
        WallShape::Spheres(spheres) => {
            let height = |(centre, radius): &(Vec3, f64)| {
                let to = centre - from;
                let along = to.dot(down);
                let aside = (to - down * along).norm_squared();
                let depth = radius * radius - aside;
                (depth > 0.0 && along > 0.0).then(|| (along - depth.sqrt()).max(0.0))
            };
            spheres.iter().filter_map(height).min_by(f64::total_cmp)
        }
    }
}

/// Where a line meets a triangle, seen from its start (Möller, Trumbore 1997, doi:10.1080/10867651.1997.10487468).
fn through([a, b, c]: [&Vec3; 3], from: &Vec3, along: &Vec3) -> Option<f64> {
    let (ab, ac, to) = (b - a, c - a, from - a);
    let across = along.cross(&ac);
    let volume = ab.dot(&across);
    let side = to.cross(&ab);
    let (u, v) = (to.dot(&across) / volume, along.dot(&side) / volume);
    let height = ac.dot(&side) / volume;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && height >= 0.0).then_some(height)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_meets_a_triangle_inside_it_alone() {
        let [a, b, c] = [Vec3::new(0.0, 0.0, 1.0), Vec3::new(1.0, 0.0, 1.0), Vec3::new(0.0, 1.0, 2.0)];
        let down = -Vec3::z();
        let at = |x, y| through([&a, &b, &c], &Vec3::new(x, y, 5.0), &down);
        assert!((at(0.25, 0.5).unwrap() - 3.5).abs() < 1e-12);
        assert_eq!((at(0.6, 0.6), at(-0.1, 0.1)), (None, None));
        assert_eq!(through([&a, &b, &c], &Vec3::new(0.2, 0.2, 0.0), &down), None, "it is above");
    }
}
