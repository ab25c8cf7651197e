//! Sleep: what is at rest is passed over until it is disturbed, and the heap is the one that was computed in full.

use dem::setup::*;
use dem::{Setup, Simulation};
use geom::Vec3;
use grainpipe_tests::same_bits::{Run, particle_bits};
use grainpipe_tests::setups::{HOOKE, LAWS, Law, empty, grain, particles, plane, run_until, with_friction};

/// Grains of radius 10 mm that fall on a floor, 8 × 8 in layers, in a periodic box.
fn filling(law: Law, layers: u32) -> Setup {
    let mut setup = with_friction(empty(law, 0.3), 0.5);
    setup.gravity.z = -9.81;
    setup.step = Step::Auto(0.5);
    setup.periodic = [Some((0.0, 0.17)), Some((0.0, 0.17)), None];
    setup.walls = vec![plane(Vec3::z())];
    setup.particles = (0..64 * layers)
        .map(|k| {
            let shift = 0.001 * f64::from(k * 7 % 11) - 0.005;
            let at = |n: u32| 0.0106 + 0.0212 * f64::from(n % 8);
            grain(
                k,
                Vec3::new(at(k) + 0.2 * shift, at(k / 8) - 0.1 * shift, 0.012 + 0.0213 * f64::from(k / 64)),
            )
        })
        .collect();
    setup
}

fn sleepy(setup: Setup) -> Setup {
    Setup { sleep: Some(Sleep { speed: 1e-3, time: 0.01, wake: 0.05 }), ..setup }
}

fn simulation(setup: Setup) -> Simulation {
    Simulation::new(setup).expect("sound")
}

fn mean_height(sim: &mut Simulation) -> f64 {
    let all = particles(sim);
    all.iter().map(|p| p.position.z).sum::<f64>() / all.len() as f64
}

#[test]
fn a_heap_at_rest_sleeps_where_it_would_lie_awake() {
    for law in LAWS {
        let (mut with, mut without) = (simulation(sleepy(filling(law, 3))), simulation(filling(law, 3)));
        run_until(&mut with, 1.3);
        run_until(&mut without, 1.3);
        let asleep = with.asleep() as f64 / with.particle_count() as f64;
        assert!(asleep > 0.9, "{law:?}: only {asleep:.2} of the heap sleeps");
        assert_eq!(without.asleep(), 0);
        let (a, b) = (mean_height(&mut with), mean_height(&mut without));
        assert!((a - b).abs() < 0.01 * b, "{law:?}: mean height {a} m asleep, {b} m awake");
    }
}

/// A heap that sleeps is woken by a heavy grain that falls on it.
#[test]
fn an_impact_wakes_those_that_it_reaches() {
    let mut setup = sleepy(filling(Law::Hooke { stiffness: 1e5, tangential_ratio: None }, 1));
    setup.guards.overlap = 0.5;
    setup.contacts.iter_mut().for_each(|c| c.set("rolling_resistance", 0.3));
    // Thrown up, it is back at t = 1.22 s with 6.4 m/s.
    let (start, up) = (Vec3::new(0.085, 0.085, 0.5), Vec3::new(0.0, 0.0, 5.6));
    setup.particles.push(Particle { velocity: up, ..grain(9999, start) });
    let mut sim = simulation(setup);
    run_until(&mut sim, 1.2);
    let before = sim.asleep();
    assert!(before > 50, "{before} sleep before the impact");
    let low = particles(&mut sim);
    run_until(&mut sim, 1.26);
    assert!(sim.asleep() < before, "{} sleep while it lands, {before} did before", sim.asleep());
    let moved = |(a, b): (&Particle, &Particle)| (a.position - b.position).norm() > 1e-4;
    let high = particles(&mut sim);
    let stirred = low.iter().zip(&high).filter(|(a, _)| a.id != 9999).filter(|&(a, b)| moved((a, b))).count();
    assert!(stirred > 3, "{stirred} grains were pushed aside");
    run_until(&mut sim, 2.0);
    assert!(sim.asleep() + 10 >= before, "{} sleep in the end", sim.asleep());
}

/// A sleeper whose support is drawn away falls as freely as one that never slept.
#[test]
fn a_sleeper_that_loses_its_support_falls() {
    let mut setup = sleepy(empty(HOOKE, 0.3));
    setup.gravity.z = -9.81;
    let mut floor = plane(Vec3::z());
    // Up and down once in two seconds: it starts at rest height and leaves with 3.1 m/s, faster than the grain.
    floor.motion = Motion { amplitude: Vec3::new(0.0, 0.0, -1.0), frequency: 0.5, ..Motion::still() };
    setup.walls = vec![floor];
    setup.particles = vec![grain(0, Vec3::new(0.0, 0.0, 0.0101))];
    let mut sim = simulation(setup);
    run_until(&mut sim, 0.3);
    assert_eq!(sim.asleep(), 0, "no particle sleeps beside a moving wall");
    let z = particles(&mut sim)[0].position.z;
    let free = 0.0101 - 0.5 * 9.81 * sim.time() * sim.time();
    assert!((z - free).abs() < 1e-3, "fell to {z} m, freely to {free} m");
}

/// A grain and a stack of two at rest on a belt, which starts at 0.1 s: friction is too weak to wake them by its force. They ride on it as far as
/// those that never slept.
#[test]
fn a_belt_that_starts_carries_sleepers_along() {
    let sag = 9.81 * dem::mass(0.01, 2500.0) / 1e4;
    for (speed, friction) in [(0.2, 0.08), (0.2, 0.02), (0.002, 0.04)] {
        let mut setup = with_friction(empty(HOOKE, 0.3), friction);
        (setup.gravity.z, setup.step) = (-9.81, Step::Auto(0.5));
        let mut belt = plane(Vec3::z());
        belt.motion = Motion { velocity: Vec3::new(speed, 0.0, 0.0), from: 0.1, ..Motion::still() };
        setup.walls = vec![belt];
        let places = [(0.0, 0.01 - sag), (0.1, 0.01 - 2.0 * sag), (0.1, 0.03 - 3.0 * sag)];
        setup.particles = (0..).zip(places).map(|(k, (x, z))| grain(k, Vec3::new(x, 0.0, z))).collect();
        let way = |setup: Setup, asleep: usize| {
            let mut sim = simulation(setup);
            run_until(&mut sim, 0.09);
            assert_eq!(sim.asleep(), asleep, "before the start");
            run_until(&mut sim, 0.3);
            particles(&mut sim).iter().map(|p| p.position.x).sum::<f64>() - 0.2
        };
        let rule = Sleep { speed: 1e-3, time: 0.01, wake: 0.1 };
        let asleep = way(Setup { sleep: Some(rule), ..setup.clone() }, 3);
        let awake = way(setup, 0);
        let case = format!("belt {speed} m/s, friction {friction}");
        assert!((asleep / awake - 1.0).abs() < 0.02, "{case}: {asleep} m, {awake} m awake");
    }
}

/// A belt slower than sleep would leave behind what it carries: it is refused.
#[test]
fn a_belt_slower_than_sleep_is_refused() {
    let mut setup = sleepy(filling(HOOKE, 1));
    setup.walls[0].motion.velocity.x = 1.9e-3;
    let refused = Simulation::new(setup.clone()).err().expect("refused");
    let text = scene::advice::explain_setup_error(&refused);
    assert!(text.starts_with("sleep.speed: ") && text.contains("wall 'plane'"), "{text}");
    setup.walls[0].motion.velocity.x = 2.1e-3;
    simulation(setup);
}

/// A sleeper whose neighbour is thrown out of reach within one step wakes: lists are rebuilt in that step, and none of them would
/// tell it that its load is gone.
#[test]
fn a_sleeper_whose_neighbour_is_no_longer_listed_wakes() {
    let mut setup = sleepy(empty(HOOKE, 0.1));
    setup.gravity.z = -9.81;
    // Lists hold only what touches.
    setup.skin = Some(1e-7);
    setup.step = Step::Auto(0.9);
    (setup.guards.overlap, setup.guards.motion) = (0.9, 0.5);
    let edge = |k: u32| {
        let (sin, cos) = (2.0 * std::f64::consts::FRAC_PI_3 * f64::from(k)).sin_cos();
        Vec3::new(0.006 * cos, 0.006 * sin, 0.0)
    };
    let shape =
        WallShape::Mesh(geom::mesh::TriMesh { vertices: (0..3).map(edge).collect(), faces: vec![[0, 1, 2]] });
    setup.walls = vec![Wall { shape, ..plane(Vec3::z()) }];
    setup.particles = vec![grain(0, Vec3::new(0.0, 0.0, 0.01)), grain(1, Vec3::new(0.0, 0.0, 0.03))];
    let mut pair = simulation(setup.clone());
    run_until(&mut pair, 0.3);
    assert_eq!(pair.asleep(), 2, "both sleep before");
    // Another comes from aside and below, 2 mm in a step, and hits the upper one at t = 0.3 s.
    let (sin, cos) = 15f64.to_radians().sin_cos();
    let (v, t) = (Vec3::new(cos, 0.0, sin) * (2e-3 / pair.dt()), 0.3);
    let hits = Vec3::new(-cos, 0.0, -sin) * 0.02 + Vec3::new(0.0, 0.0, 0.03);
    let gravity = Vec3::new(0.0, 0.0, -9.81);
    let third = Particle { velocity: v - gravity * t, ..grain(2, hits - v * t + gravity * (0.5 * t * t)) };
    setup.particles.push(third);
    let mut sim = simulation(setup);
    run_until(&mut sim, 0.299);
    assert_eq!(sim.asleep(), 2, "both sleep until it comes");
    // Ten steps later the third has not yet come near the lower one.
    run_until(&mut sim, 0.301);
    let all = particles(&mut sim);
    assert!(
        all[1].position.z > 0.0305 && all[2].position.z > 0.025,
        "the upper one was thrown away: {all:?}"
    );
    assert_eq!(sim.asleep(), 0, "the lower one is awake, for its load is gone");
}

#[test]
fn sleep_is_the_same_for_every_width_and_thread_and_across_a_checkpoint() {
    let setup = || sleepy(filling(HOOKE, 5));
    let parts: [&(dyn Fn(&mut Simulation) + Sync); 2] =
        [&|sim| run_until(sim, 0.72), &|sim| run_until(sim, 0.8)];
    let bits = |sim: &mut Simulation| (sim.asleep(), particle_bits(sim));
    let look = |sim: &mut Simulation| {
        particles(sim);
    };
    let (asleep, _) = Run { setup: &setup, parts, look: &look, bits: &bits }.check();
    assert!(asleep > 0, "no particle sleeps");
}

/// A heap that sleeps goes on bit for bit when it is resumed, through the impact that wakes it.
#[test]
fn a_sleeping_heap_resumes_bit_for_bit() {
    for law in LAWS {
        let mut setup = sleepy(filling(law, 1));
        setup.contacts.iter_mut().for_each(|c| c.set("rolling_resistance", 0.3));
        let up = Vec3::new(0.0, 0.0, 1.2);
        setup.particles.push(Particle { velocity: up, ..grain(9999, Vec3::new(0.085, 0.085, 0.3)) });
        let mut whole = simulation(setup.clone());
        run_until(&mut whole, 0.3);
        assert!(whole.asleep() > 50, "{law:?}: {} sleep when the state is saved", whole.asleep());
        let mut resumed = Simulation::resume(setup, whole.checkpoint().to_static()).expect("the same setup");
        for end in [0.31, 0.45, 0.6] {
            run_until(&mut whole, end);
            run_until(&mut resumed, end);
            let (a, b) = (particles(&mut whole), particles(&mut resumed));
            assert!(a == b, "{law:?}: differs at {end} s");
        }
    }
}

/// A sleeper that is looked at goes on sleeping: its place does not change by a bit.
#[test]
fn observing_wakes_no_particle() {
    let mut sim = simulation(sleepy(filling(HOOKE, 1)));
    run_until(&mut sim, 0.2);
    assert_eq!(sim.asleep(), 64);
    let before = particles(&mut sim);
    for _ in 0..50 {
        sim.step().expect("within the guards");
        assert_eq!(particles(&mut sim)[7].position, before[7].position);
    }
}

/// What sleepers lose is in the ledger.
#[test]
fn the_ledger_closes_with_sleepers() {
    let mut setup = sleepy(filling(HOOKE, 3));
    setup.ledger = true;
    setup.step = Step::Auto(0.1);
    let mut sim = simulation(setup);
    run_until(&mut sim, 1.6);
    let end = sim.energy().expect("within the guards");
    assert!(sim.asleep() > 100 && end.slept != 0.0);
    let exchanged = end.normal + end.sliding;
    assert!(end.integration.abs() < 2e-3 * exchanged, "{} J of {exchanged} J", end.integration);
}

/// Without the key there is nothing of it.
#[test]
fn no_sleep_no_bytes() {
    assert_eq!(simulation(filling(HOOKE, 2)).asleep(), 0);
    assert!(
        simulation(filling(HOOKE, 2)).bytes_per_particle()
            < simulation(sleepy(filling(HOOKE, 2))).bytes_per_particle()
    );
}
