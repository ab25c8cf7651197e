//! Linear contacts of numbers that are given directly: a modulus, dashpots, a tangential stiffness.

use crate::simulation;
use dem::setup::*;
use dem::{Setup, mass};
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{HOOKE, empty, grain, plane};
use std::f64::consts::PI;

const PART: &str = "One contact";
const STIFFNESS: Case =
    case(PART, "k_n of a modulus: 2 E_c (r_i + r_j) or E π r²/(r_i + r_j), at a flat wall 8 E_c r or E π r");
const DASHPOT: Case = case(PART, "η_n given directly: F = k δ + η_n δ̇; η_t, K_t: |F_t| = K_t s + η_t ṡ");
const STEP: Case =
    case("Time step", "critical step of a modulus or a dashpot given directly: that of the k and e it makes");

/// Overlap of all contacts here [m].
const OVERLAP: f64 = 1e-5;
/// A modulus [Pa].
const MODULUS: f64 = 3e7;

/// Materials and linear laws of these numbers, in steps in which nothing moves much.
fn of(keys: &[(&'static str, f64)]) -> Setup {
    let mut setup = empty(HOOKE, 0.5);
    for law in &mut setup.contacts {
        let between = law.between;
        *law = keys.iter().fold(ContactLaw::new(between, "hooke"), |law, (key, x)| law.with(key, *x));
    }
    setup.step = Step::Fixed(1e-10);
    setup.record_wrenches = true;
    setup
}

/// Two grains above each other, or one on a floor; the upper has this velocity [m/s].
fn pressed(mut setup: Setup, radii: [f64; 2], flat: bool, velocity: Vec3) -> Setup {
    let [below, above] = radii;
    let of = |id, radius, z, velocity| Particle { radius, velocity, ..grain(id, Vec3::new(0.0, 0.0, z)) };
    if flat {
        setup.walls = vec![plane(Vec3::z())];
        setup.particles = vec![of(0, above, above - OVERLAP, velocity)];
    } else {
        let reach = below + above - OVERLAP;
        setup.particles = vec![of(0, below, 0.0, Vec3::zeros()), of(1, above, reach, velocity)];
    }
    setup
}

/// Force of the only contact on the upper body [N].
fn force(setup: Setup) -> Vec3 {
    let mut sim = simulation(setup);
    sim.step().expect("within the guards");
    let found = sim.record_contacts().expect("within the guards");
    assert_eq!(found.len(), 1);
    let up = if found[0].normal.z > 0.0 { 1.0 } else { -1.0 };
    found[0].force * up
}

/// Radii of a pair, or of a grain on a floor.
const BODIES: [([f64; 2], bool); 4] =
    [([0.01, 0.01], false), ([0.03, 0.01], false), ([0.002, 0.04], false), ([0.01, 0.01], true)];

/// k of both scalings [N/m].
fn stiffness([a, b]: [f64; 2], flat: bool) -> [(&'static str, f64); 2] {
    let thin = a.min(b);
    let [length, area] = if flat { [4.0 * b, b] } else { [a + b, thin * thin / (a + b)] };
    [("contact_modulus", 2.0 * MODULUS * length), ("effective_modulus", PI * MODULUS * area)]
}

#[test]
fn stiffness_of_a_modulus() {
    for (radii, flat) in BODIES {
        for (key, k) in stiffness(radii, flat) {
            let setup = of(&[(key, MODULUS), ("restitution", 1.0)]);
            let found = force(pressed(setup, radii, flat, Vec3::zeros())).z / OVERLAP;
            STIFFNESS.equals(&format!("{key}, radii {radii:?}, flat: {flat}"), found, "N/m", k, 1e-9);
        }
    }
}

#[test]
fn dashpots_and_tangential_stiffness() {
    let (k, normal, tangential, across) = (2e5, 0.7, 0.4, 5e4);
    let velocity = Vec3::new(0.2, 0.0, -0.05);
    let base = [("stiffness", k), ("sliding_friction", 1e3), ("tangential_stiffness", across)];
    let with = |keys: &[(&'static str, f64)]| {
        force(pressed(of(&[&base[..], keys].concat()), [0.01, 0.02], false, velocity))
    };
    // The spring has stretched for one step at most.
    let slack = 1e-3;
    let both = with(&[("normal_damping", normal), ("tangential_damping", tangential)]);
    DASHPOT.equals("both, normal", both.z, "N", k * OVERLAP + normal * 0.05, 1e-6);
    DASHPOT.equals("both, tangential", -both.x, "N", tangential * 0.2, slack);
    let one = with(&[("normal_damping", normal)]);
    DASHPOT.equals("η_n alone, tangential", -one.x, "N", normal * (across / k).sqrt() * 0.2, slack);
    let other = with(&[("restitution", 1.0), ("tangential_damping", tangential)]);
    DASHPOT.equals("e = 1 and η_t, normal", other.z, "N", k * OVERLAP, 1e-6);
    DASHPOT.equals("e = 1 and η_t, tangential", -other.x, "N", tangential * 0.2, slack);
    // Without a dashpot the spring alone holds.
    let mut setup = of(&[&base[..], &[("restitution", 1.0), ("tangential_damping", 0.0)]].concat());
    setup.step = Step::Fixed(1e-6);
    let spring = force(pressed(setup, [0.01, 0.02], false, Vec3::new(0.2, 0.0, 0.0)));
    let stretched = -spring.x / across;
    assert!((0.5e-6 * 0.2..1.6e-6 * 0.2).contains(&stretched), "{stretched} m after a step of 2e-7 m");
}

/// The critical step knows of both: it is that of the linear law with the same numbers.
#[test]
fn critical_step() {
    let step = |keys: &[(&'static str, f64)]| {
        let mut setup = of(keys);
        setup.step = Step::Auto(1.0);
        simulation(pressed(setup, [0.01, 0.01], false, Vec3::zeros())).dt()
    };
    let friction = ("sliding_friction", 0.5);
    let reduced = 0.5 * mass(0.01, 2500.0);
    for (key, k) in stiffness([0.01, 0.01], false) {
        for e in [1.0, 0.3] {
            let given = step(&[(key, MODULUS), ("restitution", e), friction]);
            let plain = step(&[("stiffness", k), ("restitution", e), friction]);
            STEP.equals(&format!("{key}, e = {e}"), given, "s", plain, 1e-12);
        }
        let gamma = dem::effects::damping_ratio(0.3);
        let given = step(&[("stiffness", k), ("normal_damping", gamma * (k * reduced).sqrt()), friction]);
        let plain = step(&[("stiffness", k), ("restitution", 0.3), friction]);
        STEP.equals(&format!("normal_damping, k = {k}"), given, "s", plain, 1e-12);
    }
}
