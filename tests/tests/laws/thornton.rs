//! A face-centred cubic array between walls: the lid compresses it at a constant rate, two sides hold their force by servos.
//!
//! ```text
//! n × n spheres in layers A, (n − 1) × (n − 1) in layers B between them, m interfaces; rotation locked by a large rolling resistance
//! F_z = 4 (n − 1)² f (cos θ + μ sin θ)       f: normal force of each contact, θ: its angle to the axis, t = tan θ
//! F_x = 2 m (n − 1) f (sin θ − μ cos θ)/√2
//! F_z/F_x = √2 (n − 1)/m · 2 (1 + μ t)/(t − μ)
//! ```
//!
//! Thornton (1979), Géotechnique 29(4), doi:10.1680/geot.1979.29.4.441: the stress ratio of the array as it deforms. Here forces on walls stand for the
//! stresses of his array, so that the number of contacts on each wall appears. θ follows from the height: m h = 2 R m cos θ, with h of the lid.

use crate::simulation;
use dem::setup::*;
use dem::{Setup, Simulation};
use geom::{Plane, Vec3};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{Law, empty, grain, run_until, with_friction};

const RATIO: Case = case(
    "Many grains",
    "FCC array between servos, sheared at a rate: F_z/F_x = √2 (n − 1)/m · 2 (1 + μ t)/(t − μ)",
);
const HELD: Case =
    case("Many grains", "FCC array between servos, sheared at a rate: force on the sides, in each frame");
const CELL_RATIO: Case = case(
    "Many grains",
    "FCC array in a periodic cell, sheared at a rate: σ_z/σ_x over 2 (1 + μ t)/(t (t − μ))",
);
const CELL_HELD: Case = case(
    "Many grains",
    "FCC array in a periodic cell, sheared at a rate: stress along the other axes, in each frame",
);
const R: f64 = 0.01;
const N: u32 = 4;
const INTERFACES: u32 = 6;
const MU: f64 = 0.3;
/// When the lid begins to move [s].
const SHEAR: f64 = 0.01;
/// Force of each side [N].
const SIDE: f64 = 20.0;

fn array(rate: f64) -> Setup {
    let law = Law::Hooke { stiffness: 1e6, tangential_ratio: None };
    let mut setup = with_friction(empty(law, 0.1), MU);
    setup.contacts[1].remove("sliding_friction");
    setup.contacts[0].set("rolling_resistance", 10.0);
    setup.step = Step::Auto(0.5);
    let side = 2.0 * R * (1.0 + 1e-6);
    let layer = (4.0 * R * R - 0.5 * side * side).sqrt();
    for z in 0..=INTERFACES {
        let (shift, n) = if z % 2 == 0 { (0.0, N) } else { (0.5, N - 1) };
        for k in 0..n * n {
            let at = |k: u32| R + (f64::from(k) + shift) * side;
            let place = Vec3::new(at(k % n), at(k / n), R + layer * f64::from(z));
            setup.particles.push(grain(setup.particles.len() as u32, place));
        }
    }
    let wide = 2.0 * R + f64::from(N - 1) * side;
    let top = 2.0 * R + layer * f64::from(INTERFACES);
    let plane =
        |name: &str, point: Vec3, normal: Vec3| Wall::new(name, 1, WallShape::Plane(Plane { point, normal }));
    for axis in 0..3 {
        let (normal, high) = (Vec3::ith(axis, 1.0), Vec3::new(wide, wide, top));
        setup.walls.push(plane(["left", "front", "floor"][axis], Vec3::zeros(), normal));
        setup.walls.push(plane(["right", "back", "lid"][axis], high, -normal));
    }
    for (wall, direction) in [(1, -Vec3::x()), (3, -Vec3::y())] {
        setup.walls[wall].servo = Some(Servo::force(direction, SIDE, 0.5));
    }
    let (velocity, until) = (-Vec3::z() * (rate * top), SHEAR + 0.2 / rate);
    setup.walls[5].motion = Motion { velocity, from: SHEAR, until, ramp: 0.01 / rate, ..Motion::still() };
    setup
}

/// F_z/F_x of the walls, and what it is at the height of the lid.
fn ratio(sim: &mut Simulation) -> (f64, f64) {
    let walls = sim.wall_forces().expect("within the guards");
    let layer = (2.0 * R * R).sqrt();
    let cos = (layer + walls[5].shift.z / f64::from(INTERFACES)) / (2.0 * R);
    let t = (1.0 - cos * cos).sqrt() / cos;
    let expected = 2f64.sqrt() * f64::from(N - 1) / f64::from(INTERFACES) * 2.0 * (1.0 + MU * t) / (t - MU);
    (walls[5].force.z / walls[1].force.x, expected)
}

/// The same array without walls: 3 unit cells of height c and width a along each axis of a periodic cell, compressed along z, with a stress along x and y.
/// Contacts between layers alone bear it. F_z acts on a², F_x on a c, and a/c = t: σ_z/σ_x = 2 (1 + μ t)/(t (t − μ)).
fn cell(rate: f64) -> Setup {
    let mut setup = array(rate);
    setup.walls.clear();
    let edge = 2.0 * R * 2f64.sqrt() * (1.0 + 1e-6);
    let corner =
        |k: u32| [[0.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5]][k as usize % 4];
    let at = |k: u32, a: usize| f64::from([k / 4 % 3, k / 12 % 3, k / 36][a]) + corner(k)[a];
    let place = |k: u32| Vec3::new(at(k, 0), at(k, 1), at(k, 2)) * edge;
    setup.particles = (0..108).map(|k| grain(k, place(k))).collect();
    setup.periodic = [Some((0.0, 3.0 * edge)); 3];
    let side = || Some(Strain::Stress { target: Target::constant(2e4), rate_limit: 2.0 });
    let pushed = Target::new(vec![[0.0, 0.0], [SHEAR, 0.0], [SHEAR + 1.0, rate]]).expect("rows");
    setup.strain = [side(), side(), Some(Strain::Path(pushed))];
    setup
}

#[test]
fn array_in_a_periodic_cell_is_sheared_at_three_rates() {
    for rate in [0.25, 0.5, 1.0] {
        let mut sim = simulation(cell(rate));
        for frame in 0..10 {
            run_until(&mut sim, SHEAR + (0.03 + 0.001 * f64::from(frame)) / rate);
            let cell = sim.cell().expect("sound").expect("it is strained");
            let lengths = cell.range.map(|r| r.map_or(0.0, |(lo, hi)| hi - lo));
            let t = lengths[0] / lengths[2];
            let expected = 2.0 * (1.0 + MU * t) / (t * (t - MU));
            let stress = cell.stress.diagonal();
            CELL_RATIO.equals(&format!("{rate} /s"), stress.z / stress.x / expected, "–", 1.0, 3e-4);
            for axis in 0..2 {
                CELL_HELD.equals(&format!("{rate} /s"), stress[axis], "Pa", 2e4, 2e-3);
            }
        }
    }
}

/// What is left at rest is the overlap of the contacts; the rest is the inertia of the array, which grows with the square of the rate.
#[test]
fn array_is_sheared_between_servos_at_three_rates() {
    for rate in [0.25, 0.5, 1.0] {
        let mut sim = simulation(array(rate));
        let mut worst = 1.0;
        for frame in 0..10 {
            let strain = 0.035 + 0.001 * f64::from(frame);
            run_until(&mut sim, SHEAR + (strain + 0.005) / rate);
            let (found, expected) = ratio(&mut sim);
            worst =
                if (found / expected - 1.0).abs() > f64::abs(worst - 1.0) { found / expected } else { worst };
            let side = sim.wall_forces().expect("within the guards")[1].force.x;
            HELD.equals(&format!("{rate} /s"), side, "N", SIDE, 2e-3);
        }
        RATIO.equals(&format!("{rate} /s"), worst, "–", 1.0, 3e-4 + 5e-3 * rate * rate);
    }
}
