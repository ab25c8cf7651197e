//! Impacts that begin anywhere in a step, with contacts averaged over the part of a kick in which they act.

use crate::simulation;
use dem::critical_step;
use dem::setup::*;
use geom::mesh::TriMesh;
use geom::{Plane, Vec3};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{HOOKE, LAWS, Law, empty, grain, particles};

const PART: &str = "One contact";
const PHASES: Case =
    case(PART, "averaged contacts, default step: worst error of restitution over all phases of the step");
const ORDER: Case = case(PART, "averaged contacts: worst error of restitution over all phases of the step");
const ALONE: Case = case(PART, "averaged contacts: the skin of the lists changes nothing");

/// Impacts side by side.
const COUNT: u32 = 40;
/// Distance between two of them [m].
const APART: f64 = 0.1;
/// Speed of approach [m/s].
const SPEED: f64 = 2.0;

/// What the grains meet.
#[derive(Debug, Clone, Copy, PartialEq)]
enum On {
    /// Another of this size over theirs.
    Grain(f64),
    Plane,
    WallSpheres,
    Mesh,
}

impl On {
    fn wall(self) -> Option<Wall> {
        let at = |k: u32| Vec3::new(APART * f64::from(k), 0.0, 0.0);
        let shape = match self {
            On::Grain(_) => return None,
            On::Plane => WallShape::Plane(Plane { point: Vec3::zeros(), normal: Vec3::z() }),
            On::WallSpheres => {
                WallShape::Spheres((0..COUNT).map(|k| (at(k) - 0.008 * Vec3::z(), 0.008)).collect())
            }
            On::Mesh => {
                let (low, high) = (-1.0, APART * f64::from(COUNT) + 1.0);
                let corners = [(low, -1.0), (high, -1.0), (high, 1.0), (low, 1.0)];
                let corners = corners.map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec();
                WallShape::Mesh(TriMesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).expect("sound"))
            }
        };
        Some(Wall::new("wall", 1, shape))
    }

    /// Grains that meet it after three steps and some part of a fourth, each another part.
    fn particles(self, dt: f64) -> Vec<Particle> {
        let mut all = Vec::new();
        for k in 0..COUNT {
            let gap = SPEED * dt * (3.0 + f64::from(k) / f64::from(COUNT));
            let mut a = grain(k, Vec3::new(APART * f64::from(k), 0.003, 0.01 + gap));
            a.velocity.z = -SPEED;
            if let On::Grain(size) = self {
                let radius = 0.01 * size;
                let mut b = Particle { radius, ..grain(1000 + k, a.position) };
                b.position.z = -radius;
                (a.position.y, b.position.y) = (0.0, 0.0);
                // In the frame of their centre of mass.
                let heavy = size.powi(3);
                (a.velocity.z, b.velocity.z) = (-SPEED * heavy / (1.0 + heavy), SPEED / (1.0 + heavy));
                all.push(b);
            }
            if self == On::WallSpheres {
                a.position.y = 0.0;
            }
            all.push(a);
        }
        all
    }
}

fn setup(law: Law, e: f64, on: On, share: f64) -> Setup {
    let mut setup = empty(law, e);
    setup.sampling = Sampling::Averaged;
    setup.walls = on.wall().into_iter().collect();
    setup.particles = on.particles(0.0);
    let dt = share * critical_step(&setup).expect("contacts").dt;
    setup.step = Step::Fixed(dt);
    setup.particles = on.particles(dt);
    setup
}

/// Largest error of the restitution.
fn worst(setup: Setup, e: f64) -> f64 {
    let mut sim = simulation(setup);
    for _ in 0..2000 {
        sim.step().expect("within the guards");
        let parted = |p: &Particle| p.velocity.z > 0.0 && p.position.z > 0.02;
        if sim.steps().is_multiple_of(50) && particles(&mut sim)[..COUNT as usize].iter().all(parted) {
            break;
        }
    }
    let all = particles(&mut sim);
    let (first, others) = all.split_at(COUNT as usize);
    let speed = |k: usize| first[k].velocity.z - others.get(k).map_or(0.0, |p| p.velocity.z);
    (0..COUNT as usize).map(|k| (speed(k) / (SPEED * e) - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn restitution_is_within_a_hundredth_at_every_phase_of_the_default_step() {
    for (law, name) in LAWS.into_iter().zip(["hooke", "hertz"]) {
        for on in [On::Grain(1.0), On::Grain(0.05), On::Plane, On::WallSpheres, On::Mesh] {
            for e in [0.3, 0.5, 0.9] {
                let error = worst(setup(law, e, on, 0.5), e);
                PHASES.within(&format!("{name}, {on:?}, e = {e}"), error, "–", 0.01);
            }
        }
    }
}

#[test]
fn its_error_falls_with_the_square_of_the_step() {
    for e in [0.5, 0.9, 1.0] {
        let points = [0.5, 0.35, 0.25, 0.18, 0.125].map(|share| {
            let setup = setup(HOOKE, e, On::Grain(1.0), share);
            (share, worst(setup, e))
        });
        ORDER.order(&format!("hooke, e = {e}"), &points, 2.0, 0.2);
    }
    for e in [0.3, 0.5, 0.9] {
        for share in [0.5, 0.25, 0.1] {
            let error = worst(setup(Law::Hertz, e, On::Grain(1.0), share), e);
            ORDER.within(&format!("hertz, e = {e}, safety {share}"), error, "–", 2e-3);
        }
    }
}

/// Contacts act before surfaces meet: lists must hold them by then, also where the skin is less than half a step's way.
#[test]
fn grains_faster_than_the_skin_meet_in_time() {
    for on in [On::Grain(1.0), On::Plane, On::WallSpheres, On::Mesh] {
        let after = |skin: Option<f64>| {
            let mut sim = simulation(Setup { skin, ..setup(HOOKE, 0.5, on, 0.5) });
            (0..200).for_each(|_| sim.step().expect("within the guards"));
            particles(&mut sim)
        };
        let (wide, narrow) = (after(Some(2e-3)), after(Some(1e-9)));
        let off = wide.iter().zip(&narrow).map(|(a, b)| (a.velocity - b.velocity).norm());
        ALONE.within(&format!("{on:?}"), off.fold(0.0, f64::max), "m/s", 1e-9);
    }
}
