//! 1000 km from the origin: the trajectory is that at the origin, to what the digits of a place there allow.

use crate::variants::{Variant, run, simulation, variants};
use dem::Simulation;
use dem::setup::*;
use geom::{Plane, Vec3, mesh::TriMesh};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{grain, particles, plane};
use scene::advice::explain_setup_error;

const PLACE: Case = case(
    "Rest and extremes",
    "1000 km from the origin: grains bounce, slide and roll to the same place as at the origin",
);
const SPEED: Case = case(
    "Rest and extremes",
    "1000 km from the origin: grains bounce, slide and roll at the same speed as at the origin",
);

const REFUSED: Case = case(
    "Rest and extremes",
    "so far from the origin that a position is coarser than a millionth of the radius: refused, naming the grain or the wall",
);

const DISTANCE: f64 = 1e6;
/// Steps of 10⁻⁵ s: it falls, bounces, slides.
const STEPS: u64 = 6000;

/// A spinning grain thrown obliquely at a wall, and two that meet off their centres.
fn thrown(variant: &Variant, surface: WallShape, at: Vec3) -> Vec<Particle> {
    let mut setup = variant.rough(0.6, 0.4);
    setup.gravity.z = -9.81;
    setup.step = Step::Fixed(1e-5);
    let mut wall = plane(Vec3::z());
    wall.shape = surface;
    setup.walls = vec![wall];
    let one = |id, x: f64, y: f64, z: f64, v: [f64; 3]| Particle {
        velocity: Vec3::from(v),
        spin: Vec3::new(3.0, -20.0, 7.0),
        ..grain(id, at + Vec3::new(x, y, z))
    };
    setup.particles = vec![
        one(1, 0.0, 0.0, 0.0125, [0.5, 0.1, -0.2]),
        one(2, 0.1, 0.0, 0.0135, [0.3, 0.0, 0.0]),
        one(3, 0.125, 0.007, 0.014, [-0.3, 0.0, 0.0]),
    ];
    let mut sim = simulation(setup);
    run(&mut sim, STEPS);
    particles(&mut sim)
}

fn surfaces(at: Vec3) -> [(&'static str, WallShape); 3] {
    let corner = |x: f64, y: f64| at + Vec3::new(x, y, 0.0);
    let vertices = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    [
        ("plane", WallShape::Plane(Plane { point: at, normal: Vec3::z() })),
        ("mesh", WallShape::Mesh(TriMesh { vertices, faces: vec![[0, 1, 2], [0, 2, 3]] })),
        ("wall sphere", WallShape::Spheres(vec![(at - Vec3::new(-0.05, 0.0, 0.5), 0.5)])),
    ]
}

#[test]
fn a_trajectory_far_from_the_origin_is_that_at_the_origin() {
    for variant in variants() {
        let far = Vec3::new(DISTANCE, -DISTANCE, DISTANCE);
        let pairs = surfaces(Vec3::zeros()).into_iter().zip(surfaces(far));
        for ((name, near), (_, away)) in pairs {
            let (a, b) = (thrown(&variant, near, Vec3::zeros()), thrown(&variant, away, far));
            let (mut place, mut speed): (f64, f64) = (0.0, 0.0);
            for (a, b) in a.iter().zip(&b) {
                place = place.max((b.position - far - a.position).norm());
                speed = speed.max((a.velocity - b.velocity).norm());
            }
            let on = format!("{}, {name}", variant.name());
            // What is lost of each place in each step, all to one side: half a digit.
            PLACE.within(&on, place, "m", STEPS as f64 * 0.6e-10 * 3f64.sqrt());
            // A digit in a step, and what an overlap that is off by a digit makes of an impact.
            SPEED.within(&on, speed, "m/s", 1e-4);
        }
    }
}

/// 45 000 km for a grain of 10 mm; as far as doubles go.
#[test]
fn too_far_is_refused() {
    for variant in variants() {
        for far in [5e7, -1e12, 1e300, 1.7e308] {
            let mut setup = variant.smooth(0.5);
            setup.particles = vec![grain(41, Vec3::zeros()), grain(42, Vec3::new(0.1, far, -far))];
            let said = explain_setup_error(&Simulation::new(setup.clone()).err().expect("refused"));
            REFUSED.refused(
                &format!("{}, {far:e} m", variant.name()),
                &said,
                &["particle 42", "1.0000e-2 m", "shift"],
            );
            setup.particles.pop();
            let spheres = vec![(Vec3::new(0.0, 0.1, 0.0), 0.01), (Vec3::new(-far, far, 0.0), 0.01)];
            setup.walls = vec![Wall { shape: WallShape::Spheres(spheres), ..plane(Vec3::z()) }];
            let said = explain_setup_error(&Simulation::new(setup).err().expect("refused"));
            REFUSED.refused(
                &format!("{}, wall, {far:e} m", variant.name()),
                &said,
                &["wall 'plane'", "1.0000e-2 m", "shift"],
            );
        }
        let mut setup = variant.smooth(0.5);
        setup.particles = vec![grain(41, Vec3::repeat(4e7)), grain(42, Vec3::repeat(-4e7))];
        assert!(Simulation::new(setup).is_ok(), "{}: 40 000 km", variant.name());
    }
}
