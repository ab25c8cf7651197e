//! Many grains: discharge through an orifice, and a gas that cools.

use crate::simulation;
use dem::setup::*;
use dem::{Setup, Simulation};
use geom::{Vec3, mesh::TriMesh};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{Law, empty, grain, particles, run_until, with_friction};
use std::f64::consts::PI;

const BEVERLOO: Case =
    case("Many grains", "discharge through an orifice ∝ (D − 1.4 d)^(5/2) (Beverloo): exponent − 2.5");
const COOLING: Case =
    case("Many grains", "granular gas: E = E₀ (1 + t/τ)⁻², 1/τ = (1 − e²) ν/6 (Haff, Enskog)");

/// Numbers in 0 … 1, the same on every machine.
struct Dice(u64);

impl Dice {
    fn throw(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn vector(&mut self) -> Vec3 {
        Vec3::new(self.throw() - 0.5, self.throw() - 0.5, self.throw() - 0.5)
    }
}

const D: f64 = 0.02;
const SIDE: f64 = 9.0 * D;

/// A floor with a round hole [m], between a circle and the sides of the box.
fn floor(hole: f64) -> Wall {
    let n = 48u32;
    let rim = |k: u32| {
        let (sin, cos) = (2.0 * PI * (f64::from(k) + 0.5) / f64::from(n)).sin_cos();
        let inner = Vec3::new(cos, sin, 0.0) * (0.5 * hole);
        let outer = Vec3::new(cos, sin, 0.0) * (0.5 * SIDE / cos.abs().max(sin.abs()));
        [inner, outer]
    };
    let mut vertices: Vec<Vec3> = (0..n).flat_map(rim).collect();
    // A segment that passes a corner gets the corner, too.
    let mut faces = Vec::new();
    for k in 0..n {
        let (a, b) = (2 * k, 2 * ((k + 1) % n));
        faces.extend([[a, a + 1, b], [b, a + 1, b + 1]]);
        let (p, q) = (vertices[a as usize + 1], vertices[b as usize + 1]);
        if (p.x.abs() - p.y.abs()) * (q.x.abs() - q.y.abs()) < -1e-12 {
            let corner = Vec3::new(p.x.signum(), p.y.signum(), 0.0) * (0.5 * SIDE);
            faces.push([a + 1, vertices.len() as u32, b + 1]);
            vertices.push(corner);
        }
    }
    let shape = WallShape::Mesh(TriMesh { vertices, faces });
    Wall::new("floor", 1, shape)
}

/// A silo, periodic across, whose floor is open from the start.
fn silo(hole: f64, seed: u64) -> Setup {
    let weight = dem::mass(0.5 * D, 2500.0) * 9.81;
    // Ten grains on each other overlap by a hundredth of a diameter.
    let law = Law::Hooke { stiffness: 1000.0 * weight / D, tangential_ratio: None };
    let mut setup = with_friction(empty(law, 0.3), 0.5);
    setup.gravity.z = -9.81;
    setup.step = Step::Auto(0.8);
    setup.periodic = [Some((-0.5 * SIDE, 0.5 * SIDE)), Some((-0.5 * SIDE, 0.5 * SIDE)), None];
    setup.walls = vec![floor(hole)];
    // The bed comes down all at once.
    setup.guards.overlap = 0.5;
    let mut dice = Dice(seed);
    let across = 8u32;
    let cell = SIDE / f64::from(across);
    for k in 0..across * across * 16 {
        let at = |k: u32| (f64::from(k) + 0.5) * cell - 0.5 * SIDE;
        let (x, y, z) =
            (at(k % across), at(k / across % across), D * (0.6 + 1.08 * f64::from(k / across / across)));
        let radius = 0.5 * D * (0.95 + 0.1 * dice.throw());
        let place = Vec3::new(x, y, z) + dice.vector() * (0.05 * D);
        setup.particles.push(Particle { radius, ..grain(k, place) });
    }
    setup
}

/// Grains a second, between two times after the bed has come down.
fn rate(hole: f64, seed: u64) -> f64 {
    let mut sim = simulation(silo(hole, seed));
    let unit = (D / 9.81).sqrt();
    let out = |sim: &mut Simulation| particles(sim).iter().filter(|p| p.position.z < 0.0).count() as f64;
    run_until(&mut sim, 4.0 * unit);
    let (from, before) = (sim.time(), out(&mut sim));
    run_until(&mut sim, 14.0 * unit);
    (out(&mut sim) - before) / (sim.time() - from)
}

/// Beds that are poured differently.
const BEDS: [u64; 3] = [7, 19, 31];

/// The slope of ln W over ln (D − 1.4 d). Narrower orifices arch now and then, and one bed of so few grains is chance.
#[test]
fn orifice_discharges_as_beverloo_says() {
    let mean = |hole: f64| BEDS.map(|seed| rate(hole, seed)).iter().sum::<f64>() / BEDS.len() as f64;
    let points = [4.5, 5.5, 6.5].map(|holes| (holes, mean(holes * D).powf(0.4)));
    let n = points.len() as f64;
    let logs = points.map(|(d, w)| ((d - 1.4).ln(), 2.5 * w.ln()));
    let (mx, my) = (logs.iter().map(|p| p.0).sum::<f64>() / n, logs.iter().map(|p| p.1).sum::<f64>() / n);
    let exponent = logs.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum::<f64>()
        / logs.iter().map(|p| (p.0 - mx).powi(2)).sum::<f64>();
    BEVERLOO.within("three beds of 1 024 grains, D = 4.5 … 6.5 d", exponent - 2.5, "–", 0.25);
    BEVERLOO.curve("found", "D/d [–]", "W^(2/5) [s^(-2/5)]", &points);
}

/// Smooth grains in a periodic box: the frequency of collisions from their number and speed (Enskog, Carnahan & Starling), no fit.
#[test]
fn granular_gas_cools_as_haff_says() {
    let (count, r, e, phi) = (1000u32, 0.01, 0.8f64, 0.05f64);
    let side = (f64::from(count) * 4.0 / 3.0 * PI * r * r * r / phi).cbrt();
    let m = dem::mass(r, 2500.0);
    let mut setup = empty(Law::Hooke { stiffness: 2e4, tangential_ratio: None }, e);
    setup.step = Step::Auto(0.7);
    setup.periodic = [Some((0.0, side)); 3];
    let mut dice = Dice(3);
    let cell = side / 10.0;
    for k in 0..count {
        let at = |k: u32| (f64::from(k % 10) + 0.5) * cell;
        // Twelve throws make a Maxwellian.
        let velocity = (0..12).map(|_| dice.vector()).fold(Vec3::zeros(), |a, b| a + b) * 0.1;
        setup.particles.push(Particle { velocity, ..grain(k, Vec3::new(at(k), at(k / 10), at(k / 100))) });
    }
    let mean: Vec3 = setup.particles.iter().map(|p| p.velocity).sum::<Vec3>() / f64::from(count);
    setup.particles.iter_mut().for_each(|p| p.velocity -= mean);
    let mut sim = simulation(setup);
    let temperature = |sim: &mut Simulation| {
        particles(sim).iter().map(|p| m * p.velocity.norm_squared()).sum::<f64>() / (3.0 * f64::from(count))
    };
    let chi = (1.0 - 0.5 * phi) / (1.0 - phi).powi(3);
    let density = f64::from(count) / side.powi(3);
    let frequency = |t: f64| 4.0 * density * 4.0 * r * r * chi * (PI * t / m).sqrt();
    // First some collisions that mix the lattice.
    let first = 2.0 / frequency(temperature(&mut sim));
    run_until(&mut sim, first);
    let start = temperature(&mut sim);
    let tau = 6.0 / ((1.0 - e * e) * frequency(start));
    let (mut points, mut theory) = (vec![], vec![]);
    for k in 1..=8 {
        let after = 0.25 * f64::from(k) * tau;
        run_until(&mut sim, first + after);
        let expected = start / (1.0 + after / tau).powi(2);
        let now = temperature(&mut sim);
        // 1000 grains: an eighth of the collisions a grain has had fluctuates by some per cent.
        COOLING.equals(
            &format!("t = {} τ", 0.25 * f64::from(k)),
            now / start,
            "of E₀",
            expected / start,
            0.1,
        );
        points.push((after / tau, now / start));
        theory.push((after / tau, expected / start));
    }
    COOLING.curve("found", "t/τ [–]", "E/E₀ [–]", &points);
    COOLING.curve("(1 + t/τ)⁻²", "t/τ [–]", "E/E₀ [–]", &theory);
}
