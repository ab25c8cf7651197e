//! The tilt up to which a wall of spheres holds a grain.
//!
//! A grain of radius r at rest lies in a pocket, on three spheres of radius R. Without friction it stays while the vertical through
//! its centre passes between the three; as a rolling grain with any friction does, for over two spheres it rolls:
//!
//! ```text
//! H = √((R + r)² − c²)            height of the grain's centre over the plane of the three, c their circle's radius
//! tan α = s(u)/H                  s(u): way from the circle's middle to the side of the triangle, along the tilt u
//! tan α ≤ c/H                     bound, for every u: the steepest slope that the grain's centre can meet
//! ```
//!
//! A grain that cannot roll slides along the trough between two spheres at distance P, whose sides wedge it:
//!
//! ```text
//! α = arctan(s/H) + arctan(μ/cos β),   sin β = P/2(R + r)              u square to the side
//! ```

use super::plates::still;
use dem::Simulation;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::setups::{Law, empty, grain};

/// Speed of a grain at rest [√(r g)].
const AT_REST: f64 = 1e-5;
/// How often 60 √(r/g) are waited for all to be at rest.
const MOST_WAITS: u32 = 20;
/// Two surfaces as near as this touch, in grain radii.
const TOUCH: f64 = 1e-3;
/// A fourth sphere that is nearer than this, in grain radii, makes one hollow of two pockets: a grain that leaves the first may stop in
/// the second, hardly farther on.
const BESIDE: f64 = 0.2;
/// How a grain is kept from rolling: μ_r [–], above μ r/R* of every wall here.
const BLOCKED: f64 = 1.5;

/// A grain on a wall, and how it may move.
#[derive(Debug, Clone, Copy)]
pub struct Grain {
    /// Radius [m].
    pub radius: f64,
    /// μ [–]; `None`: no friction.
    pub friction: Option<f64>,
    /// Whether it is kept from rolling.
    pub blocked: bool,
}

/// How a wall is tilted.
#[derive(Debug, Clone, Copy)]
pub struct Tilting {
    /// Way down, from x [rad].
    pub azimuth: f64,
    /// Where tilts begin [rad].
    pub from: f64,
    /// How much is added each time [rad].
    pub step: f64,
    /// Time at each tilt, in √(r/g): in 12 a grain that is 1° too steep goes 1.2 r, in 6 a quarter of that.
    pub wait: f64,
    /// Of the contacts [N/m]. The spring of friction is new at each tilt, and a grain gives way by μ F/k_t until it holds: soft
    /// contacts are fast, and grains leave a little early.
    pub stiffness: f64,
}

/// Tilt [rad] at which each grain leaves the pocket it has come to rest in: π/2 for one that never does, the first tilt for one that
/// fell through. `places` [m] are where the grains come down. Also where they rested.
///
/// # Panics
/// When a guard trips.
pub fn leaving_tilts(
    spheres: &[(Vec3, f64)],
    kind: Grain,
    places: &[(f64, f64)],
    Tilting { azimuth, from, step, wait, stiffness }: Tilting,
) -> Vec<(Vec3, f64)> {
    // Down in its pocket by itself: what rubs could hold it up on the way.
    let mut setup = laid(spheres, kind.radius, stiffness, places);
    let floor = spheres.iter().map(|(c, r)| c.z - r).fold(f64::INFINITY, f64::min) - kind.radius;
    let Settled { grains: settled, held } = come_to_rest(setup.clone(), floor);
    for contact in &mut setup.contacts {
        contact.set("sliding_friction", kind.friction);
        contact.set("rolling_resistance", kind.blocked.then_some(BLOCKED));
    }
    let mut left = vec![std::f64::consts::FRAC_PI_2; held];
    left.resize(settled.len(), from);
    let mut now = settled.clone();
    let far = 0.5 * kind.radius.min(spheres[0].1);
    let mut tilt = from;
    while tilt < 80f64.to_radians() && left.iter().any(|&a| a > tilt) {
        tilt += step;
        let (sin, cos) = tilt.sin_cos();
        setup.gravity = 9.81 * Vec3::new(sin * azimuth.cos(), sin * azimuth.sin(), -cos);
        // Grains that have left are put back: they could push others.
        let still_there = |k: &usize| left[*k] > tilt;
        let there: Vec<usize> = (0..now.len()).filter(still_there).collect();
        setup.particles = there.iter().map(|&k| now[k]).collect();
        let after = rested(&setup, wait);
        for (&k, p) in there.iter().zip(&after) {
            now[k] = *p;
            if (p.position - settled[k].position).norm() > far {
                left[k] = tilt;
            }
        }
    }
    settled.iter().map(|p| p.position).zip(left).collect()
}

/// Grains a little above the wall.
fn laid(spheres: &[(Vec3, f64)], radius: f64, stiffness: f64, places: &[(f64, f64)]) -> Setup {
    let mut setup = empty(Law::Hooke { stiffness, tangential_ratio: None }, 0.1);
    setup.gravity = Vec3::new(0.0, 0.0, -9.81);
    setup.walls = vec![still(spheres)];
    setup.step = Step::Auto(0.7);
    // Over an open gap nothing holds a grain: it is left out.
    let down = |(k, &(x, y)): (usize, &(f64, f64))| {
        let (z, _) = super::plates::touch(spheres, radius, x, y)?;
        Some(Particle { radius, ..grain(k as u32, Vec3::new(x, y, z + 0.01 * radius)) })
    };
    setup.particles = places.iter().enumerate().filter_map(down).collect();
    setup
}

/// The grains once none moves, as far as that comes soon, and at the end those that fell through the wall below `floor` [m].
fn come_to_rest(mut setup: Setup, floor: f64) -> Settled {
    let mut fallen = Vec::new();
    for _ in 0..MOST_WAITS {
        setup.particles = rested(&setup, 60.0);
        // One that fell on would soon be faster than the step allows.
        fallen.extend(setup.particles.extract_if(.., |p| p.position.z < floor));
        let slow = |p: &Particle| p.velocity.norm() < AT_REST * (9.81 * p.radius).sqrt();
        if setup.particles.iter().all(slow) {
            break;
        }
    }
    let held = setup.particles.len();
    Settled { grains: [setup.particles, fallen].concat(), held }
}

/// Grains on a wall.
struct Settled {
    /// First those that it holds.
    grains: Vec<Particle>,
    held: usize,
}

/// The grains after a time [√(r/g)].
fn rested(setup: &Setup, time: f64) -> Vec<Particle> {
    let radius = setup.particles.first().map_or(1.0, |p| p.radius);
    let mut sim = Simulation::new(setup.clone()).expect("sound");
    while sim.time() < time * (radius / 9.81).sqrt() {
        sim.step().expect("no guard");
    }
    sim.particles().expect("no guard")
}

/// Tilt [rad] at which a grain of radius `r` [m] leaves its pocket without friction, by the formula; `None` where no three spheres
/// hold it, or a fourth is almost as near. `at` is where it rests.
pub fn closed_tilt(spheres: &[(Vec3, f64)], r: f64, at: Vec3, azimuth: f64) -> Option<f64> {
    let (corners, height, foot) = support(spheres, r, at)?;
    let way = Vec3::new(azimuth.cos(), azimuth.sin(), 0.0);
    // Way to each side of what it rests on; the first that is met holds no longer.
    let sides = (0..corners.len()).filter_map(|k| {
        let (p, q) = (corners[k], corners[(k + 1) % corners.len()]);
        let outward = (q - p).cross(&Vec3::z()).normalize();
        let (gap, speed) = (outward.dot(&(p - foot)), outward.dot(&way));
        (speed > 1e-9).then(|| gap / speed)
    });
    let s = sides.fold(f64::INFINITY, f64::min);
    (s > 0.0 && s.is_finite()).then(|| (s / height).atan())
}

/// Centres of the spheres that a grain rests on, counterclockwise, its height above them, and its foot among them; `None` where another
/// one is almost as near.
fn support(spheres: &[(Vec3, f64)], r: f64, at: Vec3) -> Option<(Vec<Vec3>, f64, Vec3)> {
    let nearer = |gap: f64| move |s: &&(Vec3, f64)| (s.0 - at).norm() - s.1 - r < gap * r;
    let mut corners: Vec<Vec3> = spheres.iter().filter(nearer(TOUCH)).map(|s| s.0).collect();
    let foot = Vec3::new(at.x, at.y, corners.first()?.z);
    let angle = |c: &Vec3| (c.y - foot.y).atan2(c.x - foot.x);
    corners.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    let beside = spheres.iter().filter(nearer(BESIDE)).count();
    (corners.len() >= 3 && beside == corners.len()).then_some((corners, at.z - foot.z, foot))
}

/// Tilt [rad] at which a grain that cannot roll leaves a pocket of a square lattice of spacing `p` across a side, by the formula; spheres
/// of radius `big`, the grain's radius `r` [m].
pub fn blocked_tilt(p: f64, big: f64, r: f64, friction: f64) -> f64 {
    let reach = big + r;
    let height = (reach * reach - 0.5 * p * p).sqrt();
    let wedge = (1.0 - (0.5 * p / reach).powi(2)).sqrt();
    (0.5 * p / height).atan() + (friction / wedge).atan()
}

/// The largest arctan(c/H) [rad] of the pockets of three spheres, with no other near, that grains of radius `r` [m] rest in.
pub fn bound(spheres: &[(Vec3, f64)], r: f64, grains: &[(Vec3, f64)]) -> f64 {
    let steepest = |(at, _): &(Vec3, f64)| {
        let (corners, height, foot) = support(spheres, r, *at)?;
        Some(((corners[0] - foot).xy().norm() / height).atan())
    };
    grains.iter().filter_map(steepest).fold(0.0, f64::max)
}
