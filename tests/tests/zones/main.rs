//! Storage, exclusion, generation and calculation planes, at the engine.

mod account;
mod ballistic;
mod bonds;
mod clumps;
mod faces;
mod idle;
mod left;
mod lowest;
mod memory;
mod path;
mod removal;
mod room;
mod shared_place;
mod together;

use dem::Simulation;
use dem::setup::*;
use geom::{Plane, Vec3};
use grainpipe_tests::setups::{HOOKE, empty, grain, particles, run_until, with_friction};
use scene::advice::explain_setup_error;

fn zone(x: f64, length: f64) -> Zone {
    Zone::new(Plane { point: Vec3::new(x, 0.0, 0.0), normal: Vec3::x() }, length)
}

/// A grain that flies through the storage plane of x = 0.10003 m, within a step.
fn flight() -> Setup {
    let mut setup = empty(HOOKE, 0.5);
    setup.step = Step::Fixed(1e-4);
    setup.gravity = Vec3::new(0.0, 0.0, -9.81);
    setup.outlets = vec![zone(0.100_03, 0.03)];
    let mut p = grain(7, Vec3::new(0.0, 0.0, 0.0));
    p.velocity.x = 1.0;
    setup.particles = vec![p];
    setup
}

#[test]
fn crossing_is_recorded_within_the_step_and_velocity_is_kept_until_the_exclusion_plane() {
    let mut sim = Simulation::new(flight()).expect("sound");
    let mut crossings = Vec::new();
    while sim.time() < 0.12 {
        sim.step().expect("free");
        crossings.extend(sim.take_crossings());
    }
    let [c] = &crossings[..] else { panic!("one crossing, not {}", crossings.len()) };
    let t = 0.100_03;
    assert!((c.time - t).abs() < 1e-12, "{}", c.time);
    // On the parabola, not on the chord of the step's part of it.
    let place = Vec3::new(t, 0.0, -0.5 * 9.81 * t * t);
    assert!((c.particle.position - place).norm() < 1e-13, "{}", c.particle.position);
    assert!((c.particle.velocity - Vec3::new(1.0, 0.0, -9.81 * t)).norm() < 1e-12, "{}", c.particle.velocity);
    let p = particles(&mut sim)[0];
    let straight = c.particle.position + c.particle.velocity * (sim.time() - c.time);
    assert!((p.position - straight).norm() < 1e-12, "constant velocity in the zone");
    while sim.time() < 0.14 {
        sim.step().expect("free");
    }
    assert_eq!(sim.particle_count(), 0, "out of the calculation past the exclusion plane");
    assert!(particles(&mut sim).is_empty());
}

/// The zone's particle acts on one that has not passed, and is not moved by it.
#[test]
fn acts_one_way() {
    let mut setup = flight();
    setup.gravity = Vec3::zeros();
    setup.guards.overlap = 0.9;
    setup.particles[0].velocity.x = 0.1;
    let mut chaser = grain(8, Vec3::new(-0.0205, 0.0, 0.0));
    chaser.velocity.x = 0.5;
    setup.particles.push(chaser);
    // The chaser would hit before the plane: let the first one start just before it.
    setup.particles[0].position.x = 0.0999;
    setup.particles[1].position.x = 0.0999 - 0.021;
    let mut sim = Simulation::new(setup).expect("sound");
    let mut crossings = Vec::new();
    while sim.time() < 0.1 {
        sim.step().expect("within the guards");
        crossings.extend(sim.take_crossings());
    }
    let all = particles(&mut sim);
    let (first, chaser) = (all.iter().find(|p| p.id == 7), all.iter().find(|p| p.id == 8));
    assert_eq!(first.expect("in the zone").velocity, Vec3::new(0.1, 0.0, 0.0), "nothing acts on it");
    assert!(chaser.expect("free").velocity.x < 0.1, "it acts on the one behind");
    assert_eq!(crossings.len(), 1);
}

#[test]
fn forces_of_the_contacts_are_recorded_with_the_crossing() {
    let mut setup = with_friction(flight(), 0.5);
    setup.gravity = Vec3::zeros();
    setup.step = Step::Fixed(5e-5);
    setup.particles =
        vec![grain(7, Vec3::new(0.099_99, 0.0, 0.0)), grain(8, Vec3::new(0.099_99 - 0.0199, 0.0, 0.0))];
    setup.particles.iter_mut().for_each(|p| p.velocity.x = 1.0);
    setup.particles[0].velocity.y = 0.05;
    let mut sim = Simulation::new(setup).expect("sound");
    sim.step().expect("within the guards");
    let crossings = sim.take_crossings();
    let [c] = &crossings[..] else { panic!("one crossing, not {}", crossings.len()) };
    let [touch] = &c.touching[..] else { panic!("one contact, not {}", c.touching.len()) };
    assert_eq!(touch.partner, Some(8));
    assert!((touch.normal.x - 1e4 * 1e-4).abs() < 1e-3, "k δ pushes it on: {}", touch.normal);
    assert!(
        touch.tangential.y < 0.0 && touch.tangential.x.abs() < 1e-12,
        "friction holds it back: {}",
        touch.tangential
    );
}

/// Generated at the recorded time and place, moved with its velocity, free from the calculation plane on.
#[test]
fn entry_becomes_free_at_the_calculation_plane() {
    let mut setup = empty(HOOKE, 0.5);
    setup.step = Step::Fixed(1e-4);
    setup.gravity = Vec3::new(0.0, 0.0, -9.81);
    setup.inlets = vec![zone(0.05, 0.05)];
    (setup.smallest_entry, setup.largest_entry, setup.entry_materials) = (0.01, 0.01, vec![0]);
    let mut sim = Simulation::new(setup.clone()).expect("sound");
    let mut p = grain(3, Vec3::zeros());
    p.velocity.x = 1.0;
    sim.enter(Entry { time: 0.020_05, inlet: 0, particle: p, clump: None, turn: None, cluster: 0 })
        .expect("in time");
    while sim.time() < 0.0199 {
        sim.step().expect("free");
    }
    assert_eq!(sim.particle_count(), 0, "not before its time");
    while sim.time() < 0.04 - 1e-9 {
        sim.step().expect("free");
    }
    let there = particles(&mut sim)[0];
    assert!(
        (there.position - Vec3::new(sim.time() - 0.020_05, 0.0, 0.0)).norm() < 1e-12,
        "{}",
        there.position
    );
    while sim.time() < 0.1201 - 1e-9 {
        sim.step().expect("free");
    }
    // Free from the first step past the plane, at t = 0.0701.
    let fall = sim.time() - 0.0701;
    let p = particles(&mut sim)[0];
    assert!((p.position.z + 0.5 * 9.81 * fall * fall).abs() < 1e-11, "{} after {fall} s", p.position.z);
    assert!((p.velocity.z + 9.81 * fall).abs() < 1e-11);
    let late = sim.enter(Entry {
        time: 0.01,
        inlet: 0,
        particle: grain(4, Vec3::zeros()),
        clump: None,
        turn: None,
        cluster: 0,
    });
    assert!(explain_setup_error(&late.expect_err("too late")).contains("time order"));
    let away = Particle { velocity: Vec3::x(), ..grain(5, Vec3::new(-1e13, 0.0, 0.0)) };
    let far = sim.enter(Entry { time: 0.13, inlet: 0, particle: away, clump: None, turn: None, cluster: 0 });
    let far = explain_setup_error(&far.expect_err("too far"));
    assert!(far.contains("particle 5") && far.contains("shift the scene to the origin"), "{far}");
}

#[test]
fn zone_shorter_than_the_largest_particle_is_refused() {
    let mut setup = flight();
    setup.outlets[0].length = 0.02;
    let error = explain_setup_error(&Simulation::new(setup).err().expect("refused"));
    assert!(error.contains("2.0000e-2 m") && error.contains("2.4000e-2 m"), "{error}");
}

/// A run with zones, cut by a checkpoint, goes on bit for bit.
#[test]
fn zones_resume_exactly() {
    let mut setup = with_friction(flight(), 0.3);
    setup.step = Step::Fixed(5e-5);
    setup.particles = (0..40)
        .map(|k| {
            let mut p = grain(
                k,
                Vec3::new(0.08 - 0.021 * (k / 4) as f64, 0.021 * (k % 2) as f64, 0.021 * (k / 2 % 2) as f64),
            );
            p.velocity = Vec3::new(1.0 + 0.1 * (k % 3) as f64, 0.0, 0.0);
            p
        })
        .collect();
    let run = |sim: &mut Simulation, steps: u64| {
        let mut seen = Vec::new();
        for _ in 0..steps {
            sim.step().expect("within the guards");
            seen.extend(sim.take_crossings());
        }
        seen
    };
    let mut whole = Simulation::new(setup.clone()).expect("sound");
    let all = run(&mut whole, 5000);
    // Also while some have left and wait for the next listing to drop them.
    let mut other = Simulation::new(setup.clone()).expect("sound");
    for step in (0..4000).step_by(20) {
        let resumed = Simulation::resume(setup.clone(), other.checkpoint().to_static());
        assert!(resumed.is_ok(), "at step {step}: {:?}", resumed.err());
        run(&mut other, 20);
    }
    let mut first = Simulation::new(setup.clone()).expect("sound");
    let mut parts = run(&mut first, 2400);
    let mut second = Simulation::resume(setup, first.checkpoint().to_static()).expect("the same setup");
    parts.extend(run(&mut second, 2600));
    assert_eq!(all, parts);
    assert_eq!(particles(&mut whole), particles(&mut second));
    assert_eq!(all.len(), 40);
}
