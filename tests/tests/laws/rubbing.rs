//! Sliding, rolling and twisting with every normal law, on a plane and on wall spheres.

use crate::impacts::totals;
use crate::simulation;
use dem::Setup;
use dem::setup::*;
use geom::{Moments, Vec3};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::normals::{NORMALS, SURFACES, name_of, precisions};
use grainpipe_tests::setups::{
    LAWS, Law, empty, grain, particles, plane, rolling, run_until, weaken, with_friction,
};
use nalgebra::UnitQuaternion;

const PART: &str = "Friction and rolling";
const SLIDES: Case = case(PART, "thrown ball slides: v = v₀ − μ p t (p = g; with adhesion (F_n + 2 F_po)/m)");
const ROLLS: Case = case(PART, "a thrown ball rolls after 2 v₀/7 μ p at 5/7 v₀, for all μ");
const ROLLS_DOWN: Case = case(PART, "a ball that does not slip rolls down a slope: 5/7 g sin θ");
const SLIDES_DOWN: Case = case(PART, "ball on tan θ > 7/2 μ slides: g (sin θ − μ cos θ)");
const SLOWS: Case = case(PART, "rolling resistance: −v̇ = 5/7 μ_r p, both models");
const HOLDS: Case =
    case(PART, "rolling resistance (spring): a ball stays on a slope of 0.9 μ_r p/g, and rolls on 1.1");
const STAYS: Case =
    case(PART, "rolling resistance (constant): a ball stays on a slope of 0.9 μ_r p/g, and rolls on 1.1");
const RESTS: Case = case(PART, "rolling resistance (constant): comes to rest on level ground");
const TWISTS: Case = case(PART, "twisting resistance: −ω̇ = 5/2 μ_w p/r");
const WEAKENS: Case = case(PART, "speed-dependent friction: slip s of ṡ = −7/2 μ(s) p");
const MOMENTUM: Case =
    case(PART, "collision with all friction effects: Σ m v is conserved, relative to its value before");
const SPIN: Case = case(
    PART,
    "collision with all friction effects: Σ x × m v + I ω is conserved, relative to its value before",
);
const BLOCK_STAYS: Case = case(PART, "block on a slope of 0.9 μ stays where it came to rest");
const BLOCK_SLIDES: Case = case(PART, "block on a slope of 1.1 μ slides: g (sin θ − μ cos θ)");

/// Every normal law in every precision on every surface: a grain at rest, and what friction is capped by over its mass [m/s²].
fn all(friction: f64, test: impl Fn(Setup, f64, &str)) {
    for (normal, precision) in precisions() {
        for surface in SURFACES {
            let (mut setup, press) = normal.resting(0.5, surface);
            setup.precision = precision;
            setup.contacts.iter_mut().for_each(|c| c.set("sliding_friction", friction));
            test(setup, press, &format!("{} on {surface:?}", name_of(&normal, precision)));
        }
    }
}

/// The same for effects that exist in double precision only.
fn all_double(friction: f64, test: impl Fn(Setup, f64, &str)) {
    all(friction, |setup, press, case| {
        if setup.precision == Precision::Double {
            test(setup, press, case);
        }
    });
}

fn each(setup: &mut Setup, change: impl Fn(&mut ContactLaw)) {
    setup.contacts.iter_mut().for_each(change);
}

/// Turns gravity, not the surface.
fn tilt(setup: &mut Setup, theta: f64) {
    setup.gravity = Vec3::new(9.81 * theta.sin(), 0.0, -9.81 * theta.cos());
}

/// Slides until 2v₀/7μp, then rolls at 5/7 v₀, whatever μ is.
#[test]
fn thrown_ball() {
    for mu in [0.1, 0.3, 0.8] {
        all(mu, |mut setup, press, case| {
            setup.particles[0].velocity.x = 1.0;
            let mut sim = simulation(setup);
            let rolls = 2.0 / (7.0 * mu * press);
            run_until(&mut sim, 0.5 * rolls);
            let p = particles(&mut sim)[0];
            let on = format!("{case}, μ = {mu}");
            SLIDES.within(&on, p.velocity.x - (1.0 - mu * press * sim.time()), "m/s of 1", 2e-3);
            run_until(&mut sim, 1.5 * rolls);
            let p = particles(&mut sim)[0];
            // It rolls on r − δ.
            ROLLS.within(&on, p.velocity.x - 5.0 / 7.0, "m/s of 5/7", 4e-3);
            ROLLS.within(&format!("{on}, slip"), p.spin.y * 0.01 - p.velocity.x, "m/s of 5/7", 6e-3);
        });
    }
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
        ROLLS_DOWN.equals(case, v, "m/s", expected, 5e-3);
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
        SLIDES_DOWN.equals(case, v, "m/s", expected, 5e-3);
    });
}

/// Both models of rolling resistance slow a rolling ball down by (5/7) μ_r p.
#[test]
fn rolling_ball_slows_down() {
    for model in ["spring", "constant"] {
        let offered = |s: &Setup| model == "spring" || s.precision == Precision::Double;
        all(0.6, |mut setup, press, case| {
            if !offered(&setup) {
                return;
            }
            each(&mut setup, |c| rolling(c, 0.1, model));
            (setup.particles[0].velocity.x, setup.particles[0].spin.y) = (0.5, 50.0);
            let mut sim = simulation(setup);
            run_until(&mut sim, 0.2);
            let v = particles(&mut sim)[0].velocity.x;
            let expected = 0.5 - 5.0 / 7.0 * 0.1 * press * sim.time();
            SLOWS.within(&format!("{case}, {model:?}"), v - expected, "m/s of 0.5", 3e-3);
        });
    }
}

/// Both models hold a ball on a slope below arctan μ_r and not above; the constant couple lets it come to rest on level ground without jitter.
#[test]
fn slopes_and_rest_with_rolling_resistance() {
    all(0.6, |base, press, case| {
        for (share, stays) in [(0.9, true), (1.1, false)] {
            let mut setup = base.clone();
            each(&mut setup, |c| c.set("rolling_resistance", 0.1));
            // Pressed by more than its weight, it holds on steeper slopes.
            tilt(&mut setup, (share * 0.1 * press / 9.81).atan());
            let mut sim = simulation(setup);
            run_until(&mut sim, 0.5);
            let p = particles(&mut sim)[0];
            // Hertz is softest at first touch: the spring may give a little before it holds.
            if stays {
                HOLDS.within(&format!("{case}, way"), p.position.x, "m", 1e-3);
                HOLDS.within(&format!("{case}, speed"), p.velocity.norm(), "m/s", 1e-3);
            } else {
                assert!(p.velocity.x > 1e-3, "{case} {share}: {p:?}");
            }
        }
        if base.precision != Precision::Double {
            return;
        }
        for share in [0.9, 1.1] {
            let mut setup = base.clone();
            each(&mut setup, |c| rolling(c, 0.1, "constant"));
            tilt(&mut setup, (share * 0.1 * press / 9.81).atan());
            let mut sim = simulation(setup);
            let mut at = |time: f64| {
                run_until(&mut sim, time);
                particles(&mut sim)[0].position.x
            };
            let way = -at(0.3) + at(0.5);
            if share < 1.0 {
                STAYS.within(case, way, "m in 0.2 s", 1e-9);
            } else {
                assert!(way > 1e-4, "{case}: rolls {way} m");
            }
        }
        let mut setup = base.clone();
        each(&mut setup, |c| rolling(c, 0.1, "constant"));
        (setup.particles[0].velocity.x, setup.particles[0].spin.y) = (0.05, 5.0);
        let mut sim = simulation(setup);
        run_until(&mut sim, 1.0);
        let p = particles(&mut sim)[0];
        RESTS.within(case, p.velocity.norm().max(0.01 * p.spin.norm()), "m/s", 1e-9);
    });
}

/// A spinning top slows down by (5/2) μ_w p/r and comes to rest; the spring then holds it.
#[test]
fn twisting_stops_a_spinning_top() {
    all_double(0.3, |mut setup, press, case| {
        each(&mut setup, |c| c.set("twisting_resistance", 0.02));
        setup.particles[0].spin = Vec3::new(0.0, 0.0, 20.0);
        let mut sim = simulation(setup);
        let slows = 2.5 * 0.02 * press / 0.01;
        run_until(&mut sim, 0.5 * 20.0 / slows);
        let p = particles(&mut sim)[0];
        let expected = 20.0 - slows * sim.time();
        TWISTS.equals(case, p.spin.z, "rad/s", expected, 5e-3);
        run_until(&mut sim, 2.0 * 20.0 / slows);
        assert!(particles(&mut sim)[0].spin.norm() < 1e-6, "{case}: at rest");
    });
}

/// Friction that weakens: the slip s of a thrown ball obeys ṡ = −7/2 μ(s) g, integrated here by itself.
#[test]
fn weakening_friction() {
    let (at_rest, dynamic, speed) = (0.6, 0.1, 0.3);
    all_double(at_rest, |mut setup, press, case| {
        each(&mut setup, |c| weaken(c, [at_rest, dynamic, speed]));
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
        assert!(slip > 0.05);
        WEAKENS.within(case, got - slip, "m/s of 1", 3e-3);
    });
}

/// An oblique collision with everything that rubs keeps momentum to rounding and angular momentum to O(Δt²).
#[test]
fn oblique_collision_conserves_momentum_and_angular_momentum() {
    for normal in NORMALS {
        for model in ["spring", "constant"] {
            let mut setup = normal.setup(0.6);
            each(&mut setup, |c| {
                c.set("sliding_friction", 0.4);
                rolling(c, 0.1, model);
                c.set("twisting_resistance", 0.05);
                weaken(c, [0.4, 0.2, 0.1]);
            });
            let at = |x, y, z| grain(1, Vec3::new(x, y, z));
            let (mut a, mut b) = (at(0.009, 0.004, -0.001), at(-0.009, -0.002, 0.002));
            (a.radius, a.velocity, a.spin) = (0.007, Vec3::new(-0.3, 0.05, 0.1), Vec3::new(10.0, -5.0, 3.0));
            (b.id, b.velocity, b.spin) = (2, Vec3::new(0.2, 0.0, 0.02), Vec3::new(0.0, 7.0, -20.0));
            setup.particles = vec![a, b];
            let start = setup.particles.clone();
            let before = totals(&start);
            let mut sim = simulation(setup);
            run_until(&mut sim, 0.05);
            let now = particles(&mut sim);
            assert!((now[0].spin - start[0].spin).norm() > 0.1, "they have touched");
            let after = totals(&now);
            let on = format!("{}, {model:?}", normal.name);
            MOMENTUM.within(&on, (after.0 - before.0).norm() / before.0.norm(), "–", 1e-14);
            SPIN.within(&on, (after.1 - before.1).norm() / before.1.norm(), "–", 1e-11);
        }
    }
}

/// A cube of 20 mm with a sphere of 3 mm at every corner, on a slope.
fn block(law: Law, mu: f64, tangent: f64) -> dem::Simulation {
    let theta = tangent.atan();
    let mut setup = with_friction(empty(law, 0.3), mu);
    setup.gravity = Vec3::new(9.81 * theta.sin(), 0.0, -9.81 * theta.cos());
    setup.walls = vec![plane(Vec3::z())];
    setup.step = Step::Auto(0.3);
    let side = |bit: usize, k: usize| if k >> bit & 1 == 1 { 0.01 } else { -0.01 };
    let spheres: Vec<_> = (0..8).map(|k| (Vec3::new(side(0, k), side(1, k), side(2, k)), 0.003)).collect();
    let shape = ClumpShape::new("cube", 0, &spheres, &Moments::of_sum(&spheres));
    let one = Body {
        id: 0,
        shape: 0,
        scale: 1.0,
        position: Vec3::new(0.0, 0.0, 0.013),
        orientation: UnitQuaternion::identity(),
        velocity: Vec3::zeros(),
        spin: Vec3::zeros(),
    };
    setup.clumps = Clumps { shapes: vec![shape], placed: vec![one], entries: vec![] };
    simulation(setup)
}

/// What cannot roll rests below arctan μ and slides above.
#[test]
fn block_on_a_slope() {
    for (law, name) in LAWS.into_iter().zip(["hooke", "hertz"]) {
        for mu in [0.2, 0.6] {
            let on = format!("{name}, μ = {mu}");
            let mut sim = block(law, mu, 0.9 * mu);
            run_until(&mut sim, 1.0);
            let rested = sim.clumps().expect("sound")[0];
            run_until(&mut sim, 2.0);
            let b = sim.clumps().expect("sound")[0];
            BLOCK_STAYS.within(&on, (b.position - rested.position).norm(), "m in 1 s", 1e-9);
            let mut sim = block(law, mu, 1.1 * mu);
            run_until(&mut sim, 0.5);
            let theta = f64::atan(1.1 * mu);
            let expected = 9.81 * (theta.sin() - mu * theta.cos()) * sim.time();
            let v = sim.clumps().expect("sound")[0].velocity.x;
            BLOCK_SLIDES.equals(&on, v, "m/s", expected, 2e-2);
        }
    }
}
