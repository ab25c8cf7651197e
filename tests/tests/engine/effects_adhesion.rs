//! Impacts of every normal law on a pair, a plane and wall spheres; making, lasting and breaking of contacts that adhere.

use dem::setup::*;
use dem::{Setup, Simulation, mass};
use geom::Vec3;
use grainpipe_tests::normals::{MODULUS, NORMALS, Normal, SURFACES, Surface, WORK, still};
use grainpipe_tests::setups::{Law, grain, particles, run_until};
use scene::advice::explain_setup_error;
use std::f64::consts::PI;

const JKR: Normal = NORMALS[2];

fn simulation(setup: Setup) -> Simulation {
    Simulation::new(setup).expect("the setup is sound")
}

/// 7.09 (w⁵ R*⁴/E*²)^(1/3): what a cycle of making and breaking takes [J], and the gap at which it breaks [m].
fn cycle(radius: f64) -> (f64, f64) {
    let last = (PI * WORK * radius * radius / (8.0 * MODULUS)).cbrt();
    (4.0 * PI * WORK * last * last * (0.1 + 0.15 * 4f64.powf(4.0 / 3.0)), 3.0 * last * last / radius)
}

/// Two grains that meet head on with a speed each, or one that meets a wall.
fn impact(normal: Normal, e: f64, on: Option<Surface>, speed: f64) -> Setup {
    let mut setup = normal.setup(e);
    setup.ledger = true;
    setup.step = Step::Auto(0.002);
    let mut a = grain(1, Vec3::new(0.0, 0.0, 0.010_000_5));
    a.velocity.z = -speed;
    setup.particles = vec![a];
    match on {
        Some(surface) => setup.walls = vec![surface.wall()],
        None => {
            let mut b = grain(2, Vec3::new(0.0, 0.0, -0.010_000_5));
            b.velocity.z = speed;
            setup.particles.push(b);
        }
    }
    setup
}

/// Speed of the rebound; `None` when the grain has not come free after a while.
fn rebound(sim: &mut Simulation) -> Option<f64> {
    for _ in 0..400_000 {
        sim.step().expect("within the guards");
        let p = particles(sim)[0];
        if p.velocity.z > 0.0 && p.position.z > 0.0101 {
            return Some(p.velocity.z);
        }
    }
    None
}

/// e = 1: a grain comes back as fast as it went, and with JKR at √(v² − 2W/m), W the area of the hysteresis; the ledger says the
/// same. e < 1 without cohesion: e is exact, on wall spheres too.
#[test]
fn every_normal_law_rebounds_as_its_energy_says() {
    for normal in NORMALS {
        for on in [None, Some(Surface::Plane), Some(Surface::Sphere)] {
            for speed in [0.02, 0.05] {
                let mut sim = simulation(impact(normal, 1.0, on, speed));
                let got = rebound(&mut sim).expect("fast enough to come free");
                let adheres = matches!(normal.law, Law::Jkr { .. });
                let (m, radius) = (mass(0.01, 2500.0), if on.is_some() { 0.01 } else { 0.005 });
                let (grains, lost) =
                    (if on.is_some() { 1.0 } else { 2.0 }, if adheres { cycle(radius).0 } else { 0.0 });
                let expected = (speed * speed - 2.0 * lost / (grains * m)).sqrt();
                let case = format!("{} on {on:?} at {speed} m/s", normal.name);
                assert!((got / expected - 1.0).abs() < 1e-3, "{case}: {got} m/s instead of {expected}");
                let energy = sim.energy().expect("sound");
                assert!(
                    (energy.normal - lost).abs() <= 1e-5 * lost,
                    "{case}: {} J of {lost} J booked",
                    energy.normal
                );
                assert_eq!(energy.elastic, 0.0, "{case}: nothing is left in a contact that is none");
            }
            if normal.cohesion.is_none() && !matches!(normal.law, Law::Jkr { .. }) {
                for e in [0.1, 0.5, 0.9] {
                    let got =
                        rebound(&mut simulation(impact(normal, e, on, 0.05))).expect("nothing holds it");
                    assert!(
                        (got / 0.05 - e).abs() < 1e-3,
                        "{} on {on:?}, e = {e}: {}",
                        normal.name,
                        got / 0.05
                    );
                }
            }
        }
    }
}

/// The deepest overlap of an elastic impact is where the contact holds ½ m* v² more than when it was made; with Hertz that is
/// δ_max = (15 m* v²/(16 √R* E*))^0.4.
#[test]
fn deepest_overlap_holds_the_energy_of_the_impact() {
    for normal in NORMALS {
        for on in [None, Some(Surface::Plane), Some(Surface::Sphere)] {
            let m = mass(0.01, 2500.0);
            let (reduced, speed, radius, curvature) =
                if on.is_some() { (m, 0.2, 0.01, 0.0) } else { (0.5 * m, 0.4, 0.005, 50.0) };
            let energy = 0.5 * reduced * speed * speed;
            let held = |overlap: f64| normal.response(&still(overlap, radius, curvature)).elastic;
            let (mut low, mut high) = (0.0, 2e-3);
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if held(middle) - held(0.0) < energy { low = middle } else { high = middle }
            }
            let mut sim = simulation(impact(normal, 1.0, on, 0.2));
            let mut deepest = 0.0f64;
            for _ in 0..4000 {
                sim.step().expect("within the guards");
                let p = particles(&mut sim);
                let gap = if on.is_some() {
                    p[0].position.z - 0.01
                } else {
                    (p[0].position - p[1].position).norm() - 0.02
                };
                deepest = deepest.max(-gap);
            }
            assert!(deepest > 0.0 && particles(&mut sim)[0].velocity.z > 0.0, "it has turned round");
            assert!(
                (deepest / high - 1.0).abs() < 1e-3,
                "{} on {on:?}: {deepest} m, not {high} m",
                normal.name
            );
            if normal.name == "hertz" {
                let closed = (15.0 * reduced * speed * speed / (16.0 * radius.sqrt() * MODULUS)).powf(0.4);
                assert!((high / closed - 1.0).abs() < 1e-9);
            }
        }
    }
}

/// With cohesion e is that of the dashpot alone: a grain comes back slower than e v, never faster, and by the less the faster it is.
#[test]
fn restitution_with_cohesion_is_that_of_the_dashpot_when_fast() {
    for normal in &NORMALS[2..] {
        let got = |speed: f64| {
            let mut setup = impact(*normal, 0.8, Some(Surface::Plane), speed);
            setup.step = Step::Auto(0.005);
            rebound(&mut simulation(setup)).expect("fast enough") / speed
        };
        let (slow, fast) = (got(0.03), got(2.0));
        println!("{}: {slow} at 0.03 m/s, {fast} at 2 m/s", normal.name);
        assert!(slow < 0.8, "{}: {slow}", normal.name);
        if normal.name != "hooke with cohesion" {
            assert!((fast - 0.8).abs() < 0.03 && fast > slow, "{}: {fast}", normal.name);
        }
    }
}

/// Below √(2W/m) a grain sticks, above it comes free.
#[test]
fn grains_stick_below_the_speed_of_the_cycle() {
    for on in SURFACES {
        let limit = (2.0 * cycle(0.01).0 / mass(0.01, 2500.0)).sqrt();
        for (share, free) in [(0.97, false), (1.03, true)] {
            let got = rebound(&mut simulation(impact(JKR, 1.0, Some(on), share * limit)));
            assert_eq!(got.is_some(), free, "{on:?}: {share} of {limit} m/s");
        }
    }
}

/// Contact is made at δ = 0 and no sooner, and lasts until −δ_c, also if lists are rebuilt meanwhile.
#[test]
fn contact_is_made_at_touch_and_broken_at_the_pull_off_distance() {
    for skin in [None, Some(1e-7)] {
        let mut setup = JKR.setup(1.0);
        setup.skin = skin;
        setup.step = Step::Auto(0.005);
        let gap = cycle(0.005).1;
        // Within the reach of a contact, but none was made.
        let mut near = grain(1, Vec3::new(0.0, 0.0, 0.01 + 0.25 * gap));
        let far = grain(2, Vec3::new(0.0, 0.0, -0.01 - 0.25 * gap));
        setup.particles = vec![near, far];
        let mut sim = simulation(setup.clone());
        run_until(&mut sim, 0.01);
        assert_eq!(particles(&mut sim)[0].velocity, Vec3::zeros(), "they do not feel each other");
        // Pulled apart from touch: slowed down up to the gap of the break, and free beyond.
        near.position.z = 0.01 - 1e-9;
        near.velocity.z = 0.02;
        setup.particles = vec![near, Particle { position: -near.position, velocity: -near.velocity, ..far }];
        let mut sim = simulation(setup);
        let (mut before, mut last) = (0.02, 0.0);
        for _ in 0..40_000 {
            sim.step().expect("within the guards");
            let p = particles(&mut sim)[0];
            if p.velocity.z < before {
                last = 2.0 * p.position.z - 0.02;
            }
            before = p.velocity.z;
        }
        assert!(before < 0.0199, "it was held: {before} m/s");
        assert!((last / gap - 1.0).abs() < 0.02, "held until {last} m, not {gap} m");
    }
}

/// Two grains that stick look the same from a frame that moves, in which they are listed again and again and change places.
#[test]
fn stretched_contact_survives_listing() {
    let relative = |speed: f64| {
        let mut setup = impact(JKR, 1.0, None, 0.003);
        setup.step = Step::Auto(0.02);
        setup.skin = Some(1e-4);
        setup.particles.iter_mut().for_each(|p| p.velocity.x += speed);
        setup.particles.push(grain(9, Vec3::new(-0.5, 0.3, 0.0)));
        let mut sim = simulation(setup);
        let mut gaps = Vec::new();
        for k in 1..200 {
            run_until(&mut sim, 1e-4 * f64::from(k));
            let p = particles(&mut sim);
            gaps.push((p[0].position - p[1].position).norm() - 0.02);
        }
        (gaps, sim.rebuilds(), sim.energy().expect("sound").normal)
    };
    let ((still, few, once), (moving, many, again)) = (relative(0.0), relative(3.0));
    assert!(many > 10 * few, "{many} listings against {few}");
    assert!(still.iter().any(|&g| g > 2e-7), "the contact is stretched: {still:?}");
    assert!(still.iter().all(|&g| g < cycle(0.005).1), "and holds");
    assert!((again / once - 1.0).abs() < 1e-9, "made once: {once} J, and {again} J booked");
    for (a, b) in still.iter().zip(&moving) {
        assert!((a - b).abs() < 1e-10, "{a} m and {b} m");
    }
}

/// Two grains that stick turn about each other, change places in the list at every half turn, and stay one contact: it is
/// booked once, and their energy stays.
#[test]
fn turning_pair_remembers_its_contact() {
    let mut setup = JKR.setup(1.0);
    (setup.ledger, setup.skin, setup.step) = (true, Some(1e-3), Step::Auto(0.02));
    // The last one holds the cells of the search in place.
    setup.particles = vec![grain(1, Vec3::z() * 0.0099999), grain(2, Vec3::z() * -0.0099999)];
    setup.particles[0].velocity.x = 0.1;
    setup.particles[1].velocity.x = -0.1;
    setup.particles.push(grain(9, Vec3::new(-0.5, 0.3, -0.031)));
    let mut sim = simulation(setup);
    // What is lost in a step is booked at its end.
    sim.step().expect("within the guards");
    let mut lowest = 0.0f64;
    for k in 1..140 {
        run_until(&mut sim, 0.005 * f64::from(k));
        lowest = lowest.min(particles(&mut sim)[0].position.z);
    }
    let (e, p) = (sim.energy().expect("sound"), particles(&mut sim));
    assert!(lowest < -0.0099 && sim.rebuilds() > 10, "they have turned: {lowest} m");
    assert!((p[0].position - p[1].position).norm() < 0.02 + cycle(0.005).1, "and hold");
    assert!((e.normal / cycle(0.005).0 - 1.0).abs() < 1e-9, "{} J booked", e.normal);
    assert!(e.integration.abs() < 1e-6 * e.translation, "{:e} J", e.integration);
}

/// Cohesion that would pull grains into each other beyond the guard is refused, with its key.
#[test]
fn cohesion_that_nothing_bears_is_refused() {
    let refused = |law, cohesion| {
        let mut setup = Normal { name: "", law, cohesion }.setup(0.5);
        setup.particles = vec![grain(1, Vec3::zeros())];
        Simulation::new(setup).err().map(|e| explain_setup_error(&e))
    };
    let hooke = NORMALS[0].law;
    assert!(refused(hooke, Some(1.5e5)).is_none());
    assert!(refused(hooke, Some(1.7e5)).expect("k/2πR*").contains("cohesion_energy_density"));
    assert!(refused(Law::Hertz, Some(1e6)).expect("too strong").contains("cohesion_energy_density"));
    assert!(
        refused(Law::Jkr { work_of_adhesion: 1e4 }, None).expect("too strong").contains("work_of_adhesion")
    );
    assert!(refused(JKR.law, Some(1.0)).expect("both").contains("work_of_adhesion"));
}
