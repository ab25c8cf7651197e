//! k_t of every normal law, in every way that it can be given: a grain that is pressed on a floor and pushed sideways, without a dashpot along it.

use crate::simulation;
use dem::effects::{Elastic, Jkr};
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{HOOKE, empty, grain, particles, plane};

const STIFFNESS: Case = case(
    "One contact",
    "k_t as given: tangential_stiffness, tangential_ratio × k_n, or 4 G*/E* × k_n; 8 G* a of Hertz and JKR",
);

const OVERLAP: f64 = 2e-5;
const RADIUS: f64 = 0.01;
/// k_n [N/m], E_c [Pa], w [J/m²].
const NORMAL: f64 = 5e4;
const MODULUS: f64 = 2e6;
const WORK: f64 = 0.5;

/// Growth of the force over the way between two instants [N/m].
fn stiffness(law: &'static str, keys: &[(&'static str, f64)]) -> f64 {
    let mut setup = empty(HOOKE, 0.5);
    for contact in &mut setup.contacts {
        let new = ContactLaw::new(contact.between, law)
            .with("sliding_friction", 1e3)
            .with("tangential_damping", 0.0);
        *contact = keys.iter().fold(new, |law, (key, x)| law.with(key, *x));
    }
    setup.step = Step::Fixed(1e-8);
    setup.record_wrenches = true;
    setup.walls = vec![plane(Vec3::z())];
    let velocity = Vec3::new(0.1, 0.0, 0.0);
    setup.particles = vec![Particle { velocity, ..grain(0, Vec3::new(0.0, 0.0, RADIUS - OVERLAP)) }];
    let mut sim = simulation(setup);
    let mut at = |steps: u64| {
        while sim.steps() < steps {
            sim.step().expect("within the guards");
        }
        let force = sim.wall_forces().expect("within the guards")[0].force.x;
        (particles(&mut sim)[0].position.x, force)
    };
    let [(x, f), (there, more)] = [at(10), at(210)];
    (more - f) / (there - x)
}

/// How k_t is given: a name, the keys, and the k_t that they mean over k_n.
type Given = (&'static str, &'static [(&'static str, f64)], f64);

#[test]
fn every_law_takes_the_tangential_stiffness_that_it_is_given() {
    let setup = empty(HOOKE, 0.5);
    let elastic = Elastic::of(&setup.materials[0], &setup.materials[1]);
    let linear: [Given; 4] = [
        ("hooke", &[("stiffness", NORMAL), ("restitution", 0.5)], NORMAL),
        ("hooke", &[("stiffness", NORMAL), ("normal_damping", 0.1)], NORMAL),
        ("walton_braun", &[("stiffness", NORMAL), ("restitution", 0.5)], NORMAL),
        ("walton_braun", &[("stiffness", NORMAL), ("restitution", 0.8)], NORMAL),
    ];
    for (law, keys, normal) in linear {
        for (way, expected) in [
            (Some(("tangential_stiffness", 2e4)), 2e4),
            (Some(("tangential_ratio", 0.4)), 0.4 * normal),
            (None, elastic.tangential_ratio * normal),
        ] {
            let all: Vec<_> = keys.iter().copied().chain(way).collect();
            STIFFNESS.equals(&format!("{law}, {all:?}"), stiffness(law, &all), "N/m", expected, 1e-3);
        }
    }
    let by_modulus = [("contact_modulus", MODULUS), ("restitution", 0.5), ("tangential_ratio", 0.4)];
    let expected = 0.4 * 8.0 * MODULUS * RADIUS;
    STIFFNESS.equals("contact_modulus", stiffness("hooke", &by_modulus), "N/m", expected, 1e-3);
    let of_radius = |a: f64| elastic.tangential_ratio * 2.0 * elastic.modulus * a;
    let hertz = stiffness("hertz", &[("restitution", 0.5)]);
    STIFFNESS.equals("hertz", hertz, "N/m", of_radius((RADIUS * OVERLAP).sqrt()), 1e-3);
    let keys = [("restitution", 0.5), ("work_of_adhesion", WORK)];
    let jkr = Jkr::with_modulus(elastic.modulus, WORK, dem::effects::Damping::NONE);
    let last = jkr.last_radius(RADIUS);
    let a = last * Jkr::spread(OVERLAP, RADIUS, last).powi(2);
    STIFFNESS.equals("jkr", stiffness("jkr", &keys), "N/m", of_radius(a), 1e-3);
}
