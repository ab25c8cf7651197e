//! Starts that cannot be, and the emptiest ones.

use crate::variants::{run, simulation, variants};
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{grain, particles, plane};
use scene::advice::explain_halt;
use scene::advice::explain_setup_error;

const DEEP: Case = case(
    "Rest and extremes",
    "a start at 50 % overlap, or with two equal centres, is stopped; the message names both grains",
);
const EMPTY: Case =
    case("Rest and extremes", "a scene without grains runs, and a scene with one grain that touches nothing");
const HUGE: Case = case("Rest and extremes", "a grain whose position is not a number is refused with its id");

/// Equal centres and deep overlaps are named with their grains, and never become a number that is none.
#[test]
fn starts_that_cannot_be_are_stopped_with_ids() {
    for variant in variants() {
        for distance in [0.0, 1e-300, 1e-12, 0.01] {
            let mut setup = variant.rough(0.5, 0.5);
            setup.particles = vec![grain(41, Vec3::zeros()), grain(42, Vec3::new(distance, 0.0, 0.0))];
            let on = format!("{}, {distance} m apart", variant.name());
            let halt = explain_halt(&simulation(setup).step().expect_err(&on));
            DEEP.refused(&on, &halt, &["41", "42", "overlaps", "limit 25.0 %"]);
            assert!(!halt.contains("NaN"), "{halt}");
        }
    }
}

/// Where the guard is raised to bear it, the same start relaxes: the grains part, and every number stays one.
#[test]
fn a_deep_start_relaxes_where_the_guard_bears_it() {
    for variant in variants() {
        let mut setup = variant.rough(0.5, 0.5);
        (setup.guards.overlap, setup.guards.motion) = (1.0, 1.0);
        setup.particles = vec![grain(41, Vec3::zeros()), grain(42, Vec3::new(0.01, 0.0, 0.0))];
        let mut sim = simulation(setup);
        run(&mut sim, 20_000);
        let all = particles(&mut sim);
        let apart = all[1].position - all[0].position;
        assert!(apart.norm() > 0.0199 - 2e-3, "{}: {apart:?}", variant.name());
        let drift = (all[0].velocity + all[1].velocity).norm();
        DEEP.within(
            &format!("{}, guards raised: momentum when they have parted", variant.name()),
            drift,
            "m/s",
            1e-12,
        );
    }
}

/// A scene without grains, and one with a grain that meets nothing, run.
#[test]
fn no_grain_and_one_grain() {
    for variant in variants() {
        for count in 0..2 {
            let mut setup = variant.rough(0.5, 0.5);
            setup.step = Step::Fixed(1e-5);
            setup.walls = vec![plane(Vec3::z())];
            setup.particles = (0..count).map(|k| grain(k, Vec3::new(0.0, 0.0, 0.1))).collect();
            let mut sim = simulation(setup);
            run(&mut sim, 100);
            let left = particles(&mut sim).len();
            EMPTY.within(&variant.name(), left as f64 - f64::from(count), "grains lost", 0.0);
        }
    }
}

/// Puts a number where it does not belong.
type Spoil = fn(&mut Particle, f64);

/// A value that is not a number is refused before the first step, with the grain's id and the key.
#[test]
fn what_is_no_number_is_refused() {
    let wrong: [(&str, Spoil); 4] = [
        ("position", |p, x| p.position.y = x),
        ("velocity", |p, x| p.velocity.z = x),
        ("spin", |p, x| p.spin.x = x),
        ("radius", |p, x| p.radius = x),
    ];
    for variant in variants() {
        for (key, spoil) in wrong {
            for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                // Where cohesion or single precision bounds radii, that is what is said.
                if key == "radius" && (variant.normal.cohesion.is_some() || variant.mixed()) {
                    continue;
                }
                let mut setup = variant.rough(0.5, 0.5);
                setup.particles = vec![grain(41, Vec3::zeros()), grain(42, Vec3::new(0.1, 0.0, 0.0))];
                spoil(&mut setup.particles[1], value);
                let error = explain_setup_error(&dem::Simulation::new(setup).err().expect("refused"));
                HUGE.refused(&format!("{}: {key} {value}", variant.name()), &error, &["particle 42", key]);
            }
        }
    }
}

/// Invalid indices of materials are refused, by the critical step as well, wherever they occur.
#[test]
fn materials_that_are_none_are_refused() {
    type Spoil = fn(&mut dem::Setup);
    let wrong: [(&str, Spoil); 5] = [
        ("particle 41: material", |s| s.particles[0].material = 9),
        ("wall 'plane': material", |s| s.walls[0].material = 9),
        ("contact: between", |s| s.contacts[0].between.1 = 9),
        ("inlet: material", |s| (s.entry_materials, s.largest_entry) = (vec![9], 0.01)),
        ("clump 'ball': material", |s| {
            let spheres = [(Vec3::zeros(), 0.01)];
            let shape = ClumpShape::new("ball", 9, &spheres, &geom::Moments::of_sum(&spheres));
            s.clumps = Clumps {
                shapes: vec![shape],
                placed: vec![],
                entries: vec![ClumpScales { shape: 0, least: 1.0, most: 1.0 }],
            };
        }),
    ];
    for (what, spoil) in wrong {
        let mut setup = variants()[0].rough(0.5, 0.5);
        setup.particles = vec![grain(41, Vec3::new(0.0, 0.0, 0.1))];
        setup.walls = vec![plane(Vec3::z())];
        spoil(&mut setup);
        let of_step = dem::critical_step(&setup).expect_err("refused");
        let error = dem::Simulation::new(setup).err().expect("refused");
        assert_eq!(of_step, error);
        HUGE.refused(what, &explain_setup_error(&error), &[what, "9", "the scene's materials"]);
    }
}
