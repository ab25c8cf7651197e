//! Rebound of a grain without friction that comes down on a wall of spheres.
//!
//! ```text
//! v' = v − (1 + e)(v·n) n,   sin θ = d/(R + r)      θ: tilt of n, d: distance from the axis of the sphere it hits
//! upward speed over speed of impact:   (1 + e) cos² θ − 1
//! square lattice of spacing P:         ⟨sin² θ⟩ = P²/6(R + r)²          (⟨d²⟩ over the cell)
//! height of the grain's centre:        √((R + r)² − d²)
//! ```

use super::chance::places;
use super::plates::{still, touch};
use dem::Simulation;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::setups::{Law, empty, grain};

/// Speed of impact [m/s].
const SPEED: f64 = 0.5;
/// Stiff: a grain does not get far while it touches [N/m].
const STIFFNESS: f64 = 1e8;

/// One impact.
#[derive(Debug, Clone, Copy)]
pub struct Impact {
    /// Upward speed over speed of impact [–].
    pub upward: f64,
    /// Upward speed over speed of impact by the formula for one sphere [–].
    pub closed: f64,
    /// Height of the centre at touch over that on top of a sphere [m].
    pub height: f64,
    /// Whether the second nearest sphere was touched as well.
    pub double: bool,
}

/// Impacts of `count` grains of radius `r` [m] at chance places of a square of `width` [m], four grain radii apart.
///
/// # Panics
/// When a guard trips, or a place is beside the wall.
pub fn impacts(spheres: &[(Vec3, f64)], e: f64, r: f64, field: (f64, usize)) -> Vec<Impact> {
    impacts_in(Precision::Double, spheres, e, r, field)
}

/// The same in any precision.
///
/// # Panics
/// As [`impacts`].
pub fn impacts_in(
    precision: Precision,
    spheres: &[(Vec3, f64)],
    e: f64,
    r: f64,
    (width, count): (f64, usize),
) -> Vec<Impact> {
    let (mut starts, mut expected) = (Vec::new(), Vec::new());
    for (x, y) in places(width, 4.0 * r, count) {
        let (z, hit) = touch(spheres, r, x, y).expect("on the wall");
        let (centre, radius) = spheres[hit];
        let sine = ((centre.x - x).powi(2) + (centre.y - y).powi(2)) / (radius + r).powi(2);
        expected.push(((1.0 + e) * (1.0 - sine) - 1.0, z - centre.z - radius - r));
        starts.push(Vec3::new(x, y, z + 1e-7));
    }
    let down = vec![-Vec3::z() * SPEED; starts.len()];
    let after = rebounded(precision, spheres, (e, r), &starts, &down);
    let one = |((v, start), (closed, height)): ((&Vec3, &Vec3), (f64, f64))| {
        let deep = |s: &&(Vec3, f64)| (s.0 - start).norm() < s.1 + r + 2.0 * SPEED * contact(r);
        let double = spheres.iter().filter(deep).count() > 1;
        Impact { upward: v.z / SPEED, closed, height, double }
    };
    after.iter().zip(&starts).zip(expected).map(one).collect()
}

/// Velocities [m/s] of grains of radius `r` [m] after they have hit the wall.
fn rebounded(
    precision: Precision,
    spheres: &[(Vec3, f64)],
    (e, r): (f64, f64),
    starts: &[Vec3],
    velocities: &[Vec3],
) -> Vec<Vec3> {
    let mut setup = empty(Law::Hooke { stiffness: STIFFNESS, tangential_ratio: None }, e);
    setup.precision = precision;
    setup.walls = vec![still(spheres)];
    setup.step = Step::Auto(0.01);
    let one = |(k, (from, velocity)): (usize, (&Vec3, &Vec3))| Particle {
        radius: r,
        velocity: *velocity,
        ..grain(k as u32, *from)
    };
    setup.particles = starts.iter().zip(velocities).enumerate().map(one).collect();
    let mut sim = Simulation::new(setup).expect("sound");
    // A dashpot makes a contact longer.
    while sim.time() < 3.0 * contact(r) + 2e-7 / SPEED {
        sim.step().expect("no guard");
    }
    sim.particles().expect("no guard").iter().map(|p| p.velocity).collect()
}

/// Duration of a contact without dashpot [s]: half a period of mass and spring.
fn contact(r: f64) -> f64 {
    std::f64::consts::PI * (dem::mass(r, 2500.0) / STIFFNESS).sqrt()
}

/// Mean of upward over impact speed on a square lattice of spacing `p` [m], spheres of radius `big`, grains of radius `r` [m].
pub fn on_a_square_lattice(e: f64, p: f64, big: f64, r: f64) -> f64 {
    (1.0 + e) * (1.0 - p * p / (6.0 * (big + r).powi(2))) - 1.0
}

/// Inward over impact speed of grains of radius `r` that hit a half pipe of radius `pipe` [m] along its radius, at chance places of its
/// lower part, of length `width` [m].
///
/// # Panics
/// When a guard trips.
pub fn on_a_pipe(
    spheres: &[(Vec3, f64)],
    e: f64,
    (r, pipe): (f64, f64),
    (width, count): (f64, usize),
) -> Vec<f64> {
    let mut inward = Vec::new();
    let grains = places(width, 4.0 * r, count);
    // One at a time would do; all at once is faster, and they are far apart.
    let ways: Vec<(Vec3, Vec3)> = grains
        .iter()
        .map(|&(x, s)| {
            let (sin, cos) = (s / pipe).sin_cos();
            (Vec3::new(x, 0.0, 0.0), Vec3::new(0.0, sin, -cos))
        })
        .collect();
    let starts: Vec<Vec3> =
        ways.iter().map(|(axis, out)| axis + out * meets(spheres, r, axis, out)).collect();
    let speeds: Vec<Vec3> = ways.iter().map(|w| w.1 * SPEED).collect();
    let after = rebounded(Precision::Double, spheres, (e, r), &starts, &speeds);
    for (velocity, (_, out)) in after.iter().zip(&ways) {
        inward.push(-velocity.dot(out) / SPEED);
    }
    inward
}

/// How far [m] from a point along a unit direction a grain of radius `r` [m] comes before it touches.
fn meets(spheres: &[(Vec3, f64)], r: f64, from: &Vec3, way: &Vec3) -> f64 {
    let one = |(centre, radius): &(Vec3, f64)| {
        let to = centre - from;
        let (along, reach) = (to.dot(way), radius + r);
        let left = reach * reach - (to - way * along).norm_squared();
        (left > 0.0 && along > 0.0).then(|| along - left.sqrt())
    };
    spheres.iter().filter_map(one).fold(f64::INFINITY, f64::min) - 1e-7
}
