//! What passes a wall of spheres: wallgen's check against grains that fall.
//!
//! ```text
//! square lattice        d = √2 P − 2R            closed from ζ/P = (√2 − 1)/2 = 0.207 down, by equation (1)
//! Poisson disk          d ≤ 2 (s − R)            s: spacing of the sampling; no place is farther than s from a point
//! ```

use super::chance::places;
use super::plates::{still, touch};
use dem::Simulation;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::setups::{Law, empty, grain};

/// Speed that grains come down with, at most [m/s].
const FALL: f64 = 0.3;

/// Whether each of these grains, radius and centre [m], falls through: it is let go above a wall and is looked for below
/// after `time` [s]. At `soft` of a radius of overlap a grain stops that falls on the wall: so much larger ones are squeezed through.
///
/// # Panics
/// When a guard trips.
pub fn passes(spheres: &[(Vec3, f64)], grains: &[(Vec3, f64)], (time, soft): (f64, f64)) -> Vec<bool> {
    let least = grains.iter().map(|g| g.1).fold(f64::INFINITY, f64::min);
    let stiffness = dem::mass(least, 2500.0) * (FALL / (soft * least)).powi(2);
    let mut setup = empty(Law::Hooke { stiffness, tangential_ratio: None }, 0.3);
    setup.gravity.z = -9.81;
    setup.walls = vec![still(spheres)];
    setup.step = Step::Auto(0.5);
    let one = |(k, &(place, radius)): (usize, &(Vec3, f64))| Particle { radius, ..grain(k as u32, place) };
    setup.particles = grains.iter().enumerate().map(one).collect();
    let below = spheres.iter().map(|s| s.0.z).fold(f64::INFINITY, f64::min);
    let mut sim = Simulation::new(setup).expect("sound");
    while sim.time() < time {
        sim.step().expect("no guard");
    }
    let after = sim.particles().expect("no guard");
    after.iter().zip(grains).map(|(p, g)| p.position.z < below - g.1).collect()
}

/// Share of grains of radius `r` [m] that fall through within `time` [s], let go at chance places of a square of `width` [m].
///
/// # Panics
/// When a guard trips.
pub fn share(spheres: &[(Vec3, f64)], r: f64, width: f64, time: f64) -> f64 {
    let top = spheres.iter().map(|s| s.0.z + s.1).fold(f64::NEG_INFINITY, f64::max);
    let above = |(x, y)| {
        let z = touch(spheres, r, x, y).map_or(top + r, |t| t.0 + 0.1 * r);
        (Vec3::new(x, y, z), r)
    };
    let grains: Vec<(Vec3, f64)> = places(width, 6.0 * r, 150).into_iter().map(above).collect();
    let through = passes(spheres, &grains, (time, 0.03));
    through.iter().filter(|&&t| t).count() as f64 / through.len() as f64
}
