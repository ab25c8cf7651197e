//! A loaded contact that is turned as one with its partners: what it remembers turns with it, and no work is done.
//!
//! A grain in a cage of four wall spheres of one wall A (above, below) and one wall B (left, right), which squeeze it. A starts to
//! turn about the grain's centre a little before B: the grain is held between two turning walls that are at an angle to each
//! other, and all four tangential springs are loaded, two this way and two that way, so that no force and no couple is left.

use crate::variants::{Variant, run, simulation, variants};
use dem::Simulation;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{bond, grain, lattice, particles};
use std::f64::consts::PI;

const TURNS: Case = case(
    "Rest and extremes",
    "a loaded grain in rigid rotation with its partners: the tangential force is constant, change in 1000 turns",
);
const WORK: Case =
    case("Rest and extremes", "a loaded grain in rigid rotation with its partners: no work in 1000 turns");
const MIXED: Case = case(
    "Rest and extremes",
    "a loaded grain in rigid rotation, in mixed precision: the tangential force loses the last digit of single precision per step",
);
const ANY: Case = case(
    "Rest and extremes",
    "a loaded grain in rigid rotation about any axis: the tangential force is constant",
);

const SQUEEZE: f64 = 5e-5;

const BOND: Case =
    case("Rest and extremes", "a bonded rod in rigid rotation: the forces in its bonds are constant");
const BOND_SINGLE: Case = case(
    "Rest and extremes",
    "a bonded rod in rigid rotation, in single precision: the forces in its bonds change by the last digit of a sum",
);
const SPIN_SINGLE: Case = case(
    "Rest and extremes",
    "a bonded rod in rigid rotation, in single precision: its kinetic energy is constant",
);
const SPIN: Case =
    case("Rest and extremes", "a bonded rod in rigid rotation: its kinetic energy is constant");

/// The cage turns about `axis` [rad/s], wall B a little later than wall A, so that it is loaded.
fn cage(variant: &Variant, axis: Vec3, lag: f64) -> Simulation {
    // So rough that nothing slides while it is loaded, by a wall that starts at once at 25 m/s: then its springs hold the load.
    let mut setup = variant.rough(0.3, 1000.0);
    for c in &mut setup.contacts {
        c.set("rolling_resistance", None);
        c.set("twisting_resistance", None);
    }
    setup.step = Step::Auto(0.5);
    setup.ledger = true;
    setup.particles = vec![Particle { spin: axis, ..grain(1, Vec3::zeros()) }];
    let wall = |name: &str, way: Vec3, from: f64| Wall {
        motion: Motion { turn: axis, from, ..Motion::still() },
        ..Wall::new(
            name,
            1,
            WallShape::Spheres([-1.0, 1.0].map(|s| (way * (s * (0.02 - SQUEEZE)), 0.01)).to_vec()),
        )
    };
    setup.walls = vec![wall("a", Vec3::x(), 0.0), wall("b", Vec3::y(), lag)];
    simulation(setup)
}

/// Mean tangential force [N].
fn tangential(sim: &mut Simulation) -> f64 {
    let all = sim.record_contacts().expect("within the guards");
    assert_eq!(all.len(), 4, "all four hold");
    let of = |c: &dem::ContactRecord| (c.force - c.normal * c.force.dot(&c.normal)).norm();
    all.iter().map(of).sum::<f64>() / 4.0
}

/// Change of the tangential force as a share of it, work of the walls over what is in the springs, and steps, in so many turns.
fn turned(variant: &Variant, axis: Vec3, rate: f64, turns: f64) -> (f64, f64, u64) {
    let turn = 2.0 * PI / rate;
    let dt = cage(variant, axis * rate, 0.0).dt();
    // At least a step later; a hundred steps for the load to come to rest.
    let mut sim = cage(variant, axis * rate, (2e-3 / rate).max(1.01 * dt));
    run(&mut sim, 3000);
    let (first, before) = (tangential(&mut sim), sim.energy().expect("fine"));
    let (until, begun) = (sim.time() + turns * turn, sim.steps());
    while sim.time() < until {
        sim.step().expect("within the guards");
    }
    let after = sim.energy().expect("fine");
    assert!(first > 0.01, "{}: loaded by {first} N", variant.name());
    let (change, work) = (tangential(&mut sim) / first - 1.0, (after.walls - before.walls) / before.elastic);
    (change, work, sim.steps() - begun)
}

/// About the axis of the cage, at some angle a step.
fn turns_with_it(variants: &[Variant], turns: f64, rate: f64) {
    for variant in variants {
        let (change, work, steps) = turned(variant, Vec3::z(), rate, turns);
        let on = format!("{}, {rate} rad/s", variant.name());
        if variant.mixed() {
            MIXED.within(&on, change / steps as f64, "of the force a step", 1.2e-7);
            continue;
        }
        TURNS.within(&on, change * 1000.0 / turns, "of the force", 1e-8);
        WORK.within(&on, work * 1000.0 / turns, "of the energy in springs", 1e-7);
    }
}

#[test]
fn a_loaded_grain_turns_with_its_partners() {
    let all = variants();
    turns_with_it(&all, 3.0, 20.0);
    turns_with_it(&all, 30.0, 200.0);
    turns_with_it(&all, 200.0, 2500.0);
}

#[test]
#[ignore = "long: a million turns for each law, run by make -C pipelines soak"]
fn a_loaded_grain_turns_a_million_times_with_its_partners() {
    std::thread::scope(|scope| {
        for variant in variants().into_iter().filter(|v| !v.mixed()) {
            scope.spawn(move || turns_with_it(&[variant], 1e6, 2500.0));
        }
    });
}

#[test]
fn a_loaded_grain_turns_with_its_partners_about_any_axis() {
    for variant in variants() {
        let (change, _, steps) = turned(&variant, Vec3::new(1.0, 1.0, 1.0).normalize(), 20.0, 3.0);
        if variant.mixed() {
            MIXED.within(&variant.name(), change / steps as f64, "of the force a step", 1.2e-7);
            continue;
        }
        ANY.within(&variant.name(), change, "of the force", 1e-6);
    }
}

/// A rod of three grains that turns: drawn out by its own weight, and by nothing else, however often it has turned.
fn rod_turns(variant: &Variant, axis: Vec3, turns: f64) {
    let mut setup = variant.rough(0.5, 0.5);
    setup.bonds = vec![Bond { damping: 0.5, ..bond((0, 0)) }];
    setup.step = Step::Auto(0.5);
    setup.particles = lattice([3, 1, 1], Vec3::zeros());
    let spin = axis * 20.0;
    setup.particles.iter_mut().for_each(|p| (p.spin, p.velocity) = (spin, spin.cross(&p.position)));
    let mut sim = simulation(setup);
    // Until it has been drawn out.
    run(&mut sim, 10_000);
    let stress =
        |sim: &mut Simulation| sim.bonds().expect("fine").iter().map(|b| b.stress).collect::<Vec<_>>();
    let motion = |sim: &mut Simulation| {
        particles(sim).iter().map(|p| p.velocity.norm_squared() + p.spin.norm_squared() * 1e-4).sum::<f64>()
    };
    let (first, before) = (stress(&mut sim), motion(&mut sim));
    let until = sim.time() + turns * 2.0 * PI / 20.0;
    while sim.time() < until {
        sim.step().expect("within the guards");
    }
    let pairs = first.into_iter().zip(stress(&mut sim));
    let change = pairs.map(|(a, b)| (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) / a[0]).fold(0.0, f64::max);
    let on = format!("{}, about {:.1} {:.1} {:.1}, {turns} turns", variant.name(), axis.x, axis.y, axis.z);
    // Where sums of loads are kept in single precision, their last digit.
    let single = variant.precision == Precision::Single;
    let (bears, moves) = if single { (BOND_SINGLE, SPIN_SINGLE) } else { (BOND, SPIN) };
    bears.within(&on, change, "of the stress", if single { 1.2e-7 } else { 1e-8 });
    moves.within(&on, motion(&mut sim) / before - 1.0, "of it", if single { 1e-8 } else { 1e-9 });
}

#[test]
fn a_bonded_rod_turns_as_one() {
    for variant in variants() {
        rod_turns(&variant, Vec3::z(), 10.0);
    }
    rod_turns(&variants()[0], Vec3::new(0.0, 1.0, 1.0).normalize(), 100.0);
}
