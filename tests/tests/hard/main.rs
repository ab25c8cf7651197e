//! Hard cases: rest without creep or heating, near and far from the origin; starts that cannot be.

use dem::Simulation;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::setups::{HOOKE, LAWS, empty, grain, particles, plane, with_friction};

/// Three grains on a floor carry a fourth, held by friction and rolling resistance alone.
fn pyramid(law: Law, at: Vec3) -> Simulation {
    let mut setup = with_friction(empty(law, 0.3), 0.6);
    setup.contacts.iter_mut().for_each(|c| c.rolling_resistance = Some(0.3));
    setup.gravity.z = -9.81;
    setup.step = Step::Auto(0.9);
    setup.walls = vec![plane(Vec3::z())];
    setup.particles = (0..3)
        .map(|k| {
            let (sin, cos) = (2.0 * std::f64::consts::FRAC_PI_3 * f64::from(k)).sin_cos();
            grain(k as u32, at + Vec3::new(0.0115 * cos, 0.0115 * sin, 0.00999))
        })
        .collect();
    setup.particles.push(grain(3, at + Vec3::new(0.0, 0.0, 0.0264)));
    Simulation::new(setup).expect("sound")
}

/// Velocities fall to rounding and stay there, and nothing creeps; 1 000 km from the origin the last bit of a position is
/// 1.2e-10 m, and the grains rest within a few of them of where they rest at the origin.
#[test]
fn rest_neither_creeps_nor_heats() {
    for law in LAWS {
        let mut heights = Vec::new();
        for far in [0.0, 1e6] {
            let mut sim = pyramid(law, Vec3::new(far, far, 0.0));
            let mut rest = |steps: u64| {
                (0..steps).for_each(|_| sim.step().expect("within the guards"));
                particles(&mut sim)
            };
            let (early, late) = (rest(60_000), rest(60_000));
            for (a, b) in early.iter().zip(&late) {
                assert!(
                    (a.position - b.position).norm() < 1e-13,
                    "{law:?} at {far} m: grain {} creeps",
                    a.id
                );
                assert!(b.velocity.norm() < 1e-12, "{law:?} at {far} m: {:e} m/s", b.velocity.norm());
                assert!(b.spin.norm() < 1e-10, "{law:?} at {far} m: {:e} rad/s", b.spin.norm());
            }
            heights.push(late[3].position.z);
        }
        assert!(heights[0] > 0.02, "the pyramid stands");
        assert!((heights[0] - heights[1]).abs() < 1e-8, "{law:?}: {} and {} m", heights[0], heights[1]);
    }
}

/// Equal centres and deep overlaps are named with their grains, and never become a number that is none.
#[test]
fn starts_that_cannot_be_are_stopped_with_ids() {
    for law in LAWS {
        for distance in [0.0, 1e-300, 1e-12, 0.01] {
            let mut setup = with_friction(empty(law, 0.5), 0.5);
            setup.particles = vec![grain(41, Vec3::zeros()), grain(42, Vec3::new(distance, 0.0, 0.0))];
            let halt = Simulation::new(setup).expect("sound").step().expect_err("too deep").to_string();
            assert!(halt.contains("41") && halt.contains("42"), "{halt}");
            assert!(!halt.contains("NaN"), "{halt}");
        }
    }
}

/// A scene without grains, and one with a grain that meets nothing, run.
#[test]
fn no_grain_and_one_grain() {
    for count in 0..2 {
        let mut setup = with_friction(empty(HOOKE, 0.5), 0.5);
        setup.step = Step::Fixed(1e-5);
        setup.walls = vec![plane(Vec3::z())];
        setup.particles = (0..count).map(|k| grain(k, Vec3::new(0.0, 0.0, 0.1))).collect();
        let mut sim = Simulation::new(setup).expect("sound");
        (0..100).for_each(|_| sim.step().expect("nothing can happen"));
        assert_eq!(particles(&mut sim).len(), count as usize);
    }
}

/// Two rubbing, rolling grains, in the middle of a periodic box or across its face.
fn rubbing(x: f64, period: f64, skin: Option<f64>) -> Vec<Particle> {
    let law = Law::Hooke { stiffness: 100.0, tangential_ratio: None };
    let mut setup = with_friction(empty(law, 0.9), 0.3);
    setup.contacts.iter_mut().for_each(|c| c.rolling_resistance = Some(0.2));
    setup.periodic = [Some((0.0, period)), None, None];
    (setup.skin, setup.guards.overlap) = (skin, 0.5);
    let spin = Vec3::new(0.0, 0.0, 20.0);
    let drift = Vec3::new(3.0, 0.5, 0.0);
    setup.particles = vec![
        Particle { spin, velocity: drift, ..grain(0, Vec3::new(x, 0.0, 0.0)) },
        Particle { velocity: drift, ..grain(1, Vec3::new((x + 0.0195) % period, 0.0, 0.0)) },
    ];
    let mut sim = Simulation::new(setup).expect("sound");
    (0..400).for_each(|_| sim.step().expect("within the guards"));
    particles(&mut sim)
}

/// Spring and couple of a contact go with it through a periodic face, also where both images of a grain are listed with another.
#[test]
fn a_contact_is_the_same_across_a_periodic_face() {
    let middle = rubbing(0.4, 1.0, None);
    for (x, period, skin) in
        [(0.99, 1.0, None), (0.02, 0.05, None), (0.045, 0.05, None), (0.02, 0.05, Some(0.02))]
    {
        for (a, b) in middle.iter().zip(&rubbing(x, period, skin)) {
            let (v, w) = ((a.velocity - b.velocity).norm(), (a.spin - b.spin).norm());
            assert!(
                a.spin.norm() > 0.5 && v < 1e-9 && w < 1e-6,
                "from {x} of {period} m: {v} m/s, {w} rad/s"
            );
        }
    }
}
