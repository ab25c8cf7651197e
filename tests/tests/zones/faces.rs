//! Zones in a periodic box.

use super::zone;
use dem::Simulation;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::setups::{HOOKE, empty, grain, particles};

/// A grain that drifts through a periodic face while it travels stays among those that it was listed with: lists hold, and it pushes a grain
/// that is on the other side of the face.
#[test]
fn a_traveller_goes_through_a_periodic_face() {
    let mut setup = empty(HOOKE, 0.5);
    setup.step = Step::Fixed(1e-4);
    setup.periodic = [None, Some((0.0, 0.1)), None];
    setup.outlets = vec![zone(0.1, 0.03)];
    setup.guards.overlap = 0.9;
    let mut travels = grain(1, Vec3::new(0.0999, 0.085, 0.0));
    travels.velocity = Vec3::new(0.1, 0.3, 0.0);
    let waits = grain(2, Vec3::new(0.095, 0.02, 0.0));
    setup.particles = vec![travels, waits];
    let mut sim = Simulation::new(setup).expect("sound");
    while sim.time() < 0.1 {
        sim.step().expect("free");
    }
    // It left y = 0.085 m at 0.3 m/s, and is at 0.015 m now.
    let [p, q] = particles(&mut sim)[..] else { panic!("both are there") };
    assert!((p.position.y - 0.015).abs() < 1e-9 && (p.velocity.y - 0.3).abs() < 1e-12, "{p:?}");
    assert!(q.velocity.y > 0.05, "pushed on: {q:?}");
    assert!(sim.rebuilds() < 30, "{} listings in {} steps", sim.rebuilds(), sim.steps());
}
