//! Who has left at the end of a zone is in nobody's way, though lists still name it.

use super::zone;
use dem::Simulation;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::setups::{HOOKE, empty, grain};

/// Two grains fly after each other through a zone of 30 mm, 20 mm thick each: the second is twice as fast and has run half into the first when that leaves.
/// Travellers do not feel each other, so no guard may stop the run then; and what is recorded of their contact has a place, or is not told.
#[test]
fn a_follower_may_overlap_who_leaves() {
    let mut setup = empty(HOOKE, 0.5);
    setup.outlets = vec![zone(0.1, 0.03)];
    let moving = |id: u32, x: f64, speed: f64| {
        let velocity = Vec3::new(speed, 0.0, 0.0);
        Particle { velocity, ..grain(id, Vec3::new(x, 0.0, 0.0)) }
    };
    // The first passes at 0.02 s, the second 0.0402 s later, when there is a hair between them.
    setup.particles = vec![moving(1, 0.09, 0.5), moving(2, 0.1 - 0.0602, 1.0)];
    let mut sim = Simulation::new(setup).expect("sound");
    let mut closest = f64::INFINITY;
    while sim.time() < 0.1 {
        sim.step().expect("nobody is pushed");
        let told = sim.record_contacts().expect("nobody is pushed");
        assert!(told.iter().all(|c| c.point.amax() < 1.0), "{told:?}");
        let list = grainpipe_tests::setups::particles(&mut sim);
        if let [a, b] = &list[..] {
            closest = closest.min((a.position - b.position).norm());
        }
    }
    assert!(closest < 0.0105, "they did overlap: {closest} m between centres");
    assert_eq!(sim.take_crossings().len(), 2);
}
