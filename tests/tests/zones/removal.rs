//! Regions that take particles out: what is in one at the end of a step, nothing else, and the energy that goes with it.

use super::*;
use geom::shape::Solid;
use geom::{Moments, Shape};
use nalgebra::UnitQuaternion;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::collections::BTreeMap;

fn region(solid: Solid, low: Vec3, high: Vec3) -> Removal {
    Removal { shape: Shape { solid, outside: false }, bounds: (low, high) }
}

fn regions() -> Vec<Removal> {
    let ball = Vec3::new(0.05, 0.05, 0.05);
    let (foot, top) = (Vec3::new(-0.06, -0.06, -0.05), Vec3::new(-0.06, -0.06, 0.05));
    let reach = Vec3::new(0.03, 0.03, 0.0);
    let (corner, far) = (Vec3::new(0.02, -0.08, -0.08), Vec3::new(0.08, -0.03, 0.0));
    vec![
        region(Solid::Sphere(ball, 0.04), ball.add_scalar(-0.04), ball.add_scalar(0.04)),
        region(Solid::Cylinder(foot, top, 0.03), foot - reach, top + reach),
        region(Solid::Box(corner, far), corner, far),
    ]
}

/// Grains that collide without gravity, every second time in a periodic box.
fn crowd(seed: u64) -> Setup {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut speed = || 2.0 * random.random::<f64>() - 1.0;
    let mut setup = with_friction(empty(HOOKE, 0.6), 0.4);
    setup.step = Step::Fixed(2e-5);
    setup.ledger = true;
    setup.removals = regions();
    if seed.is_multiple_of(2) {
        setup.periodic = [Some((-0.1, 0.1)); 3];
    }
    let place = |k: u32| Vec3::new(f64::from(k % 7), f64::from(k / 7 % 7), f64::from(k / 49)) * 0.026;
    let mut moving = |k: u32| Particle {
        velocity: Vec3::new(speed(), speed(), speed()),
        ..grain(k, place(k) - Vec3::repeat(0.078))
    };
    setup.particles = (0..343).map(&mut moving).collect();
    setup
}

#[test]
fn what_is_inside_at_the_end_of_a_step_is_taken_out() {
    let (regions, mut taken) = (regions(), [0; 3]);
    let inside = |p: &Vec3| regions.iter().any(|r| r.holds(p));
    for seed in 0..8 {
        let setup = crowd(seed);
        let in_box = |p: Vec3| match setup.periodic[0] {
            Some(_) => p.map(|x| x - 0.2 * ((x + 0.1) / 0.2).floor()),
            None => p,
        };
        let mass = 2500.0 * geom::sphere::volume(0.01);
        let kinetic: f64 = setup.particles.iter().map(|p| 0.5 * mass * p.velocity.norm_squared()).sum();
        let mut sim = Simulation::new(setup.clone()).expect("sound");
        let mut before = particles(&mut sim);
        while sim.time() < 0.04 {
            sim.step().expect("no guard");
            let after: BTreeMap<u32, Particle> = particles(&mut sim).into_iter().map(|p| (p.id, p)).collect();
            for old in &before {
                let Some(new) = after.get(&old.id) else {
                    // Where its velocity takes it; forces change that by less than a tenth of a micrometre.
                    let there = in_box(old.position + old.velocity * sim.dt());
                    let near = (0..3).flat_map(|a| [-1e-6, 1e-6].map(|by| there + Vec3::ith(a, by)));
                    assert!(near.chain([there]).any(|p| inside(&p)), "seed {seed}: {} at {there}", old.id);
                    continue;
                };
                assert!(!inside(&in_box(new.position)), "seed {seed}: {} stays", old.id);
            }
            before = after.into_values().collect();
        }
        let found = sim.returned().regions.clone();
        let count: u64 = found.iter().map(|r| r.count).sum();
        assert_eq!(count as usize, 343 - sim.particle_count(), "seed {seed}");
        for (sum, Removed { count, mass: weighs }) in taken.iter_mut().zip(found) {
            assert!((weighs - mass * count as f64).abs() < 1e-12, "seed {seed}: {weighs} kg");
            *sum += count;
        }
        let energy = sim.energy().expect("ready");
        let made = energy.integration;
        assert!(made.abs() < 1e-3 * kinetic && energy.normal > 0.01 * kinetic, "seed {seed}: {made} J");
    }
    assert!(taken.iter().all(|&n| n > 50), "{taken:?}");
}

/// What becomes free inside a region, behind an inlet, is taken out at once, with what it brought: nothing of it is left in the ledger.
#[test]
fn what_becomes_free_in_a_region_takes_along_what_it_brought() {
    const COUNT: u32 = 20;
    for motion in [ZoneMotion::Constant, ZoneMotion::Ballistic] {
        let mut setup = with_friction(empty(HOOKE, 0.6), 0.4);
        setup.gravity = Vec3::z() * -9.81;
        (setup.step, setup.ledger) = (Step::Fixed(3e-5), true);
        let plane = Plane::new(Vec3::zeros(), -Vec3::z()).expect("a plane");
        setup.inlets = vec![Zone { motion, ..Zone::new(plane, 0.05) }];
        setup.entry_materials = vec![0];
        (setup.smallest_entry, setup.largest_entry) = (0.01, 0.01);
        let (low, high) = (Vec3::new(-1.0, -1.0, -0.3), Vec3::new(1.0, 1.0, 0.01));
        setup.removals = vec![region(Solid::Box(low, high), low, high)];
        let mut sim = Simulation::new(setup).expect("sound");
        let start = sim.energy().expect("ready").balance();
        for k in 0..COUNT {
            let particle =
                Particle { velocity: Vec3::new(0.1, 0.0, -1.0), ..grain(k, Vec3::new(0.0, 0.0, 0.05)) };
            let time = 0.001 + 0.023 * f64::from(k);
            sim.enter(Entry { time, inlet: 0, particle, clump: None, turn: None, cluster: 0 })
                .expect("in time");
        }
        while sim.time() < 0.6 {
            sim.step().expect("no guard");
        }
        let energy = sim.energy().expect("ready");
        assert_eq!(sim.returned().regions[0].count, u64::from(COUNT), "{motion:?}");
        let off = (energy.balance() - start) / energy.entered;
        assert!(off.abs() < 1e-12, "{motion:?}: {off:e} of what came in");
    }
}

/// A clump goes as one, when its centre of mass is inside.
#[test]
fn a_clump_is_taken_out_by_its_centre() {
    let spheres = [(Vec3::zeros(), 0.006), (Vec3::x() * 0.01, 0.005)];
    let moments = Moments::of_union(&spheres).expect("spheres that touch");
    let mut setup = empty(HOOKE, 0.5);
    setup.step = Step::Fixed(5e-5);
    setup.clumps.shapes = vec![ClumpShape::new("pair", 0, &spheres, &moments)];
    let orientation = UnitQuaternion::from_euler_angles(0.3, -0.8, 0.5);
    let (velocity, spin) = (Vec3::x(), Vec3::new(20.0, -35.0, 10.0));
    setup.clumps.placed =
        vec![Body { id: 7, shape: 0, scale: 1.0, position: Vec3::zeros(), orientation, velocity, spin }];
    let (low, high) = (Vec3::new(0.05, -0.1, -0.1), Vec3::new(0.1, 0.1, 0.1));
    setup.removals = vec![region(Solid::Box(low, high), low, high)];
    let mass = setup.clumps.shapes[0].mass(1.0, 2500.0);
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, 0.0499);
    assert_eq!(sim.particle_count(), 2);
    run_until(&mut sim, 0.0502);
    assert_eq!(sim.particle_count(), 0);
    let [Removed { count: 1, mass: weighs }] = sim.returned().regions[..] else {
        panic!("{:?}", sim.returned().regions)
    };
    assert!((weighs / mass - 1.0).abs() < 1e-12, "{weighs} kg, not {mass} kg");
}
