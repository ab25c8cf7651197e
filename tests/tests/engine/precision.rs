//! Mixed and single precision: the laws hold to single precision, at the origin and far from it, and its error is what is said of it.

use dem::setup::*;
use dem::{Setup, SetupError, Simulation};
use geom::{Vec3, mesh::TriMesh};
use grainpipe_tests::setups::{HOOKE, LAWS, Law, empty, grain, particles, plane, run_until, with_friction};

const NARROW: [Precision; 2] = [Precision::Mixed, Precision::Single];

fn simulation(setup: Setup, precision: Precision) -> Simulation {
    Simulation::new(Setup { precision, ..setup }).expect("sound")
}

/// Two grains that meet obliquely, far from the origin or at it.
fn impact(law: Law, at: Vec3) -> Setup {
    let mut setup = with_friction(empty(law, 0.7), 0.3);
    setup.contacts.iter_mut().for_each(|c| c.set("rolling_resistance", 0.1));
    let towards = Vec3::new(1.0, 0.3, -0.2);
    setup.particles = vec![
        Particle { velocity: towards, spin: Vec3::new(3.0, -5.0, 8.0), ..grain(0, at) },
        grain(1, at + Vec3::new(0.021, 0.004, 0.001)),
    ];
    setup
}

#[test]
fn an_impact_differs_by_no_more_than_single_precision() {
    for law in LAWS {
        for at in [Vec3::zeros(), Vec3::new(1e6, -1e6, 0.0)] {
            let end = |precision| {
                let mut sim = simulation(impact(law, at), precision);
                run_until(&mut sim, 0.02);
                particles(&mut sim)
            };
            let double = end(Precision::Double);
            for precision in NARROW {
                let narrow = end(precision);
                let momentum: Vec3 = narrow.iter().map(|p| p.velocity).sum();
                assert!(
                    (momentum - Vec3::new(1.0, 0.3, -0.2)).norm() < 1e-14,
                    "{law:?}: momentum {momentum:?}"
                );
                for (a, b) in double.iter().zip(&narrow) {
                    let (v, w) = ((a.velocity - b.velocity).norm(), (a.spin - b.spin).norm() * 0.01);
                    assert!(v < 2e-6 && w < 2e-6, "{law:?}: velocity differs by {v} m/s, spin by {w} m/s");
                    assert_ne!(a.velocity, b.velocity, "{law:?}: {precision:?} is computed in double");
                }
            }
        }
    }
}

/// The overlap under weight, mg/k, is a ten-thousandth of the radius and smaller than the last digit of the distance in single
/// precision would allow to a thousandth: it is right to a millionth.
#[test]
fn a_grain_at_rest_overlaps_by_its_weight_over_the_stiffness() {
    for precision in [Precision::Double, Precision::Mixed, Precision::Single] {
        let mut setup = with_friction(empty(HOOKE, 0.2), 0.5);
        setup.gravity.z = -9.81;
        setup.walls = vec![plane(Vec3::z())];
        setup.particles = vec![grain(0, Vec3::new(0.3, 0.2, 0.01))];
        let mut sim = simulation(setup, precision);
        run_until(&mut sim, 1.0);
        let weight = dem::mass(0.01, 2500.0) * 9.81;
        let overlap = 0.01 - particles(&mut sim)[0].position.z;
        assert!((overlap * 1e4 / weight - 1.0).abs() < 1e-6, "{precision:?}: {overlap} m");
    }
}

/// The sum of three loads, each rounded to single precision, is rounded again only where sums are kept so.
#[test]
fn sums_are_rounded_in_single_precision() {
    let end = |precision| {
        let mut setup = empty(HOOKE, 0.7);
        // All push to one side: where they cancel, a sum is exact.
        let around = [[0.0196, 0.0, 0.0], [0.0098, 0.01705, 0.0], [0.0098, 0.0057, 0.0161]].map(Vec3::from);
        setup.particles = (1..).zip(around).map(|(id, at)| grain(id, at)).collect();
        setup.particles.push(grain(0, Vec3::zeros()));
        let mut sim = simulation(setup, precision);
        sim.step().expect("within the guards");
        particles(&mut sim)[0].position
    };
    let (mixed, single) = (end(Precision::Mixed), end(Precision::Single));
    let apart = (mixed - single).norm() / mixed.norm();
    assert!(apart > 1e-9 && apart < 1e-6, "{apart}");
}

/// Triangles that are no contacts are put far out of reach, which single precision cannot hold.
#[test]
fn a_grain_rests_on_a_mesh() {
    let at = |x: f64, y: f64| Vec3::new(x, y, 0.0);
    let vertices = vec![at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
    let mesh = TriMesh { vertices, faces: vec![[0, 1, 2], [0, 2, 3]] };
    let mut setup = with_friction(empty(HOOKE, 0.2), 0.5);
    setup.contacts.iter_mut().for_each(|c| c.set("rolling_resistance", 0.1));
    setup.gravity.z = -9.81;
    setup.walls = vec![Wall { shape: WallShape::Mesh(mesh), ..plane(Vec3::z()) }];
    setup.particles =
        vec![Particle { velocity: Vec3::new(0.1, 0.0, 0.0), ..grain(0, Vec3::new(0.0, 0.0, 0.01)) }];
    for precision in NARROW {
        let mut sim = simulation(setup.clone(), precision);
        run_until(&mut sim, 1.0);
        let p = particles(&mut sim)[0];
        assert!(p.velocity.norm() < 1e-6 && (p.position.z - 0.01).abs() < 1e-4, "{precision:?}: {p:?}");
    }
}

#[test]
fn grains_too_fine_for_single_precision_are_refused() {
    let mut setup = with_friction(empty(HOOKE, 0.2), 0.5);
    setup.particles = vec![Particle { radius: 1e-6, ..grain(0, Vec3::zeros()) }];
    for precision in NARROW {
        let error = Simulation::new(Setup { precision, ..setup.clone() }).err().expect("refused").to_string();
        assert!(error.contains(precision.name()) && error.contains("0.000001"), "{error}");
    }
}

#[test]
fn effects_that_are_not_offered_are_refused_by_name() {
    let mut setup = with_friction(empty(HOOKE, 0.5), 0.5);
    setup.contacts[0].set("twisting_resistance", 0.1);
    setup.particles = vec![grain(0, Vec3::zeros())];
    for precision in NARROW {
        let error = Simulation::new(Setup { precision, ..setup.clone() }).err().expect("refused");
        assert!(matches!(error, SetupError::PrecisionWithout { .. }));
        let text = error.to_string();
        assert!(text.contains("twisting") && text.contains("grain–grain"), "{text}");
        assert!(text.contains(precision.name()), "{text}");
    }
}
