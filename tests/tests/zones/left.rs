//! A grain that has left at the end of a zone acts on nothing, though lists still name it.

use super::zone;
use dem::Simulation;
use dem::setup::*;
use geom::{Plane, Vec3};
use grainpipe_tests::setups::{HOOKE, empty, grain, plane, with_friction};

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
        sim.step().expect("no grain is pushed");
        let told = sim.record_contacts().expect("no grain is pushed");
        assert!(told.iter().all(|c| c.point.amax() < 1.0), "{told:?}");
        let list = grainpipe_tests::setups::particles(&mut sim);
        if let [a, b] = &list[..] {
            closest = closest.min((a.position - b.position).norm());
        }
    }
    assert!(closest < 0.0105, "they did overlap: {closest} m between centres");
    assert_eq!(sim.take_crossings().len(), 2);
}

/// Walls at 45° pass through every place with x = y = z, as far away as it may be: a grain that has left presses on none of them. The ledger stays a
/// number, and a chute that follows a force goes on doing so.
#[test]
fn who_has_left_is_beyond_every_plane() {
    let s = 0.5f64.sqrt();
    for (normal, along) in [
        (Vec3::new(-s, 0.0, s), Vec3::new(-s, 0.0, -s)),
        (Vec3::new(s, -s, 0.0), Vec3::new(s, s, 0.0)),
        (Vec3::new(1.0, 1.0, -2.0).normalize(), Vec3::new(s, -s, 0.0)),
    ] {
        for follows in [false, true] {
            let mut setup = with_friction(empty(HOOKE, 0.5), 0.3);
            setup.ledger = true;
            let mut chute = plane(normal);
            chute.servo = follows.then_some(Servo::force(normal, 0.05, 1e-4));
            setup.walls = vec![chute];
            let sliding = |id: u32, way: f64| {
                let velocity = along * 0.7;
                Particle { velocity, ..grain(id, normal * 0.00999 + along * way) }
            };
            setup.particles = vec![sliding(1, 0.09), sliding(2, -0.3)];
            setup.outlets = vec![Zone::new(Plane { point: along * 0.1, normal: along }, 0.03)];
            let mut sim = Simulation::new(setup).expect("sound");
            while sim.time() < 0.12 {
                sim.step().expect("nothing is lost");
                let (e, wall) = (sim.energy().expect("sound"), sim.wall_forces().expect("sound")[0]);
                assert!(e.integration.is_finite() && e.sliding.is_finite(), "{normal}: {e:?}");
                assert!(wall.shift.norm().is_finite() && wall.force.norm().is_finite(), "{wall:?}");
            }
            assert_eq!(sim.particle_count(), 1, "one has left");
        }
    }
}
