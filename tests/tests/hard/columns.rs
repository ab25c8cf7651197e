//! A column of 200 spheres, and tall silos.

use crate::variants::{Variant, simulation, variants};
use dem::Simulation;
use dem::mass;
use dem::setup::*;
use geom::{Plane, Vec3};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{grain, plane, run_until, with_friction};

const COLUMN: Case =
    case("Rest and extremes", "a column of 200 spheres: each contact bears the weight above it");
const JANSSEN: Case = case(
    "Rest and extremes",
    "a tall silo: the force on the base over the filled weight follows Janssen's curve",
);
const SATURATES: Case =
    case("Rest and extremes", "a tall silo: share of the last fill that the base carries");

const COUNT: u32 = 200;

fn column(variant: &Variant) -> Simulation {
    let mut setup = with_friction(variant.smooth(0.3), 0.5);
    for c in &mut setup.contacts {
        c.set("stiffness", c.number("stiffness").map(|_| 1e5));
    }
    setup.gravity.z = -9.81;
    setup.step = Step::Auto(0.9);
    setup.walls = vec![plane(Vec3::z())];
    setup.particles = (0..COUNT).map(|k| grain(k, Vec3::new(0.0, 0.0, 0.01 + 0.02 * f64::from(k)))).collect();
    // A fluid takes the slowest swing of the column, which its contacts hardly damp, in seconds: about twice its frequency.
    let zero = Vec3::zeros();
    setup.drag =
        Some(Drag { law: DragLaw::Stokes, viscosity: 1.3, density: 0.0, velocity: zero, buoyancy: false });
    simulation(setup)
}

fn bears_what_is_above(variants: impl Iterator<Item = Variant>) {
    for variant in variants {
        let mut sim = column(&variant);
        run_until(&mut sim, 3.0);
        let weight = mass(0.01, 2500.0) * 9.81;
        let mut worst: f64 = 0.0;
        for c in sim.record_contacts().expect("fine") {
            let above = if c.wall { COUNT } else { COUNT - c.i.max(c.j) };
            worst = worst.max((c.force.norm() / (f64::from(above) * weight) - 1.0).abs());
        }
        let limit = if variant.mixed() { 1e-5 } else { 1e-9 };
        COLUMN.within(&variant.name(), worst, "of the weight above", limit);
    }
}

#[test]
fn each_contact_of_a_column_bears_what_is_above() {
    bears_what_is_above(variants().into_iter().filter(|v| v.normal.cohesion.is_none() && !v.mixed()));
}

#[test]
fn each_contact_of_a_column_with_cohesion_or_in_mixed_precision_bears_what_is_above() {
    bears_what_is_above(variants().into_iter().filter(|v| v.normal.cohesion.is_some() || v.mixed()));
}

const WIDTH: f64 = 0.1;

/// A silo with square section, filled with so many layers of 25 grains; its base sinks a little, so that walls hold what they can.
fn silo(variant: &Variant, layers: u32) -> (f64, f64) {
    let mut setup = with_friction(variant.smooth(0.3), 0.5);
    setup.contacts.iter_mut().for_each(|c| c.set("rolling_resistance", 0.1));
    setup.gravity.z = -9.81;
    setup.step = Step::Auto(0.8);
    let place = |k: u32| {
        let off = |n: u32| 4e-4 * (f64::from(k * n % 11) - 5.0) / 5.0;
        let at = |n: u32| 0.02 * f64::from(n) + 0.01;
        let radius = [0.0095, 0.0085, 0.009][(k * 5 % 7) as usize % 3];
        let p = Vec3::new(at(k % 5) + off(3), at(k / 5 % 5) + off(7), 0.0102 + 0.0192 * f64::from(k / 25));
        Particle { radius, ..grain(k, p) }
    };
    setup.particles = (0..25 * layers).map(place).collect();
    let side = |point: Vec3, n: Vec3| {
        let mut wall = plane(n);
        wall.shape = WallShape::Plane(Plane { point, normal: n });
        wall
    };
    let far = Vec3::repeat(WIDTH);
    let zero = Vec3::zeros();
    setup.walls = vec![plane(Vec3::z())];
    setup.walls.extend([
        side(zero, Vec3::x()),
        side(far, -Vec3::x()),
        side(zero, Vec3::y()),
        side(far, -Vec3::y()),
    ]);
    setup.walls[0].motion = Motion { velocity: Vec3::new(0.0, 0.0, -0.005), from: 0.3, ..Motion::still() };
    let weight = setup.particles.iter().map(|p| mass(p.radius, 2500.0) * 9.81).sum();
    let mut sim = simulation(setup);
    run_until(&mut sim, 0.45);
    let (mut sum, mut count) = (0.0, 0);
    for _ in 0..60 {
        let next = sim.time() + 2e-3;
        run_until(&mut sim, next);
        sum -= sim.wall_forces().expect("fine")[0].force.z;
        count += 1;
    }
    (weight, sum / f64::from(count))
}

/// Janssen (1895): F = F∞ (1 − e^(−W/F∞)) on the base under a weight W, with one number F∞ = w A/(K μ U): w weight of a metre of
/// fill, A and U area and circumference, K lateral over vertical stress.
fn bears_by_its_walls(variant: &Variant) {
    let name = &variant.name();
    let points: Vec<(f64, f64)> = [2, 5, 10, 16, 24].map(|layers| silo(variant, layers)).to_vec();
    let off = |most: f64| -> f64 {
        points.iter().map(|(w, f)| (f - most * (1.0 - (-w / most).exp())).powi(2)).sum()
    };
    let tried = (1..4000).map(|k| 0.01 * f64::from(k));
    let most = tried.min_by(|a, b| off(*a).total_cmp(&off(*b))).expect("some");
    JANSSEN.curve(name, "weight filled in [N]", "force on the base [N]", &points);
    JANSSEN.within(name, (off(most) / points.len() as f64).sqrt() / most, "of the largest force", 0.06);
    let [.., (w, f), (heaviest, largest)] = points[..] else { return };
    SATURATES.within(name, (largest - f) / (heaviest - w), "of its weight", 0.3);
    let lateral = heaviest / (24.0 * 0.0192) * WIDTH * WIDTH / (0.5 * 4.0 * WIDTH * most);
    assert!((0.15..0.7).contains(&lateral), "{name}: K = {lateral}");
}

fn silos(wanted: impl Fn(&Variant) -> bool, holds: impl Fn(&Variant)) {
    variants().iter().filter(|v| wanted(v)).for_each(holds);
}

#[test]
fn a_tall_silo_bears_by_its_walls() {
    silos(|v| !v.adheres() && !v.mixed(), bears_by_its_walls);
}

#[test]
fn a_tall_silo_bears_by_its_walls_in_mixed_precision() {
    silos(|v| v.mixed(), bears_by_its_walls);
}

/// Janssen's curve is that of grains that do not adhere; what saturates it, friction at the walls, is there with adhesion, too.
#[test]
fn a_tall_silo_of_grains_that_adhere_saturates() {
    silos(Variant::adheres, |variant| {
        let [(w, f), (heaviest, largest)] = [16, 24].map(|layers| silo(variant, layers));
        SATURATES.within(&variant.name(), (largest - f) / (heaviest - w), "of its weight", 0.3);
    });
}
