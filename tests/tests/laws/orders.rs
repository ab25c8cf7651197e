//! Orders in which errors fall with the step.
//!
//! | case | force at the ends of contact | order |
//! |---|---|---|
//! | elastic impact, linear law | δ: a kink | 2 |
//! | elastic impact, Hertz | δ^(3/2); between, the integrator keeps a shadow of the energy | 5/2 |
//! | damped impact, linear law | c δ̇: a jump, of which a step misses a part | 1 |
//! | damped impact, Hertz | δ^(1/4) δ̇ | 5/4 |
//! | impact with JKR | a jump at touch and at the break | 1 |
//! | contact that stays, damped or not | smooth | 2 |
//!
//! Where contact begins within a step is chance: errors of impacts are root mean squares over 16 starts spread over one step.

use crate::simulation;
use dem::setup::*;
use dem::{Setup, Simulation, mass};
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::normals::{MODULUS, WORK};
use grainpipe_tests::setups::{HOOKE, Law, empty, grain, particles, plane, run_until, with_friction};
use std::f64::consts::PI;

const ELASTIC: Case = case("One contact", "error of an elastic impact: v′ over v, by step");
const DAMPED: Case = case("One contact", "error of a damped impact: v′ over e v, by step");
const ADHESIVE: Case = case("One contact", "error of an impact with JKR: v′ over √(v² − 2W/m), by step");
const SLIDING: Case =
    case("Friction and rolling", "error of an oblique impact with sliding: v_t′ over v_n, by step");
const STAYS: Case =
    case("One contact", "error of a grain that oscillates on a plane: z over its amplitude, by step");
const FLUCTUATES: Case = case(
    "Energy",
    "largest energy change of a grain that oscillates on a plane without loss, over the energy of the oscillation, by step",
);

const STARTS: u32 = 16;
const HALVINGS: u32 = 6;

/// t_c [s] of a linear impact on a plane; the caller gives those of the other laws.
fn contact_time(stiffness: f64) -> f64 {
    PI * (mass(0.01, 2500.0) / stiffness).sqrt()
}

/// A grain that falls on a plane at a speed [m/s], some of a step away from it.
fn falling(law: Law, e: f64, velocity: Vec3, dt: f64, share: f64) -> Setup {
    let mut setup = empty(law, e);
    setup.step = Step::Fixed(dt);
    setup.walls = vec![plane(Vec3::z())];
    // The impacts here reach 0.8 % of the radius; the critical step is for the guard's.
    setup.guards.overlap = 0.01;
    let gap = -velocity.z * dt * (share + 1.0);
    setup.particles = vec![Particle { velocity, ..grain(1, Vec3::new(0.0, 0.0, 0.01 + gap)) }];
    setup
}

/// Velocity after the impact.
fn rebound(setup: Setup, time: f64) -> Vec3 {
    let mut sim = simulation(setup);
    while sim.time() < time {
        sim.step().expect("within the guards");
    }
    particles(&mut sim)[0].velocity
}

/// Root mean square over starts, of an error that is asked for by step and start [–]. Steps differ as well, so that contact lasts
/// for n to n + 1 of them: where in a step it ends is to be as much chance as where it begins.
fn mean(contact: f64, dt: f64, error: impl Fn(f64, f64) -> f64) -> f64 {
    let share = |k: u32| (f64::from(k) + 0.5) / f64::from(STARTS);
    let square = |k: u32| error(contact / (contact / dt + share(7 * k % STARTS)), share(k)).powi(2);
    ((0..STARTS).map(square).sum::<f64>() / f64::from(STARTS)).sqrt()
}

/// Steps over contact time, and errors: from 1/25 down.
fn points(contact: f64, error: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let at = |k: u32| 0.04 / f64::from(1u32 << k);
    (0..HALVINGS).map(|k| (at(k), error(at(k) * contact))).collect()
}

/// Hertz: 2.868 (m²/R E*² v)^0.2 [s].
fn hertz_time(speed: f64) -> f64 {
    2.868 * (mass(0.01, 2500.0).powi(2) / (0.01 * MODULUS * MODULUS * speed)).powf(0.2)
}

#[test]
fn head_on() {
    let speed = 0.05;
    let down = Vec3::new(0.0, 0.0, -speed);
    for (law, name, time, orders) in [
        (HOOKE, "hooke", contact_time(1e4), (2.0, 1.0)),
        (Law::Hertz, "hertz", hertz_time(speed), (2.5, 1.25)),
    ] {
        for e in [1.0, 0.9, 0.5] {
            let sampled =
                |dt, share| Setup { sampling: Sampling::Sampled, ..falling(law, e, down, dt, share) };
            let after = |dt, share| rebound(sampled(dt, share), 3.0 * time).z / (e * speed) - 1.0;
            let off = |dt: f64| mean(time, dt, after);
            let (case, order) = if e == 1.0 { (&ELASTIC, orders.0) } else { (&DAMPED, orders.1) };
            case.order(&format!("{name}, e = {e}"), &points(time, off), order, 0.1);
        }
    }
}

#[test]
fn adhesive() {
    let (speed, m) = (0.05, mass(0.01, 2500.0));
    let last = (PI * WORK * 1e-4 / (8.0 * MODULUS)).cbrt();
    let cycle = 4.0 * PI * WORK * last * last * (0.1 + 0.15 * 4f64.powf(4.0 / 3.0));
    let expected = (speed * speed - 2.0 * cycle / m).sqrt();
    let (law, time) = (Law::Jkr { work_of_adhesion: WORK }, hertz_time(speed));
    let down = Vec3::new(0.0, 0.0, -speed);
    let after = |dt, share| rebound(falling(law, 1.0, down, dt, share), 4.0 * time).z / expected - 1.0;
    let off = |dt: f64| mean(time, dt, after);
    ADHESIVE.order("jkr, e = 1", &points(time, off), 1.0, 0.1);
}

/// Slides all the time: v_t′ = v_t − 2 μ v_n without dashpots.
#[test]
fn sliding() {
    let speed = 0.05;
    let (mu, aslant) = (0.2, Vec3::new(0.1, 0.0, -speed));
    for (law, name, time, order) in
        [(HOOKE, "hooke", contact_time(1e4), 2.0), (Law::Hertz, "hertz", hertz_time(speed), 2.0)]
    {
        let after =
            |dt, share| rebound(with_friction(falling(law, 1.0, aslant, dt, share), mu), 3.0 * time).x;
        let off = |dt: f64| mean(time, dt, |dt, share| (after(dt, share) - (0.1 - 2.0 * mu * speed)) / speed);
        SLIDING.order(&format!("{name}, e = 1"), &points(time, off), order, 0.1);
    }
}

/// A grain that swings about where it rests, its contact never opening.
fn swinging(law: Law, e: f64, dt: f64) -> Simulation {
    let mut setup = empty(law, e);
    setup.gravity.z = -9.81;
    setup.step = Step::Fixed(dt);
    setup.walls = vec![plane(Vec3::z())];
    setup.particles = vec![grain(1, Vec3::new(0.0, 0.0, 0.01 - 0.5 * rests(law)))];
    simulation(setup)
}

/// Overlap at rest [m].
fn rests(law: Law) -> f64 {
    let weight = mass(0.01, 2500.0) * 9.81;
    match law {
        Law::Hooke { stiffness, .. } => weight / stiffness,
        _ => (weight / (4.0 / 3.0 * MODULUS * 0.1)).powf(2.0 / 3.0),
    }
}

/// z = z_r + A e^{−βt} (cos ω_d t + β/ω_d sin ω_d t), after five periods.
#[test]
fn swings_on_a_plane() {
    let (k, m) = (1e4f64, mass(0.01, 2500.0));
    for e in [1.0f64, 0.8] {
        let gamma = if e < 1.0 { -2.0 * e.ln() / (PI * PI + e.ln().powi(2)).sqrt() } else { 0.0 };
        let (omega, beta) = ((k / m).sqrt(), 0.5 * gamma * (k / m).sqrt());
        let damped = (omega * omega - beta * beta).sqrt();
        let rest = rests(HOOKE);
        let off = |dt: f64| {
            let mut sim = swinging(HOOKE, e, dt);
            // A time at which neither sine nor cosine is near zero.
            while sim.time() < 10.3 * PI / omega - 0.5 * dt {
                sim.step().expect("within the guards");
            }
            let t = sim.time();
            let swing = (-beta * t).exp() * ((damped * t).cos() + beta / damped * (damped * t).sin());
            (particles(&mut sim)[0].position.z - (0.01 - rest + 0.5 * rest * swing)) / (0.5 * rest)
        };
        STAYS.order(&format!("hooke, e = {e}"), &points(contact_time(k), off), 2.0, 0.1);
    }
}

/// ½ m v² + m g z + what the contact holds, by its own formula [J].
fn energy(law: Law, p: &Particle) -> f64 {
    let (m, overlap) = (mass(0.01, 2500.0), 0.01 - p.position.z);
    let elastic = match law {
        Law::Hooke { stiffness, .. } => 0.5 * stiffness * overlap * overlap,
        _ => 8.0 / 15.0 * MODULUS * 0.1 * overlap.powf(2.5),
    };
    0.5 * m * p.velocity.norm_squared() + m * 9.81 * p.position.z + elastic
}

/// The integrator keeps a shadow of the energy: the change is bounded, of second order, and does not grow with time.
#[test]
fn energy_of_a_swing() {
    for (law, name) in [(HOOKE, "hooke"), (Law::Hertz, "hertz")] {
        let stiffness = match law {
            Law::Hooke { stiffness, .. } => stiffness,
            _ => 2.0 * MODULUS * (0.01 * rests(law)).sqrt(),
        };
        let time = contact_time(stiffness);
        // Largest change within the last twenty half periods of some.
        let change = |dt: f64, halves: f64| {
            let mut sim = swinging(law, 1.0, dt);
            let start = energy(law, &particles(&mut sim)[0]);
            let scale = mass(0.01, 2500.0) * 9.81 * 0.5 * rests(law);
            run_until(&mut sim, (halves - 20.0) * time);
            let mut most = 0.0f64;
            while sim.time() < halves * time {
                sim.step().expect("within the guards");
                most = most.max((energy(law, &particles(&mut sim)[0]) - start).abs() / scale);
            }
            most
        };
        FLUCTUATES.order(name, &points(time, |dt| change(dt, 20.0)), 2.0, 0.1);
        let (early, late) = (change(0.05 * time, 20.0), change(0.05 * time, 20_000.0));
        FLUCTUATES.within(
            &format!("{name}: growth from 10 to 10 000 periods"),
            late / early - 1.0,
            "–",
            0.02,
        );
    }
}
