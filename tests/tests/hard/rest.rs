//! Rest under gravity: nothing creeps, nothing heats, on any wall, near and far from the origin.

use crate::variants::{Variant, farthest, fastest, run, simulation, variants};
use dem::Simulation;
use dem::setup::*;
use geom::{Plane, Vec3, mesh::TriMesh};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{bond, grain, lattice, particles, plane};

const SPEED: Case = case("Rest and extremes", "a heap at rest: speeds fall to rounding and stay there");
const SPIN: Case = case("Rest and extremes", "a heap at rest: spins fall to rounding and stay there");
const CREEP: Case = case("Rest and extremes", "a heap at rest does not creep");
const MIXED: Case = case(
    "Rest and extremes",
    "a heap at rest in mixed precision creeps by the rounding of its springs in single precision",
);
const FAR: Case = case(
    "Rest and extremes",
    "a heap at rest 1000 km away: no grain moves by the last digit of its position in a step",
);
const FAR_CREEP: Case = case("Rest and extremes", "a heap at rest 1000 km away does not creep");

const BLOCK: Case =
    case("Rest and extremes", "a bonded block at rest: speeds fall to rounding and stay there");
const BLOCK_CREEP: Case = case("Rest and extremes", "a bonded block at rest does not creep");

/// Last digit of a place 1000 km away [m].
const DIGIT: f64 = 1.2e-10;

/// What the heap stands on.
#[derive(Debug, Clone, Copy)]
enum Floor {
    Plane,
    Mesh,
    Spheres,
}

const FLOORS: [Floor; 3] = [Floor::Plane, Floor::Mesh, Floor::Spheres];

impl Floor {
    fn wall(self, at: Vec3) -> Wall {
        let mut wall = plane(Vec3::z());
        wall.shape = match self {
            Floor::Plane => WallShape::Plane(Plane { point: at, normal: Vec3::z() }),
            Floor::Mesh => {
                let corner = |x: f64, y: f64| at + Vec3::new(x, y, 0.0);
                let vertices =
                    vec![corner(-0.5, -0.6), corner(0.5, -0.6), corner(0.5, 0.4), corner(-0.5, 0.4)];
                WallShape::Mesh(TriMesh { vertices, faces: vec![[0, 1, 2], [0, 2, 3]] })
            }
            Floor::Spheres => {
                let place = |k: i32| {
                    let (row, column) = (f64::from(k / 13 - 6), f64::from(k % 13 - 6));
                    at + Vec3::new(0.01 * (column + 0.5 * row), 0.01 * 0.75f64.sqrt() * row, -0.008)
                };
                WallShape::Spheres((0..169).map(|k| (place(k), 0.008)).collect())
            }
        };
        wall
    }
}

/// Three grains carry a fourth, held by friction and rolling resistance alone.
fn heap(variant: &Variant, floor: Floor, at: Vec3) -> Simulation {
    let mut setup = variant.rough(0.3, 0.6);
    setup.gravity.z = -9.81;
    setup.step = Step::Auto(0.9);
    setup.walls = vec![floor.wall(at)];
    setup.particles = (0..3)
        .map(|k| {
            let (sin, cos) = (2.0 * std::f64::consts::FRAC_PI_3 * f64::from(k)).sin_cos();
            grain(k as u32, at + Vec3::new(0.0115 * cos, 0.0115 * sin, 0.0101))
        })
        .collect();
    setup.particles.push(grain(3, at + Vec3::new(0.0, 0.0, 0.0265)));
    simulation(setup)
}

/// Rests for so many steps, after it has come to rest.
fn rests(variant: &Variant, floor: Floor, steps: u64) {
    for far in [0.0, 1e6] {
        let mut sim = heap(variant, floor, Vec3::repeat(far));
        run(&mut sim, 45_000);
        let early = particles(&mut sim);
        run(&mut sim, steps);
        let late = particles(&mut sim);
        let ((speed, spin), way) = (fastest(&late), farthest(&early, &late));
        let on = format!("{} on {floor:?}, {steps} steps", variant.name());
        if far > 0.0 {
            FAR.within(&on, speed, "m/s", DIGIT / sim.dt());
            FAR_CREEP.within(&on, way, "m", if variant.mixed() { 1e-7 } else { 0.0 });
        } else if variant.mixed() {
            MIXED.within(&on, way / steps as f64, "m a step", 5e-12);
        } else {
            SPEED.within(&on, speed, "m/s", 1e-12);
            SPIN.within(&on, spin, "rad/s", 1e-11);
            CREEP.within(&on, way, "m", 1e-13);
        }
        let base = late[..3].iter().map(|p| p.position.z - far).fold(f64::INFINITY, f64::min);
        assert!(late[3].position.z - far > base + 0.005, "{on}: the heap stands");
    }
}

#[test]
fn a_heap_at_rest_neither_creeps_nor_heats() {
    for variant in variants() {
        FLOORS.iter().for_each(|&floor| rests(&variant, floor, 20_000));
    }
}

#[test]
#[ignore = "long: 10 000 000 steps for each law and floor, run by make -C pipelines soak"]
fn a_heap_at_rest_over_ten_million_steps() {
    for variant in variants() {
        FLOORS.iter().for_each(|&floor| rests(&variant, floor, 10_000_000));
    }
}

/// A bonded block that was set down on its edge stands.
#[test]
fn a_bonded_block_at_rest_neither_creeps_nor_heats() {
    for variant in variants() {
        let mut setup = variant.rough(0.3, 0.6);
        setup.gravity.z = -9.81;
        setup.step = Step::Auto(0.9);
        setup.walls = vec![plane(Vec3::z())];
        setup.bonds = vec![Bond { damping: 0.5, ..bond((0, 0)) }];
        setup.particles = lattice([3, 2, 3], Vec3::new(0.0, 0.0, 0.032));
        let mut sim = simulation(setup);
        run(&mut sim, 45_000);
        let early = particles(&mut sim);
        run(&mut sim, 20_000);
        let late = particles(&mut sim);
        let (on, way) = (variant.name(), farthest(&early, &late));
        if variant.mixed() {
            MIXED.within(&format!("bonded block, {on}"), way / 20_000.0, "m a step", 5e-12);
        } else {
            BLOCK.within(&on, fastest(&late).0, "m/s", 1e-12);
            BLOCK_CREEP.within(&on, way, "m", 1e-13);
        }
        assert_eq!(sim.bond_count(), [33, 0], "{on}");
    }
}
