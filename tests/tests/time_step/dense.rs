//! Walls of spheres that lie deep within each other: many push one grain the same way at once.

use dem::setup::*;
use dem::{Setup, Simulation, critical_step, mass};
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{Law, empty, grain, with_friction};

const MADE: Case = case(
    "Time step",
    "a grain thrown at wall spheres a twentieth of their radius apart: energy created by the default step, over that of the throw",
);
const NAMED: Case = case("Time step", "the limiting pair names how many wall spheres push at once");

const R: f64 = 0.01;
const SPEED: f64 = 4.0;

/// A grain above a floor of 51 × 51 spheres of its size, so far apart.
fn floor(spacing: f64) -> Setup {
    let mut setup = with_friction(empty(Law::Hooke { stiffness: 2e4, tangential_ratio: None }, 0.5), 0.3);
    let at = |k: i32| spacing * f64::from(k - 25);
    let spheres = (0..51 * 51).map(|k| (Vec3::new(at(k % 51), at(k / 51), -R), R)).collect();
    let shape = WallShape::Spheres(spheres);
    setup.walls = vec![Wall::new("floor", 1, shape)];
    let velocity = Vec3::new(0.0, 0.0, -SPEED);
    setup.particles = vec![Particle { velocity, ..grain(0, Vec3::new(1e-4, 2e-4, 1.02 * R)) }];
    setup.step = Step::Auto(0.5);
    setup.ledger = true;
    setup
}

#[test]
fn dense_walls_make_no_energy() {
    let thrown = 0.5 * mass(R, 2500.0) * SPEED * SPEED;
    let mut sim = Simulation::new(floor(0.05 * R)).expect("sound");
    let mut most = 0.0f64;
    while sim.time() < 0.005 {
        sim.step().expect("within the guards");
        most = most.max(sim.energy().expect("sound").integration);
    }
    MADE.within("hooke, e = 0.5, friction 0.3", most / thrown, "–", 0.01);
}

/// Each sphere by itself: at an ordinary spacing it is one, and the step that of a single one.
#[test]
fn only_dense_walls_of_single_contacts_shorten_the_step() {
    let plain = |spacing: f64| Setup { patches: false, ..floor(spacing) };
    let [single, ordinary, dense] =
        [10.0 * R, R, 0.05 * R].map(|spacing| critical_step(&plain(spacing)).expect("laws for all pairs"));
    assert_eq!(single, ordinary);
    let cause = single.cause.to_string();
    assert!(!cause.contains("as stiff as"), "{cause}");
    assert!(dense.dt < 0.2 * single.dt, "{} of {}", dense.dt, single.dt);
    let shared = critical_step(&floor(0.05 * R)).expect("laws for all pairs");
    assert_eq!(shared, critical_step(&floor(R)).expect("laws for all pairs"), "as one contact they do not");
    NAMED.refused(
        "a twentieth of a radius",
        &dense.cause.to_string(),
        &["wall 'floor'", "times as stiff as one of its spheres"],
    );
}
