//! Foretells from the height of the drop whether a first impact is deeper than the overlap guard allows.
//!
//! Grains fall from where they are, or come in, straight down until they touch the wall below them: v² = v₀² + 2 g h, of which the share along
//! the wall's normal is stopped. Later impacts, off other walls and onto grains, are not foretold.

use crate::advice::of_stiffness;
use crate::plan::Insertion;
use dem::setup::{Body, ClumpShape, Setup, Wall, WallShape, Zone};
use dem::{Impacting, deep_impact, mass};
use geom::{Shown, Vec3};

/// Grains that are followed: those that are highest, and as many others.
const FOLLOWED: usize = 32;
/// Faces and spheres of walls that are looked at for them all.
const LOOKED_AT: usize = 4_000_000;

/// A grain, or one that will come in.
#[derive(Clone, Copy)]
struct Start {
    position: Vec3,
    velocity: Vec3,
    /// How far below its position it touches [m].
    reach: f64,
    grain: Impacting,
}

/// Where a grain meets a wall.
struct Hit<'a> {
    /// How far it has fallen [m].
    height: f64,
    /// Share of its speed that is along the normal there [–].
    along: f64,
    wall: &'a Wall,
}

/// A warning for the deepest impact, where the guard would stop the run.
pub(in crate::plan) fn warning(setup: &Setup, insertions: &[Insertion]) -> Option<String> {
    let down = setup.gravity.try_normalize(0.0)?;
    let parts: usize = setup.walls.iter().map(parts).sum();
    let starts = starts(setup, insertions, &down);
    let most = (LOOKED_AT / parts.max(1)).clamp(1, starts.len().max(1));
    let impacts = starts.iter().step_by(starts.len().div_ceil(most).max(1)).filter_map(|start| {
        let walls = setup.walls.iter().filter(|w| !w.moves());
        let hits = walls.filter_map(|wall| fall(wall, start, &down));
        let hit = hits.min_by(|a, b| a.height.total_cmp(&b.height))?;
        if leaves(setup, start, &(down * hit.height)) {
            return None;
        }
        let along = start.velocity.dot(&down);
        // Local damping takes its share of the weight of what falls.
        let pull = setup.gravity.norm() * (1.0 - setup.local_damping.unwrap_or(0.0));
        let speed = hit.along * (along * along + 2.0 * pull * hit.height).sqrt();
        Some((deep_impact(setup, hit.wall, &start.grain, speed)?, hit))
    });
    let (impact, hit) = impacts.max_by(|a, b| a.0.share.total_cmp(&b.0.share))?;
    let (share, limit) = (100.0 * impact.share, 100.0 * setup.guards.overlap);
    Some(format!(
        "grains of radius {} m fall {:.3} m onto wall '{}' and would overlap it by {share:.0} % of their radius, where guards.overlap \
         ({limit:.0} %) stops the run: stiffen the material{}, or let them fall less deep",
        Shown(impact.radius),
        hit.height,
        hit.wall.name,
        of_stiffness(Some(&impact.stiffer))
    ))
}

/// Whether a grain that falls this way is removed at the end of an outlet's zone before it is there.
fn leaves(setup: &Setup, start: &Start, way: &Vec3) -> bool {
    let past = |zone: &Zone, at: &Vec3| zone.past(at, start.grain.radius) > zone.length;
    let meets = |zone: &&Zone| !past(zone, &start.position) && past(zone, &(start.position + way));
    setup.outlets.iter().any(|zone| meets(&zone))
}

/// Where grains start: the highest, others evenly among the rest, and what each insertion brings in the middle of where it becomes free.
fn starts(setup: &Setup, insertions: &[Insertion], down: &Vec3) -> Vec<Start> {
    let density = |material: u16| setup.materials[material as usize].density;
    let sphere = |material: u16, radius: f64, position: Vec3, velocity: Vec3| Start {
        position,
        velocity,
        reach: radius,
        grain: Impacting { material, radius, mass: mass(radius, density(material)) },
    };
    let clump = |shape: &ClumpShape, scale: f64| Impacting {
        material: shape.material,
        radius: shape.radii().1 * scale,
        mass: shape.mass(scale, density(shape.material)),
    };
    let body = |b: &Body| {
        let shape = &setup.clumps.shapes[b.shape as usize];
        let below = |(centre, radius): (Vec3, f64)| (centre - b.position).dot(down) + radius;
        let reach = shape.spheres_at(b.position, &b.orientation, b.scale).map(below).fold(0.0, f64::max);
        Start { position: b.position, velocity: b.velocity, reach, grain: clump(shape, b.scale) }
    };
    let coming = insertions.iter().flat_map(|i| &i.feeds).flat_map(|feed| {
        let (position, velocity) = feed.leaves();
        feed.sizes().map(move |coming| {
            let start = sphere(coming.material, coming.radius, position, velocity);
            let Some((shape, scale)) = coming.clump else { return start };
            let shape = &setup.clumps.shapes[shape as usize];
            // Turned at random: the sphere that touches first may be the next to the middle.
            Start { reach: 0.0, grain: clump(shape, scale), ..start }
        })
    });
    let (particles, placed) = (&setup.particles, &setup.clumps.placed);
    let free = some(particles, |p| p.position.dot(down));
    let all = free.map(|p| sphere(p.material, p.radius, p.position, p.velocity));
    all.chain(some(placed, |b| b.position.dot(down)).map(body)).chain(coming).collect()
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

/// Where a grain first meets the wall on its way down.
fn fall<'a>(wall: &'a Wall, start: &Start, down: &Vec3) -> Option<Hit<'a>> {
    let (from, reach) = (&start.position, start.reach);
    let hit = |height: f64, along: f64| Hit { height: height.max(0.0), along, wall };
    // A sphere meets a face that lies aslant before its centre is so far above it.
    let face = |height: f64, along: f64| hit(height - reach / along, along);
    match &wall.shape {
        WallShape::Plane(plane) => {
            let toward = -plane.normal.dot(down);
            let height = plane.signed_distance(from) / toward;
            (toward > 0.0 && height >= 0.0).then(|| face(height, toward))
        }
        WallShape::Mesh(mesh) => {
            let corner = |v: u32| mesh.vertices.get(v as usize);
            let corners = |f: &[u32; 3]| Some([corner(f[0])?, corner(f[1])?, corner(f[2])?]);
            let hits = mesh.faces.iter().filter_map(|f| {
                let [a, b, c] = corners(f)?;
                let height = through([a, b, c], from, down)?;
                let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
                Some(face(height, normal.dot(down).abs()))
            });
            hits.min_by(|a, b| a.height.total_cmp(&b.height))
        }
        WallShape::Spheres(spheres) => {
            let hits = spheres.iter().filter_map(|(centre, radius)| {
                let (to, apart) = (centre - from, radius + reach);
                let along = to.dot(down);
                let depth = apart * apart - (to - down * along).norm_squared();
                let above = depth.sqrt();
                (depth > 0.0 && along > 0.0).then(|| hit(along - above, above / apart))
            });
            hits.min_by(|a, b| a.height.total_cmp(&b.height))
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
