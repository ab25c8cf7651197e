//! Sliding, rolling and twisting with every normal law, on a plane and on wall spheres.

use dem::setup::*;
use dem::{Setup, Simulation, mass};
use geom::Vec3;
use grainpipe_tests::normals::{NORMALS, SURFACES};
use grainpipe_tests::setups::{particles, run_until};

fn simulation(setup: Setup) -> Simulation {
    Simulation::new(setup).expect("the setup is sound")
}

/// Every normal law on every surface: a grain at rest, and what friction is capped by over its mass [m/s²].
fn all(friction: f64, test: impl Fn(Setup, f64, &str)) {
    for normal in NORMALS {
        for surface in SURFACES {
            let (mut setup, press) = normal.resting(0.5, surface);
            setup.contacts.iter_mut().for_each(|c| c.sliding_friction = Some(friction));
            test(setup, press, &format!("{} on {surface:?}", normal.name));
        }
    }
}

fn each(setup: &mut Setup, change: impl Fn(&mut Contact)) {
    setup.contacts.iter_mut().for_each(change);
}

/// Turns gravity, not the surface.
fn tilt(setup: &mut Setup, theta: f64) {
    setup.gravity = Vec3::new(9.81 * theta.sin(), 0.0, -9.81 * theta.cos());
}

/// Slides until 2v₀/7μp, then rolls at 5/7 v₀; p is g, and with adhesion (F_n + 2F_po)/m.
#[test]
fn thrown_ball() {
    all(0.3, |mut setup, press, case| {
        setup.particles[0].velocity.x = 1.0;
        let mut sim = simulation(setup);
        let rolls = 2.0 / (7.0 * 0.3 * press);
        run_until(&mut sim, 0.5 * rolls);
        let p = particles(&mut sim)[0];
        let expected = 1.0 - 0.3 * press * sim.time();
        assert!((p.velocity.x - expected).abs() < 2e-3, "{case} slides: {} not {expected}", p.velocity.x);
        run_until(&mut sim, 1.5 * rolls);
        let p = particles(&mut sim)[0];
        // It rolls on r − δ.
        assert!((p.velocity.x - 5.0 / 7.0).abs() < 4e-3, "{case} rolls: {}", p.velocity.x);
        assert!((p.spin.y * 0.01 - p.velocity.x).abs() < 6e-3, "{case} rolls without sliding");
    });
}

/// Rolls down a slope at 5/7 g sin θ while it sticks.
#[test]
fn ball_rolls_down_a_slope() {
    all(0.5, |mut setup, _, case| {
        let theta = 20f64.to_radians();
        tilt(&mut setup, theta);
        let mut sim = simulation(setup);
        run_until(&mut sim, 0.3);
        let expected = 5.0 / 7.0 * 9.81 * theta.sin() * sim.time();
        let v = particles(&mut sim)[0].velocity.x;
        assert!((v / expected - 1.0).abs() < 5e-3, "{case}: {v} instead of {expected}");
    });
}

/// Without cohesion a ball slides down a slope steeper than tan θ = 7/2 μ at g (sin θ − μ cos θ).
#[test]
fn ball_slides_down_a_steep_slope() {
    all(0.1, |mut setup, _, case| {
        if case.contains("cohesion") || case.contains("jkr") {
            return;
        }
        let theta = 40f64.to_radians();
        tilt(&mut setup, theta);
        let mut sim = simulation(setup);
        run_until(&mut sim, 0.3);
        let expected = 9.81 * (theta.sin() - 0.1 * theta.cos()) * sim.time();
        let v = particles(&mut sim)[0].velocity.x;
        assert!((v / expected - 1.0).abs() < 5e-3, "{case}: {v} instead of {expected}");
    });
}

/// Both models of rolling resistance slow a rolling ball down by (5/7) μ_r p.
#[test]
fn rolling_ball_slows_down() {
    for model in [RollingModel::Spring, RollingModel::Constant] {
        all(0.6, |mut setup, press, case| {
            each(&mut setup, |c| (c.rolling_resistance, c.rolling_model) = (Some(0.1), model));
            (setup.particles[0].velocity.x, setup.particles[0].spin.y) = (0.5, 50.0);
            let mut sim = simulation(setup);
            run_until(&mut sim, 0.2);
            let v = particles(&mut sim)[0].velocity.x;
            let expected = 0.5 - 5.0 / 7.0 * 0.1 * press * sim.time();
            assert!((v - expected).abs() < 3e-3, "{case}, {model:?}: {v} m/s instead of {expected}");
        });
    }
}

/// The spring holds a ball on a slope below arctan μ_r and not above; the constant couple lets it creep, the slower the shorter
/// the step, and lets it come to rest on level ground without jitter.
#[test]
fn slopes_and_rest_with_rolling_resistance() {
    all(0.6, |base, press, case| {
        for (share, stays) in [(0.9, true), (1.1, false)] {
            let mut setup = base.clone();
            each(&mut setup, |c| c.rolling_resistance = Some(0.1));
            // Pressed by more than its weight, it holds on steeper slopes.
            tilt(&mut setup, (share * 0.1 * press / 9.81).atan());
            let mut sim = simulation(setup);
            run_until(&mut sim, 0.5);
            let p = particles(&mut sim)[0];
            let rests = p.position.x.abs() < 1e-3 && p.velocity.norm() < 1e-3;
            assert_eq!(rests, stays, "{case} {share}: {p:?}");
        }
        let creep = |safety: f64| {
            let mut setup = base.clone();
            each(&mut setup, |c| {
                (c.rolling_resistance, c.rolling_model) = (Some(0.1), RollingModel::Constant);
            });
            tilt(&mut setup, 0.05);
            setup.step = Step::Auto(safety);
            let mut sim = simulation(setup);
            run_until(&mut sim, 0.1);
            particles(&mut sim)[0].velocity.x
        };
        let (coarse, fine) = (creep(0.1), creep(0.05));
        assert!(
            fine > 0.0 && coarse < 2e-2 && (coarse / fine - 2.0).abs() < 0.1,
            "{case}: {coarse}, {fine} m/s"
        );
        let mut setup = base.clone();
        each(&mut setup, |c| (c.rolling_resistance, c.rolling_model) = (Some(0.1), RollingModel::Constant));
        (setup.particles[0].velocity.x, setup.particles[0].spin.y) = (0.05, 5.0);
        let mut sim = simulation(setup);
        run_until(&mut sim, 1.0);
        let p = particles(&mut sim)[0];
        assert!(p.velocity.norm() < 1e-9 && p.spin.norm() < 1e-7, "{case}: {p:?}");
    });
}

/// A spinning top slows down by (5/2) μ_w p/r and comes to rest; the spring then holds it.
#[test]
fn twisting_stops_a_spinning_top() {
    all(0.3, |mut setup, press, case| {
        each(&mut setup, |c| c.twisting_resistance = Some(0.02));
        setup.particles[0].spin = Vec3::new(0.0, 0.0, 20.0);
        let mut sim = simulation(setup);
        let slows = 2.5 * 0.02 * press / 0.01;
        run_until(&mut sim, 0.5 * 20.0 / slows);
        let p = particles(&mut sim)[0];
        let expected = 20.0 - slows * sim.time();
        assert!((p.spin.z / expected - 1.0).abs() < 5e-3, "{case}: {} rad/s instead of {expected}", p.spin.z);
        run_until(&mut sim, 2.0 * 20.0 / slows);
        assert!(particles(&mut sim)[0].spin.norm() < 1e-6, "{case}: at rest");
    });
}

/// Friction that weakens: the slip s of a thrown ball obeys ṡ = −7/2 μ(s) g, integrated here by itself.
#[test]
fn weakening_friction() {
    let (at_rest, dynamic, speed) = (0.6, 0.1, 0.3);
    all(at_rest, |mut setup, press, case| {
        each(&mut setup, |c| c.weakening = Some(Weakening { dynamic, speed }));
        setup.particles[0].velocity.x = 1.0;
        let mut sim = simulation(setup);
        let rate = |s: f64| -3.5 * press * (dynamic + (at_rest - dynamic) / (1.0 + s * s / (speed * speed)));
        let mut slip = 1.0;
        run_until(&mut sim, 0.4 / (3.5 * 0.2 * press));
        let h = sim.time() / 1e4;
        for _ in 0..10_000 {
            let middle = slip + 0.5 * h * rate(slip);
            slip += h * rate(middle);
        }
        let p = particles(&mut sim)[0];
        let got = p.velocity.x - 0.01 * p.spin.y;
        assert!(slip > 0.05 && (got - slip).abs() < 3e-3, "{case}: {got} m/s instead of {slip}");
    });
}

/// An oblique collision with everything that rubs keeps momentum to rounding and angular momentum to O(Δt²).
#[test]
fn oblique_collision_conserves_momentum_and_angular_momentum() {
    for normal in NORMALS {
        for model in [RollingModel::Spring, RollingModel::Constant] {
            let mut setup = normal.setup(0.6);
            each(&mut setup, |c| {
                (c.sliding_friction, c.rolling_resistance, c.rolling_model) = (Some(0.4), Some(0.1), model);
                c.twisting_resistance = Some(0.05);
                c.weakening = Some(Weakening { dynamic: 0.2, speed: 0.1 });
            });
            let at = |x, y, z| grainpipe_tests::setups::grain(1, Vec3::new(x, y, z));
            let (mut a, mut b) = (at(0.009, 0.004, -0.001), at(-0.009, -0.002, 0.002));
            (a.radius, a.velocity, a.spin) = (0.007, Vec3::new(-0.3, 0.05, 0.1), Vec3::new(10.0, -5.0, 3.0));
            (b.id, b.velocity, b.spin) = (2, Vec3::new(0.2, 0.0, 0.02), Vec3::new(0.0, 7.0, -20.0));
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
            run_until(&mut sim, 0.05);
            let now = particles(&mut sim);
            assert!((now[0].spin - start[0].spin).norm() > 0.1, "they have touched");
            let after = totals(&now);
            let (p, l) = ((after.0 - before.0).norm(), (after.1 - before.1).norm());
            assert!(p < 1e-14 * before.0.norm().max(1e-3), "{}: {p:e}", normal.name);
            assert!(l < 1e-6 * before.1.norm(), "{}: {l:e} of {:e}", normal.name, before.1.norm());
        }
    }
}
