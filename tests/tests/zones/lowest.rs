//! The foremost point of a grain as what passes the planes.

use super::zone;
use dem::Simulation;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::setups::{HOOKE, empty, grain, particles, run_until};

fn lowest(x: f64, length: f64) -> Zone {
    Zone { test: ZoneTest::Lowest, ..zone(x, length) }
}

/// A large and a small grain whose surfaces touch the plane at one time pass at one time, and are out at one time.
#[test]
fn the_foremost_point_passes_storage_and_exclusion_plane() {
    let mut setup = empty(HOOKE, 0.5);
    setup.step = Step::Fixed(5e-5);
    setup.outlets = vec![lowest(0.1, 0.03)];
    let ball = |id, radius: f64| Particle {
        radius,
        velocity: Vec3::x(),
        ..grain(id, Vec3::new(-radius, 0.1 * f64::from(id), 0.0))
    };
    setup.particles = vec![ball(1, 0.01), ball(2, 0.004)];
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, 0.0999);
    assert!(sim.take_crossings().is_empty());
    run_until(&mut sim, 0.101);
    let found = sim.take_crossings();
    assert_eq!(found.len(), 2);
    for c in &found {
        assert!((c.time - 0.1).abs() < 1e-12, "{}", c.time);
        assert!((c.particle.position.x - (0.1 - c.particle.radius)).abs() < 1e-12, "{}", c.particle.position);
    }
    run_until(&mut sim, 0.1298);
    assert_eq!(sim.particle_count(), 2);
    run_until(&mut sim, 0.1302);
    assert_eq!(sim.particle_count(), 0);
}

/// Free as soon as its surface touches the calculation plane, a radius earlier than its centre.
#[test]
fn the_foremost_point_passes_the_calculation_plane() {
    let mut setup = empty(HOOKE, 0.5);
    (setup.step, setup.gravity) = (Step::Fixed(1e-4), Vec3::new(0.0, 0.0, -9.81));
    setup.inlets = vec![lowest(0.0, 0.05)];
    (setup.smallest_entry, setup.largest_entry, setup.entry_materials) = (0.01, 0.01, vec![0]);
    let mut sim = Simulation::new(setup).expect("sound");
    let particle = Particle { velocity: Vec3::x(), ..grain(3, Vec3::new(-0.06, 0.0, 0.0)) };
    sim.enter(Entry { time: 0.0, inlet: 0, particle, clump: None, turn: None, cluster: 0 }).expect("in time");
    run_until(&mut sim, 0.15);
    // Free from t = 0.05 on.
    let fall = sim.time() - 0.05;
    let z = particles(&mut sim)[0].position.z;
    assert!((z + 0.5 * 9.81 * fall * fall).abs() < 1e-11, "{z} m after {fall} s");
}
