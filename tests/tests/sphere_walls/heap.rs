//! A heap on a wall of spheres against the same on a flat wall.
//!
//! There is no closed answer for how far a column of grains spreads, so that the heaps are compared over several starts: on spheres
//! that are nearly flat as on the plane, within what chance makes of it; on rough ones, whose pockets hold a grain up to
//! tan α = s/H whatever it rubs by (see `holding.rs`), a heap stands that slides apart on the plane.

use crate::of_walls;
use crate::sphere_walls::chance::{Chance, Mean, mean};
use crate::sphere_walls::plates::{Layout, spheres, still};
use dem::Simulation;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::findings::Case;
use grainpipe_tests::setups::{Law, empty, grain, plane, with_friction};
use sampling::Method;

const P: f64 = 0.01;
const R: f64 = 0.006;
const SAME: Case = of_walls(
    "a heap spreads on a wall of spheres with ζ/P = 0.005 as on a flat wall: difference over both 95 % intervals",
);
const STANDS: Case = of_walls(
    "a heap that slides apart on a flat wall stands on a rough wall of spheres: spread over spread on the flat wall",
);

/// A column of grains on a wall up to a height [m] that is let go: the mean distance of its grains from its axis when they have come to
/// rest [m].
fn spread((wall, top): (Wall, f64), friction: f64, seed: u64) -> f64 {
    let mut setup = with_friction(empty(Law::Hooke { stiffness: 2e3, tangential_ratio: None }, 0.3), 0.5);
    setup.contacts.iter_mut().for_each(|c| c.set("rolling_resistance", 0.2));
    setup.contacts[1].set("sliding_friction", friction);
    setup.gravity.z = -9.81;
    setup.step = Step::Auto(0.8);
    setup.walls = vec![wall];
    let mut chance = Chance::new(seed);
    let mut near = |at: f64| at + 0.1 * R * chance.between(-1.0, 1.0);
    setup.particles = (0..72u32)
        .map(|k| {
            let at = |n: u32| 2.25 * R * (f64::from(n) - 1.0);
            let (x, y) = (near(at(k % 3)), near(at(k / 3 % 3)));
            Particle { radius: R, ..grain(k, Vec3::new(x, y, top + 1.4 * R + 2.25 * R * f64::from(k / 9))) }
        })
        .collect();
    let mut sim = Simulation::new(setup).expect("sound");
    while sim.time() < 1.0 {
        sim.step().expect("no guard");
    }
    let all = sim.particles().expect("no guard");
    assert!(all.iter().all(|p| p.position.z > 0.5 * top), "none is lost");
    all.iter().map(|p| p.position.x.hypot(p.position.y)).sum::<f64>() / all.len() as f64
}

/// How many starts.
const STARTS: u64 = 16;

fn of(wall: &(Wall, f64), friction: f64) -> Mean {
    mean(&(0..STARTS).map(|seed| spread(wall.clone(), friction, seed)).collect::<Vec<f64>>())
}

fn rough(share: f64) -> (Wall, f64) {
    let points = Layout::Sampled(Method::Poisson, 1).points(P, 0.6);
    let spheres = spheres(&points, share * P, 2.0 * R).0;
    let top = spheres.iter().map(|s| s.0.z + s.1).fold(0.0, f64::max);
    (still(&spheres), top)
}

#[test]
fn a_heap_on_spheres_spreads_as_on_a_flat_wall() {
    let flat = (plane(Vec3::z()), 0.0);
    let (on_flat, on_spheres) = (of(&flat, 0.5), of(&rough(0.005), 0.5));
    let off = (on_spheres.mean - on_flat.mean) / (on_spheres.off + on_flat.off);
    SAME.within("72 grains, μ = 0.5, 16 starts", off, "of both intervals", 1.0);
    let (on_flat, on_spheres) = (of(&flat, 0.02), of(&rough(0.3), 0.02));
    STANDS.within("72 grains, μ = 0.02 on the wall, ζ/P = 0.3", on_spheres.mean / on_flat.mean, "–", 0.7);
}
