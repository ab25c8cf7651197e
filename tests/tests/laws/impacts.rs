//! One contact, head on.

use crate::simulation;
use dem::setup::*;
use dem::{Simulation, mass};
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{HOOKE, LAWS, Law, empty, grain, particles, plane, run_until, with_friction};
use std::f64::consts::PI;

const PART: &str = "One contact";
const FLIGHT: Case = case(PART, "free flight: z₀ + v t − g t²/2");
const RESTITUTION: Case = case(PART, "restitution: −v′/v = e as asked, e = 0.1 … 1, 0.01 … 10 m/s");
const DEEPEST: Case = case(PART, "Hertz: δ_max = (15 m* v²/16 √R* E*)^0.4");
const STRONGEST: Case = case(PART, "Hertz: F_max = 4/3 E* √R* δ_max^1.5");
const LASTS: Case = case(PART, "Hertz: contact lasts 2.87 (m*²/R* E*² v)^0.2");
const CONTACT_TIME: Case = case(PART, "linear law: t_c = π/√(k/m* − (c/2m*)²)");
const MOMENTUM: Case = case(PART, "oblique collision: Σ m v is conserved, relative to its value before");
const SPIN: Case =
    case(PART, "oblique collision: Σ x × m v + I ω is conserved, relative to its value before");
const BOUNCE: Case = case(PART, "bounce heights: h_k = (h₀ − r) e^2k + r");
const FRAME: Case = case(PART, "a collision is the same in a moving frame");

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
    FLIGHT.within("10 000 steps, place", (p.position - there).norm(), "m", 1e-11);
    FLIGHT.within(
        "10 000 steps, speed",
        (p.velocity - Vec3::new(1.0, -2.0, 3.0 - 9.81 * t)).norm(),
        "m/s",
        1e-11,
    );
}

/// Rebound at e times the speed of approach, for both normal laws without adhesion (with it: adhesion.rs), pair and plane;
/// tests 1 to 3 of Chung & Ooi (2011), Granular Matter 13, doi:10.1007/s10035-011-0277-0.
#[test]
fn restitution_as_asked() {
    for (law, name) in LAWS.into_iter().zip(["hooke", "hertz"]) {
        for e in [0.1, 0.3, 0.5, 0.7, 0.9, 1.0] {
            for speed in [0.01, 0.3, 10.0] {
                for (wall, on) in [(false, "pair"), (true, "plane")] {
                    let got = rebound(law, e, speed, wall);
                    RESTITUTION.within(&format!("{name}, {on}, e = {e}, {speed} m/s"), got - e, "–", 1e-3);
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

/// A pair or a grain and a rigid plane of test 1 and 2 of Chung & Ooi: elastic constants, radius [m], speed of approach [m/s].
pub struct Impact {
    pub name: &'static str,
    material: (f64, f64, f64),
    radius: f64,
    pub speed: f64,
    pub plane: bool,
}

pub const IMPACTS: [Impact; 4] = [
    Impact { name: "glass, pair", material: (4.8e10, 0.20, 2800.0), radius: 0.01, speed: 20.0, plane: false },
    Impact {
        name: "limestone, pair",
        material: (2e10, 0.25, 2500.0),
        radius: 0.01,
        speed: 20.0,
        plane: false,
    },
    Impact {
        name: "aluminium, rigid plane",
        material: (7e10, 0.30, 2699.0),
        radius: 0.1,
        speed: 0.2,
        plane: true,
    },
    Impact {
        name: "magnesium, rigid plane",
        material: (4e10, 0.35, 1800.0),
        radius: 0.1,
        speed: 0.2,
        plane: true,
    },
];

impl Impact {
    /// E* [Pa], R* [m], m* [kg].
    pub fn reduced(&self) -> (f64, f64, f64) {
        let (young, poisson, density) = self.material;
        let share = if self.plane { 1.0 } else { 0.5 };
        let modulus = young / (1.0 - poisson * poisson) * share;
        (modulus, share * self.radius, share * mass(self.radius, density))
    }

    /// One or two grains about to touch, without loss but by the law.
    pub fn setup(&self, law: Law) -> dem::Setup {
        let mut setup = empty(law, 1.0);
        let (young, poisson, density) = self.material;
        setup.materials[0] = Material { name: "stone".to_owned(), density, young, poisson };
        setup.materials[1].young = 1e30;
        setup.step = Step::Auto(0.005);
        let r = self.radius;
        let sides: &[(u32, f64)] = if self.plane { &[(1, 1.0)] } else { &[(1, 1.0), (2, -1.0)] };
        for &(id, side) in sides {
            let mut p = Particle { radius: r, ..grain(id, Vec3::new(side * r * 1.000_001, 0.0, 0.0)) };
            p.velocity.x = -side * self.speed / sides.len() as f64;
            setup.particles.push(p);
        }
        if self.plane {
            setup.walls = vec![plane(Vec3::x())];
        }
        setup
    }
}

/// δ_max, F_max and duration of a Hertzian impact, against the closed formulas.
#[test]
fn hertz_impact() {
    for impact in &IMPACTS {
        let ((modulus, r, m), v) = (impact.reduced(), impact.speed);
        let overlap = (15.0 * m * v * v / (16.0 * r.sqrt() * modulus)).powf(0.4);
        let force = 4.0 / 3.0 * modulus * r.sqrt() * overlap.powf(1.5);
        // 2.868: 2 ∫ dx/√(1 − x^2.5) (15/16)^0.4.
        let duration = 2.868_265 * (m * m / (r * modulus * modulus * v)).powf(0.2);
        let mut sim = simulation(impact.setup(Law::Hertz));
        let (mut deepest, mut strongest, mut inside, mut before) = (0.0f64, 0.0f64, 0.0, None);
        while sim.time() < 1.3 * duration {
            sim.step().expect("within the guards");
            let p = particles(&mut sim);
            let delta = match impact.plane {
                true => impact.radius - p[0].position.x,
                false => 2.0 * impact.radius - (p[0].position - p[1].position).norm(),
            };
            deepest = deepest.max(delta);
            let now = p[0].velocity.x;
            let push =
                before.map_or(0.0, |b: f64| (now - b) / sim.dt() * mass(impact.radius, impact.material.2));
            strongest = strongest.max(push);
            before = Some(now);
            inside += if delta > 0.0 { sim.dt() } else { 0.0 };
        }
        DEEPEST.equals(impact.name, deepest, "m", overlap, 1e-4);
        STRONGEST.equals(impact.name, strongest, "N", force, 1e-3);
        LASTS.equals(impact.name, inside, "s", duration, 1e-3);
    }
}

/// The values that Chung & Ooi print for test 1.
#[test]
fn hertz_formulas_give_the_printed_values() {
    for (modulus, m, printed) in [
        (4.8e10 / (1.0 - 0.04) / 2.0, 0.5 * mass(0.01, 2800.0), (10_697.0, 274.1e-6, 40.4e-6)),
        (2e10 / (1.0 - 0.0625) / 2.0, 0.5 * mass(0.01, 2500.0), (7_108.0, 368.3e-6, 54.2e-6)),
    ] {
        let overlap = (15.0 * m * 400.0 / (16.0 * 0.005f64.sqrt() * modulus)).powf(0.4);
        let force = 4.0 / 3.0 * modulus * 0.005f64.sqrt() * overlap.powf(1.5);
        let duration = 2.868_265 * (m * m / (0.005 * modulus * modulus * 20.0)).powf(0.2);
        assert!((overlap / printed.1 - 1.0).abs() < 1e-3, "{overlap}");
        assert!((force / printed.0 - 1.0).abs() < 1e-3, "{force}");
        assert!((duration / printed.2 - 1.0).abs() < 2e-3, "{duration}");
    }
}

/// t_c = π/√(k/m* − (c/2m*)²) of the linear law.
#[test]
fn hooke_contact_time() {
    for e in [0.2f64, 0.6, 1.0] {
        let mut setup = empty(HOOKE, e);
        setup.step = Step::Auto(0.002);
        for (id, side) in [(1, 1.0), (2, -1.0)] {
            let mut p = grain(id, Vec3::new(side * 0.010_001, 0.0, 0.0));
            p.velocity.x = -side * 0.1;
            setup.particles.push(p);
        }
        let reduced = 0.5 * mass(0.01, 2500.0);
        let ln = e.ln();
        let gamma = -2.0 * ln / (PI * PI + ln * ln).sqrt();
        let expected = PI / (1e4 / reduced * (1.0 - gamma * gamma / 4.0)).sqrt();
        let mut sim = simulation(setup);
        let mut inside = 0.0;
        while sim.time() < 3.0 * expected {
            sim.step().expect("within the guards");
            let p = particles(&mut sim);
            inside += if (p[0].position - p[1].position).norm() < 0.02 { sim.dt() } else { 0.0 };
        }
        CONTACT_TIME.equals(&format!("pair, e = {e}"), inside, "s", expected, 2e-3);
    }
}

/// Momentum and angular momentum of an oblique collision with friction, to rounding.
#[test]
fn two_body_collision_conserves_momentum_and_angular_momentum() {
    for (law, name) in LAWS.into_iter().zip(["hooke", "hertz"]) {
        let mut setup = with_friction(empty(law, 0.6), 0.4);
        let mut a = grain(1, Vec3::new(0.011, 0.004, -0.001));
        let mut b = grain(2, Vec3::new(-0.011, -0.002, 0.002));
        (a.radius, a.velocity, a.spin) = (0.007, Vec3::new(-0.3, 0.05, 0.1), Vec3::new(10.0, -5.0, 3.0));
        (b.velocity, b.spin) = (Vec3::new(0.2, 0.0, 0.02), Vec3::new(0.0, 7.0, -20.0));
        setup.particles = vec![a, b];
        let start = setup.particles.clone();
        let before = totals(&start);
        let mut sim = simulation(setup);
        run_until(&mut sim, 0.1);
        let now = particles(&mut sim);
        assert!((now[0].spin - start[0].spin).norm() > 0.1, "they have touched");
        let after = totals(&now);
        MOMENTUM.within(name, (after.0 - before.0).norm() / before.0.norm(), "–", 1e-14);
        SPIN.within(name, (after.1 - before.1).norm() / before.1.norm(), "–", 1e-11);
    }
}

/// Σ m v, Σ x × m v + I ω.
pub fn totals(ps: &[Particle]) -> (Vec3, Vec3) {
    let mut sum = (Vec3::zeros(), Vec3::zeros());
    for p in ps {
        let m = mass(p.radius, 2500.0);
        sum.0 += m * p.velocity;
        sum.1 += m * p.position.cross(&p.velocity) + 0.4 * m * p.radius * p.radius * p.spin;
    }
    sum
}

/// Steps until the grain has turned round and come to the top of its flight: its height [m].
fn next_top(sim: &mut Simulation) -> f64 {
    // Looked at every 64 steps, a fraction of an impact.
    let mut rises = |up: bool| {
        while (particles(sim)[0].velocity.z > 0.0) != up {
            (0..64).for_each(|_| sim.step().expect("within the guards"));
        }
    };
    rises(true);
    rises(false);
    particles(sim)[0].position.z
}

fn dropped(law: Law, e: f64) -> dem::Setup {
    let mut setup = empty(law, e);
    setup.materials.iter_mut().for_each(|m| m.young = 5e10);
    setup.gravity.z = -9.81;
    // An error of first order in each bounce.
    setup.step = Step::Auto(0.02);
    setup.walls = vec![plane(Vec3::z())];
    setup.particles = vec![grain(1, Vec3::new(0.0, 0.0, 0.09))];
    setup
}

/// Rebound heights h_k = (h₀ − r) e^{2k} + r, for contacts so short that gravity does nothing in them.
#[test]
fn bouncing_ball() {
    let stiff = Law::Hooke { stiffness: 1e7, tangential_ratio: None };
    for (law, name) in [(stiff, "hooke"), (Law::Hertz, "hertz")] {
        for e in [0.8f64] {
            let mut sim = simulation(dropped(law, e));
            for k in 1..4 {
                let expected = 0.08 * e.powi(2 * k);
                let on = format!("{name}, e = {e}, bounce {k}");
                BOUNCE.equals(&on, next_top(&mut sim) - 0.01, "m", expected, 5e-3);
            }
        }
    }
}

/// A collision looks the same from a frame that moves: also while the pair is sorted again and again, and its two partners
/// change places in the list.
#[test]
fn galilean_invariance() {
    for (law, name) in
        [(Law::Hooke { stiffness: 100.0, tangential_ratio: None }, "hooke"), (Law::Hertz, "hertz")]
    {
        let ((still, few), (moving, many)) = (seen_at(law, 0.0), seen_at(law, 7.0));
        assert!(many > 10 * few, "{many} listings against {few}");
        let off = still
            .iter()
            .flatten()
            .zip(moving.iter().flatten())
            .map(|(a, b)| (a - b).norm() / (1.0 + a.norm()));
        FRAME.within(name, off.fold(0.0, f64::max), "–", 1e-9);
    }
}

/// What a frame at some speed sees of a collision, and how often it was listed.
fn seen_at(law: Law, speed: f64) -> (Vec<[Vec3; 3]>, u64) {
    let mut setup = with_friction(empty(law, 0.7), 0.4);
    setup.materials.iter_mut().for_each(|m| m.young = 1e4);
    setup.contacts.iter_mut().for_each(|c| c.set("rolling_resistance", 0.2));
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
    (seen, sim.rebuilds())
}
