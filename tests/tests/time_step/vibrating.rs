//! Walls that vibrate faster than contacts: the step follows them.

use dem::setup::*;
use dem::{Setup, Simulation, critical_step, time_step};
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{HOOKE, empty, grain, plane, run_until};
use scene::advice::{explain_setup_error, explain_step_cause};
use std::f64::consts::{PI, TAU};

const WORK: Case =
    case("Time step", "work of a floor that vibrates as often as contacts alone would step: ½ c A² ω² t");
const REFUSED: Case = case("Time step", "a given step that skips a vibration is refused");

/// Smallest amplitude: the contact stays linear.
const A: f64 = 1e-6;
const E: f64 = 0.5;

/// A grain pressed onto a floor by so much that it never leaves it, and the step that contacts alone allow.
fn pressed() -> (Setup, f64) {
    let mut setup = empty(HOOKE, E);
    (setup.gravity.z, setup.step, setup.ledger) = (-100.0, Step::Auto(0.5), true);
    setup.walls = vec![plane(Vec3::z())];
    let overlap = 100.0 * dem::mass(0.01, 2500.0) / 1e4;
    setup.particles = vec![grain(0, Vec3::new(0.0, 0.0, 0.01 - overlap))];
    let dt = time_step(&setup).expect("stable");
    setup.walls[0].motion.amplitude.z = A;
    (setup, dt)
}

#[test]
fn a_vibration_sets_the_step_and_does_its_work() {
    let (mut setup, dt) = pressed();
    // With a step of its period a wall would never move.
    let frequency = 1.0 / dt;
    setup.walls[0].motion.frequency = frequency;
    let step = time_step(&setup).expect("stable");
    assert!((step * frequency * 20.0 - 1.0).abs() < 1e-12, "{step} s at {frequency} Hz");
    let cause = explain_step_cause(&critical_step(&setup).expect("sound").cause);
    assert!(cause.starts_with("the motion of wall 'plane', 20 steps in a period of"), "{cause}");
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, 0.2);
    let m = dem::mass(0.01, 2500.0);
    let ln = E.ln();
    let c = 2.0 * (1e4 * m).sqrt() * -ln / (PI * PI + ln * ln).sqrt();
    let omega = TAU * frequency;
    let answer = 0.5 * c * A * A * omega * omega * sim.time();
    WORK.equals("hooke", sim.energy().expect("sound").walls, "J", answer, 0.03);
}

#[test]
fn a_step_that_skips_a_vibration_is_refused() {
    let (mut setup, dt) = pressed();
    setup.walls[0].motion.frequency = 1.0 / dt;
    setup.step = Step::Fixed(dt / 19.0);
    let error = Simulation::new(setup.clone()).err().map(|e| explain_setup_error(&e)).unwrap_or_default();
    REFUSED.refused("19 steps a period", &error, &["time.dt", "wall 'plane'", "20 steps", "slower motion"]);
    setup.step = Step::Fixed(dt / 20.0);
    Simulation::new(setup.clone()).expect("20 steps a period are enough");
    // A motion that is slow enough changes nothing.
    setup.walls[0].motion.frequency = 1.0 / (20.0 * dt);
    setup.step = Step::Auto(0.5);
    assert_eq!(time_step(&setup).expect("sound"), dt);
}
