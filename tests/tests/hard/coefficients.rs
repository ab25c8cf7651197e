//! Friction and restitution at the ends of their ranges.

use crate::variants::{Variant, simulation, variants};
use dem::setup::*;
use dem::{Simulation, mass};
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::normals::Surface;
use grainpipe_tests::setups::{grain, particles, plane, run_until};

const SMOOTH: Case = case("Rest and extremes", "μ = 0: a thrown ball keeps its speed and its spin");
const RUGGED: Case = case(
    "Rest and extremes",
    "μ = 10: a thrown ball rolls at 5/7 of its speed, its arm shortened by the overlap",
);
const DEAD: Case = case("Rest and extremes", "e = 0: nothing rebounds");
const ELASTIC: Case = case("Rest and extremes", "e = 1: 100 bounces lose no energy");

/// A ball thrown along a floor; grains among themselves rub, so that it turns whatever the floor does.
fn thrown(variant: &Variant, friction: f64) -> Particle {
    let (mut setup, _) = variant.normal.resting(0.5, Surface::Plane);
    setup.precision = variant.precision;
    setup.contacts[0].set("sliding_friction", 0.5);
    setup.contacts[1].set("sliding_friction", friction);
    setup.step = Step::Auto(0.2);
    setup.particles[0].velocity.x = 1.0;
    setup.particles[0].spin.z = 5.0;
    let mut sim = simulation(setup);
    run_until(&mut sim, 0.3);
    particles(&mut sim)[0]
}

#[test]
fn friction_at_the_ends_of_its_range() {
    for variant in variants() {
        let p = thrown(&variant, 0.0);
        let off = (p.velocity.x - 1.0).abs().max((p.spin.z - 5.0).abs());
        SMOOTH.within(&variant.name(), off, "m/s and rad/s", 0.0);
        let p = thrown(&variant, 10.0);
        // The arm is what is left of the radius: v/v₀ = a²/(a² + 2/5 r²).
        let arm = 1.0 - variant.normal.at_rest(mass(0.01, 2500.0) * 9.81).0 / 0.01;
        RUGGED.equals(&variant.name(), p.velocity.x, "m/s", arm * arm / (arm * arm + 0.4), 1e-6);
    }
}

/// A ball that falls on a floor; its velocity after the impact, from when it has left or after a long time.
fn rebound(variant: &Variant, restitution: f64) -> f64 {
    let mut setup = variant.smooth(restitution);
    setup.step = Step::Auto(0.02);
    setup.walls = vec![plane(Vec3::z())];
    setup.particles =
        vec![Particle { velocity: Vec3::new(0.0, 0.0, -0.1), ..grain(1, Vec3::new(0.0, 0.0, 0.0101)) }];
    let mut sim = simulation(setup);
    run_until(&mut sim, 0.05);
    particles(&mut sim)[0].velocity.z
}

#[test]
fn restitution_at_the_ends_of_its_range() {
    for variant in variants() {
        DEAD.within(&variant.name(), rebound(&variant, 0.0) / 0.1, "of the speed", 1e-4);
        if variant.adheres() {
            continue;
        }
        let mut setup = variant.smooth(1.0);
        setup.gravity.z = -9.81;
        setup.step = Step::Auto(0.05);
        setup.walls = vec![plane(Vec3::z())];
        setup.particles = vec![grain(1, Vec3::new(0.0, 0.0, 0.015))];
        setup.ledger = true;
        let mut sim = simulation(setup);
        let energy = |sim: &mut Simulation| {
            let e = sim.energy().expect("within the guards");
            e.translation + e.potential + e.elastic
        };
        let before = energy(&mut sim);
        // √(8 h/g) from bounce to bounce.
        run_until(&mut sim, 100.0 * (8.0f64 * 0.005 / 9.81).sqrt());
        let fall = mass(0.01, 2500.0) * 9.81 * 0.005;
        ELASTIC.within(
            &variant.name(),
            (energy(&mut sim) - before) / fall,
            "of the energy of the fall",
            3e-3,
        );
    }
}
