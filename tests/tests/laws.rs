//! Laws with closed answers: one contact, friction, rolling, many.

use dem::setup::*;
use dem::{Setup, Simulation, mass};
use geom::Vec3;
use grainpipe_tests::setups::{HOOKE, LAWS, empty, grain, particles, plane, run_until, with_friction};
use std::f64::consts::PI;

fn simulation(setup: Setup) -> Simulation {
    Simulation::new(setup).expect("the setup is sound")
}

/// z = z₀ + v t − g t²/2, exactly but for rounding.
#[test]
fn free_flight() {
    let mut setup = empty(HOOKE, 0.5);
    setup.gravity = Vec3::new(0.0, 0.0, -9.81);
    setup.step = Step::Fixed(1e-4);
    let mut p = grain(1, Vec3::new(0.0, 0.0, 5.0));
    p.velocity = Vec3::new(1.0, -2.0, 3.0);
    setup.particles = vec![p];
    let mut sim = simulation(setup);
    for _ in 0..10_000 {
        sim.step().expect("free");
    }
    let (t, p) = (sim.time(), particles(&mut sim)[0]);
    let there = Vec3::new(t, -2.0 * t, 5.0 + 3.0 * t - 0.5 * 9.81 * t * t);
    assert!((p.position - there).norm() < 1e-11, "{} instead of {there}", p.position);
    assert!((p.velocity - Vec3::new(1.0, -2.0, 3.0 - 9.81 * t)).norm() < 1e-11);
}

/// Rebound at e times the speed of approach, for every normal law, pair and plane, 0.01–10 m/s.
#[test]
fn restitution_as_asked() {
    for law in LAWS {
        for e in [0.1, 0.3, 0.5, 0.7, 0.9, 1.0] {
            for speed in [0.01, 0.3, 10.0] {
                for wall in [false, true] {
                    let got = rebound(law, e, speed, wall);
                    assert!((got - e).abs() < 1e-3, "{law:?} e = {e}, {speed} m/s, wall {wall}: {got}");
                }
            }
        }
    }
}

fn rebound(law: Law, e: f64, speed: f64, wall: bool) -> f64 {
    // Stiff enough that 10 m/s stays within the overlap guard.
    let law =
        if let Law::Hooke { .. } = law { Law::Hooke { stiffness: 1e7, tangential_ratio: None } } else { law };
    let mut setup = empty(law, e);
    setup.materials.iter_mut().for_each(|m| m.young = 5e10);
    // The dashpot sets in and ends with a jump, which a step cuts short: an error of first order in Δt.
    setup.step = Step::Auto(0.005);
    let mut a = grain(1, Vec3::new(0.0, 0.0, 0.010001));
    a.velocity.z = -speed;
    setup.particles = vec![a];
    if wall {
        setup.walls = vec![plane(Vec3::z())];
    } else {
        let mut b = grain(2, Vec3::new(0.0, 0.0, -0.010001));
        b.velocity.z = speed;
        setup.particles.push(b);
    }
    let mut sim = simulation(setup);
    for _ in 0..2_000_000 {
        sim.step().expect("within the guards");
        let p = particles(&mut sim)[0];
        if p.velocity.z > 0.0 && p.position.z > 0.010001 {
            return p.velocity.z / speed;
        }
    }
    panic!("no rebound");
}

/// δ_max and F_max of a Hertzian impact, and its duration, against the closed formulas: glass and limestone,
/// two spheres of 10 mm at ±10 m/s.
#[test]
fn hertz_impact() {
    let cases = [
        (4.8e10, 0.20, 2800.0, 10_697.0, 274.1e-6, 40.4e-6),
        (2e10, 0.25, 2500.0, 7_108.0, 368.3e-6, 54.2e-6),
    ];
    for (young, poisson, density, force, overlap, duration) in cases {
        let mut setup = empty(Law::Hertz, 1.0);
        setup.materials[0] = Material { name: "stone".to_owned(), density, young, poisson };
        setup.step = Step::Auto(0.005);
        for (id, side) in [(1, 1.0), (2, -1.0)] {
            let mut p = grain(id, Vec3::new(side * 0.010_000_1, 0.0, 0.0));
            p.velocity.x = -side * 10.0;
            setup.particles.push(p);
        }
        let m = mass(0.01, density);
        let mut sim = simulation(setup);
        let (mut deepest, mut strongest, mut inside, mut before) = (0.0f64, 0.0f64, 0.0, 10.0);
        for _ in 0..40_000 {
            sim.step().expect("within the guards");
            let p = particles(&mut sim);
            let delta = 0.02 - (p[0].position - p[1].position).norm();
            deepest = deepest.max(delta);
            strongest = strongest.max((p[0].velocity.x + before).abs() / sim.dt() * m);
            before = -p[0].velocity.x;
            inside += if delta > 0.0 { sim.dt() } else { 0.0 };
        }
        assert!((deepest / overlap - 1.0).abs() < 1e-3, "δ {deepest}");
        assert!((strongest / force - 1.0).abs() < 1e-3, "F {strongest}");
        assert!((inside / duration - 1.0).abs() < 3e-3, "t {inside}");
    }
}

/// t_c = π/√(k/m* − (c/2m*)²) of the linear law.
#[test]
fn hooke_contact_time() {
    let mut setup = empty(HOOKE, 0.6);
    setup.step = Step::Auto(0.002);
    for (id, side) in [(1, 1.0), (2, -1.0)] {
        let mut p = grain(id, Vec3::new(side * 0.010_001, 0.0, 0.0));
        p.velocity.x = -side * 0.1;
        setup.particles.push(p);
    }
    let reduced = 0.5 * mass(0.01, 2500.0);
    let ln = 0.6f64.ln();
    let gamma = -2.0 * ln / (PI * PI + ln * ln).sqrt();
    let omega2 = 1e4 / reduced;
    let expected = PI / (omega2 * (1.0 - gamma * gamma / 4.0)).sqrt();
    let mut sim = simulation(setup);
    let mut inside = 0.0;
    for _ in 0..40_000 {
        sim.step().expect("within the guards");
        let p = particles(&mut sim);
        inside += if (p[0].position - p[1].position).norm() < 0.02 { sim.dt() } else { 0.0 };
    }
    assert!((inside / expected - 1.0).abs() < 2e-3, "{inside} s instead of {expected} s");
}

/// Momentum and angular momentum of an oblique collision with friction, to rounding.
#[test]
fn two_body_collision_conserves_momentum_and_angular_momentum() {
    for law in LAWS {
        let mut setup = with_friction(empty(law, 0.6), 0.4);
        let mut a = grain(1, Vec3::new(0.011, 0.004, -0.001));
        let mut b = grain(2, Vec3::new(-0.011, -0.002, 0.002));
        (a.radius, a.velocity, a.spin) = (0.007, Vec3::new(-0.3, 0.05, 0.1), Vec3::new(10.0, -5.0, 3.0));
        (b.velocity, b.spin) = (Vec3::new(0.2, 0.0, 0.02), Vec3::new(0.0, 7.0, -20.0));
        setup.particles = vec![a, b];
        let totals = |ps: &[Particle]| {
            let mut sum = (Vec3::zeros(), Vec3::zeros());
            for p in ps {
                let m = mass(p.radius, 2500.0);
                sum.0 += m * p.velocity;
                sum.1 += m * p.position.cross(&p.velocity) + 0.4 * m * p.radius * p.radius * p.spin;
            }
            sum
        };
        let start = setup.particles.clone();
        let before = totals(&start);
        let mut sim = simulation(setup);
        run_until(&mut sim, 0.1);
        let now = particles(&mut sim);
        assert!((now[0].spin - start[0].spin).norm() > 0.1, "they have touched");
        let after = totals(&now);
        assert!(
            (after.0 - before.0).norm() < 1e-14 * before.0.norm().max(1e-3),
            "{:e}",
            (after.0 - before.0).norm()
        );
        // The moment arms are those of the step, the velocities move on: angular momentum is kept to O(Δt²).
        assert!((after.1 - before.1).norm() < 1e-6 * before.1.norm(), "{:e}", (after.1 - before.1).norm());
    }
}

/// A ball thrown along a floor without spin slides until t = 2v₀/7μg and then rolls at 5/7 v₀, whatever μ is.
#[test]
fn thrown_ball_slides_then_rolls_at_five_sevenths_of_its_speed() {
    for law in LAWS {
        for mu in [0.1, 0.3, 0.8] {
            let mut setup = with_friction(empty(law, 0.5), mu);
            setup.gravity.z = -9.81;
            setup.walls = vec![plane(Vec3::z())];
            let mut ball = grain(1, Vec3::new(0.0, 0.0, at_rest(law)));
            ball.velocity.x = 1.0;
            setup.particles = vec![ball];
            let mut sim = simulation(setup);
            let rolls = 2.0 / (7.0 * mu * 9.81);
            run_until(&mut sim, 0.5 * rolls);
            let p = particles(&mut sim)[0];
            assert!(
                (p.velocity.x - (1.0 - mu * 9.81 * sim.time())).abs() < 2e-3,
                "{law:?} μ = {mu} slides: {}",
                p.velocity.x
            );
            run_until(&mut sim, 1.5 * rolls);
            let p = particles(&mut sim)[0];
            assert!((p.velocity.x - 5.0 / 7.0).abs() < 2e-3, "{law:?} μ = {mu} rolls: {}", p.velocity.x);
            assert!((p.spin.y * 0.01 - p.velocity.x).abs() < 3e-3, "rolls without sliding");
        }
    }
}

/// Height at which a grain of 10 mm rests on a plane, m g = F_n(δ).
fn at_rest(law: Law) -> f64 {
    let weight = mass(0.01, 2500.0) * 9.81;
    let delta = match law {
        Law::Hooke { stiffness, .. } => weight / stiffness,
        _ => {
            let modulus = 1e7 / (1.0 - 0.25 * 0.25) / 2.0;
            (weight / (4.0 / 3.0 * modulus * 0.1)).powf(2.0 / 3.0)
        }
    };
    0.01 - delta
}

/// A block of one ball that cannot turn would slide below arctan μ; a ball rolls down at 5/7 g sin θ when it sticks.
#[test]
fn ball_rolls_down_a_slope() {
    for law in LAWS {
        let theta = 20f64.to_radians();
        let mut setup = with_friction(empty(law, 0.5), 0.5);
        setup.gravity = Vec3::new(9.81 * theta.sin(), 0.0, -9.81 * theta.cos());
        setup.walls = vec![plane(Vec3::z())];
        setup.particles = vec![grain(1, Vec3::new(0.0, 0.0, at_rest(law)))];
        let mut sim = simulation(setup);
        run_until(&mut sim, 0.5);
        let v = particles(&mut sim)[0].velocity.x;
        let expected = 5.0 / 7.0 * 9.81 * theta.sin() * sim.time();
        assert!((v / expected - 1.0).abs() < 5e-3, "{law:?}: {v} instead of {expected}");
    }
}

/// On a slope steeper than tan θ = 7/2 μ a ball slides: g (sin θ − μ cos θ).
#[test]
fn ball_slides_down_a_steep_slope() {
    for law in LAWS {
        let (theta, mu) = (40f64.to_radians(), 0.1);
        let mut setup = with_friction(empty(law, 0.5), mu);
        setup.gravity = Vec3::new(9.81 * theta.sin(), 0.0, -9.81 * theta.cos());
        setup.walls = vec![plane(Vec3::z())];
        setup.particles = vec![grain(1, Vec3::new(0.0, 0.0, at_rest(law)))];
        let mut sim = simulation(setup);
        run_until(&mut sim, 0.5);
        let v = particles(&mut sim)[0].velocity.x;
        let expected = 9.81 * (theta.sin() - mu * theta.cos()) * sim.time();
        assert!((v / expected - 1.0).abs() < 5e-3, "{law:?}: {v} instead of {expected}");
    }
}

/// A rolling ball slows down by (5/7) μ_r g; one on a slope below arctan μ_r stays put, one above does not.
#[test]
fn rolling_resistance() {
    for law in LAWS {
        let mut base = with_friction(empty(law, 0.5), 0.6);
        base.contacts.iter_mut().for_each(|c| c.rolling_resistance = Some(0.1));
        base.walls = vec![plane(Vec3::z())];
        base.particles = vec![grain(1, Vec3::new(0.0, 0.0, at_rest(law)))];

        let mut setup = base.clone();
        setup.gravity.z = -9.81;
        setup.particles[0].velocity.x = 1.0;
        setup.particles[0].spin.y = 100.0;
        let mut sim = simulation(setup);
        run_until(&mut sim, 0.5);
        let v = particles(&mut sim)[0].velocity.x;
        let expected = 1.0 - 5.0 / 7.0 * 0.1 * 9.81 * sim.time();
        assert!((v - expected).abs() < 5e-3, "{law:?}: {v} m/s instead of {expected}");

        for (share, stays) in [(0.9, true), (1.1, false)] {
            let theta = (share * 0.1f64).atan();
            let mut setup = base.clone();
            setup.gravity = Vec3::new(9.81 * theta.sin(), 0.0, -9.81 * theta.cos());
            let mut sim = simulation(setup);
            run_until(&mut sim, 1.0);
            let p = particles(&mut sim)[0];
            // Hertz is softest at first touch: the spring may give a little before it holds.
            assert_eq!(
                p.position.x.abs() < 1e-3 && p.velocity.norm() < 1e-3,
                stays,
                "{law:?} {share}: {p:?}"
            );
        }
    }
}

/// A column at rest: the force under the n-th sphere is the weight above it.
#[test]
fn static_column() {
    for law in LAWS {
        let mut setup = empty(law, 0.1);
        setup.gravity.z = -9.81;
        setup.step = Step::Auto(0.8);
        setup.walls = vec![plane(Vec3::z())];
        let n = 10;
        setup.particles = (0..n).map(|k| grain(k, Vec3::new(0.0, 0.0, 0.01 + 0.02 * k as f64))).collect();
        let modulus = 1e7 / (1.0 - 0.25 * 0.25) / 2.0;
        let mut sim = simulation(setup);
        run_until(&mut sim, 6.0);
        let p = particles(&mut sim);
        let weight = mass(0.01, 2500.0) * 9.81;
        for k in 0..n as usize {
            let (gap, radius): (f64, f64) = if k == 0 {
                (p[0].position.z - 0.01, 0.01)
            } else {
                (p[k].position.z - p[k - 1].position.z - 0.02, 0.005)
            };
            let delta = -gap;
            let force = match law {
                Law::Hooke { stiffness, .. } => stiffness * delta,
                _ => 4.0 / 3.0 * modulus * radius.sqrt() * delta.powf(1.5),
            };
            let above = weight * (n as f64 - k as f64);
            assert!((force / above - 1.0).abs() < 1e-9, "{law:?} contact {k}: {force} N under {above} N");
        }
    }
}

/// Rebound heights h_k = (h₀ − r) e^{2k} + r.
#[test]
fn bouncing_ball() {
    for law in LAWS {
        let law = if let Law::Hooke { .. } = law {
            Law::Hooke { stiffness: 1e7, tangential_ratio: None }
        } else {
            law
        };
        let mut setup = empty(law, 0.8);
        setup.materials.iter_mut().for_each(|m| m.young = 5e10);
        setup.gravity.z = -9.81;
        setup.step = Step::Auto(0.02);
        setup.walls = vec![plane(Vec3::z())];
        setup.particles = vec![grain(1, Vec3::new(0.0, 0.0, 0.31))];
        let mut sim = simulation(setup);
        for k in 1..4 {
            while particles(&mut sim)[0].velocity.z <= 0.0 {
                sim.step().expect("within the guards");
            }
            while particles(&mut sim)[0].velocity.z > 0.0 {
                sim.step().expect("within the guards");
            }
            let expected = 0.3 * 0.8f64.powi(2 * k) + 0.01;
            let height = particles(&mut sim)[0].position.z;
            assert!(
                (height / expected - 1.0).abs() < 5e-3,
                "{law:?} bounce {k}: {height} m instead of {expected} m"
            );
        }
    }
}

/// A collision looks the same from a frame that moves: also while the pair is sorted anew again and again, and its two partners
/// change places in the list.
#[test]
fn galilean_invariance() {
    for law in [Law::Hooke { stiffness: 100.0, tangential_ratio: None }, Law::Hertz] {
        let relative = |speed: f64| {
            let mut setup = with_friction(empty(law, 0.7), 0.4);
            setup.materials.iter_mut().for_each(|m| m.young = 1e4);
            setup.contacts.iter_mut().for_each(|c| c.rolling_resistance = Some(0.2));
            setup.skin = Some(0.001);
            // A grain that stays holds the grid in place.
            setup.particles = vec![grain(9, Vec3::new(-0.5, 0.3, 0.0))];
            for (id, side) in [(2, -1.0), (1, 1.0)] {
                let mut p = grain(id, Vec3::new(side * 0.009_99, side * 0.002, 0.0));
                p.velocity = Vec3::new(speed - side * 0.05, side * 0.08, 0.0);
                p.spin = Vec3::new(0.0, 3.0, 5.0);
                setup.particles.push(p);
            }
            let mut sim = simulation(setup);
            let mut seen = Vec::new();
            for _ in 0..40 {
                let next = sim.time() + 0.001;
                run_until(&mut sim, next);
                let p = particles(&mut sim);
                let (a, b) = (p[0], p[1]);
                seen.push([a.position - b.position, a.velocity - b.velocity, a.spin - b.spin]);
            }
            (seen, sim.listings())
        };
        let ((still, few), (moving, many)) = (relative(0.0), relative(7.0));
        assert!(many > 10 * few, "{many} listings against {few}");
        for (a, b) in still.iter().flatten().zip(moving.iter().flatten()) {
            assert!((a - b).norm() < 1e-9 * (1.0 + a.norm()), "{law:?}: {a} and {b}");
        }
    }
}
