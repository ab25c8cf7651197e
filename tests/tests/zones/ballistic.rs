//! Zones in which particles fall freely.

use super::{flight, zone};
use dem::Simulation;
use dem::setup::*;
use geom::{Plane, Vec3};
use grainpipe_tests::setups::{HOOKE, empty, grain, particles, run_until};

const GRAVITY: Vec3 = Vec3::new(0.0, 0.0, -9.81);

fn falling(plane: Plane, length: f64) -> Zone {
    Zone { motion: ZoneMotion::Ballistic, ..Zone::new(plane, length) }
}

/// The parabola goes on in the zone as if there were no plane, to rounding.
#[test]
fn a_thrown_grain_goes_on_along_its_parabola() {
    let mut setup = flight();
    setup.outlets = vec![Zone { motion: ZoneMotion::Ballistic, ..zone(0.100_03, 0.2) }];
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, 0.29);
    assert_eq!(sim.take_crossings().len(), 1);
    let (p, t) = (particles(&mut sim)[0], sim.time());
    assert!(
        (p.position - (Vec3::new(t, 0.0, 0.0) + GRAVITY * (0.5 * t * t))).norm() < 1e-13,
        "{}",
        p.position
    );
    assert!((p.velocity - (Vec3::x() + GRAVITY * t)).norm() < 1e-12, "{}", p.velocity);
    run_until(&mut sim, 0.3005);
    assert_eq!(sim.particle_count(), 0, "out past the exclusion plane");
}

/// Through an inlet it comes at the time, at the place and with the velocity of the parabola, and goes on along it.
#[test]
fn an_entry_in_free_fall_never_notices_the_calculation_plane() {
    let mut setup = empty(HOOKE, 0.5);
    (setup.step, setup.gravity) = (Step::Fixed(1e-4), GRAVITY);
    let plane = Plane { point: Vec3::new(0.0, 0.0, -0.1), normal: -Vec3::z() };
    setup.inlets = vec![falling(plane, 0.05)];
    (setup.smallest_entry, setup.largest_entry, setup.entry_materials) = (0.01, 0.01, vec![0]);
    let mut sim = Simulation::new(setup).expect("sound");
    // At its apex, where it does not move along the normal.
    let start = Particle { velocity: Vec3::new(0.3, 0.0, 0.0), ..grain(3, Vec3::new(0.0, 0.0, -0.06)) };
    sim.enter(Entry { time: 0.010_05, inlet: 0, particle: start, clump: None, turn: None, cluster: 0 })
        .expect("it falls");
    for until in [0.05, 0.09, 0.1, 0.11, 0.2] {
        run_until(&mut sim, until);
        let (p, t) = (particles(&mut sim)[0], sim.time() - 0.010_05);
        let place = start.position + start.velocity * t + GRAVITY * (0.5 * t * t);
        assert!((p.position - place).norm() < 1e-12, "{} m off at {until} s", (p.position - place).norm());
        assert!((p.velocity - start.velocity - GRAVITY * t).norm() < 1e-11);
    }
    let up = Particle { velocity: Vec3::new(0.0, 0.0, -1.0), ..grain(4, Vec3::new(0.0, 0.0, -0.06)) };
    sim.enter(Entry { time: 0.3, inlet: 0, particle: up, clump: None, turn: None, cluster: 0 })
        .expect("thrown down");
    let mut still = empty(HOOKE, 0.5);
    (still.step, still.inlets) = (Step::Fixed(1e-4), vec![falling(plane, 0.05)]);
    (still.smallest_entry, still.largest_entry, still.entry_materials) = (0.01, 0.01, vec![0]);
    let mut sim = Simulation::new(still).expect("sound");
    let refused =
        sim.enter(Entry { time: 0.0, inlet: 0, particle: start, clump: None, turn: None, cluster: 0 });
    let said = refused.expect_err("without gravity it never arrives").to_string();
    assert!(said.contains("0 m/s is outside what brings it to the calculation plane"), "{said}");
}

/// Thrown up through a storage plane too slowly for the zone: it is recorded once, falls back, and is out.
#[test]
fn a_grain_that_falls_back_in_the_zone_is_counted_and_gone() {
    let mut setup = empty(HOOKE, 0.5);
    (setup.step, setup.gravity) = (Step::Fixed(1e-4), GRAVITY);
    setup.outlets = vec![falling(Plane { point: Vec3::zeros(), normal: Vec3::z() }, 0.2)];
    setup.particles = vec![Particle { velocity: Vec3::z(), ..grain(1, Vec3::new(0.0, 0.0, -0.01)) }];
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, 0.19);
    assert_eq!((sim.take_crossings().len(), sim.particle_count()), (1, 1), "it rises to 0.04 m");
    run_until(&mut sim, 0.21);
    assert_eq!((sim.take_crossings().len(), sim.particle_count()), (0, 0));
    assert_eq!(sim.returned().fallen, [1]);
}

/// A traveller's state is a function of time alone: a run that is cut anywhere goes on bit for bit.
#[test]
fn free_fall_resumes_exactly() {
    let mut setup = flight();
    setup.outlets = vec![Zone { motion: ZoneMotion::Ballistic, test: ZoneTest::Lowest, ..zone(0.05, 0.03) }];
    let fan = |k: u32| Particle {
        velocity: Vec3::new(1.0 + 0.01 * f64::from(k), 0.0, 0.3),
        ..grain(k, Vec3::new(0.0, 0.021 * f64::from(k), 0.0))
    };
    setup.particles = (0..8).map(fan).collect();
    let mut whole = Simulation::new(setup.clone()).expect("sound");
    let mut parts = Simulation::new(setup.clone()).expect("sound");
    for until in [0.04, 0.045, 0.05, 0.055, 0.06] {
        run_until(&mut whole, until);
        run_until(&mut parts, until);
        parts = Simulation::resume(setup.clone(), parts.checkpoint().to_static()).expect("the same setup");
        assert_eq!(particles(&mut whole), particles(&mut parts), "{until} s");
    }
    assert!(particles(&mut whole).len() == 8 && whole.take_crossings().len() == 8);
}
