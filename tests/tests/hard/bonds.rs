//! Bonds at their extremes: all break in one step, a stone hits a floor at 100 m/s, no strength, endless strength, sizes of 1:100.

use crate::variants::{run, simulation};
use dem::setup::*;
use dem::{Setup, Simulation};
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{HOOKE, bond, empty, grain, lattice, particles, plane};

const PART: &str = "Bonds";
const BURST: Case = case(
    PART,
    "all bonds of a stone break in one step: the ledger closes, relative to the energy at the start",
);
const MOMENTUM: Case =
    case(PART, "all bonds of a stone break in one step: Σ m v is what it was, over Σ m |v|");
const HIT: Case = case(
    PART,
    "a stone of glass hits a floor at 100 m/s: the ledger closes through breaking, relative to the energy at the start",
);
const SOFT: Case = case(PART, "a stone that is too soft for 100 m/s: the run stops with the reason");
const SIZES: Case = case(
    PART,
    "a grain of 1 mm bonded to one of 100 mm, thrown: the ledger closes, relative to the energy at the start",
);

/// Grains of a lattice, bonded with this strength [Pa], with the ledger.
fn stone(cells: [u32; 3], strength: f64) -> Setup {
    let mut setup = empty(HOOKE, 0.5);
    let strength = BondStrength::of(strength, strength);
    setup.bonds = vec![Bond { strength, damping: 0.1, ..bond((0, 0)) }];
    setup.particles = lattice(cells, Vec3::zeros());
    setup.ledger = true;
    setup.step = Step::Auto(0.3);
    setup
}

/// What the ledger misses since the start, over the energy at the start [–].
fn missing(sim: &mut Simulation, start: f64) -> f64 {
    let energy = sim.energy().expect("within the guards");
    (energy.balance() - start) / start
}

/// Grains that fly apart, faster the farther they are from the centre: every bond is drawn at once.
#[test]
fn all_bonds_break_in_one_step() {
    let mut setup = stone([4, 4, 4], 1e-3);
    setup.particles.iter_mut().for_each(|p| p.velocity = p.position * 50.0);
    let mut sim = simulation(setup);
    let start = sim.energy().expect("sound").balance();
    let [all, _] = sim.bond_count();
    run(&mut sim, 2);
    let cracks = sim.take_cracks();
    assert!(all > 100 && cracks.len() == all, "{} of {all} broke", cracks.len());
    assert!(cracks.iter().all(|c| c.time == cracks[0].time && c.mode == dem::BreakMode::Tension));
    run(&mut sim, 2000);
    BURST.within("64 grains", missing(&mut sim, start), "–", 1e-10);
    let end = particles(&mut sim);
    let (sum, of) =
        end.iter().fold((Vec3::zeros(), 0.0), |(sum, of), p| (sum + p.velocity, of + p.velocity.norm()));
    MOMENTUM.within("64 grains", sum.norm() / of, "–", 1e-12);
}

/// A stone thrown at a floor, with this modulus of grains and floor [Pa].
fn thrown(young: f64) -> Setup {
    let mut setup = stone([4, 4, 4], 3e7);
    setup.contacts =
        [(0, 0), (0, 1)].map(|between| ContactLaw::new(between, "hertz").with("restitution", 0.5)).into();
    setup.materials.iter_mut().for_each(|m| m.young = young);
    setup.bonds[0].kind = BondKind::Beam { young, shear_modulus: 0.4 * young };
    setup.walls = vec![plane(Vec3::z())];
    for p in &mut setup.particles {
        p.position.z += 0.05;
        p.velocity = Vec3::new(3.0, -2.0, -100.0);
    }
    setup
}

#[test]
fn a_stone_at_100_metres_a_second() {
    let mut sim = simulation(thrown(7e10));
    let start = sim.energy().expect("sound").balance();
    for _ in 0..8 {
        run(&mut sim, 250);
        HIT.within(&format!("at {:.1e} s", sim.time()), missing(&mut sim, start), "–", 1e-10);
    }
    let ([all, broken], energy) = (sim.bond_count(), sim.energy().expect("within the guards"));
    assert!(broken > all / 4, "{broken} of {all} broke");
    assert!(energy.translation + energy.rotation < start, "{energy:?} after a start with {start} J");
    let said = crate::variants::halt(&mut simulation(thrown(1e6)), 100_000).expect("stops");
    SOFT.refused("grains of 1 MPa", &said, &["in one step", "guards.motion"]);
}

/// Strength 0 breaks at the first strain; endless strength never breaks.
#[test]
fn no_strength_and_endless_strength() {
    let broken = |strength: f64, speed: f64| {
        let mut setup = stone([2, 2, 2], strength);
        setup.particles[0].velocity.x = -speed;
        let mut sim = simulation(setup);
        run(&mut sim, 1000);
        let [all, broken] = sim.bond_count();
        assert!(particles(&mut sim).iter().all(|p| p.position.iter().all(|x| x.is_finite())));
        (broken, all)
    };
    assert_eq!(broken(0.0, 1e-6), (12, 12), "each is strained in turn");
    assert_eq!(broken(f64::INFINITY, 5.0), (0, 12));
}

#[test]
fn sizes_of_one_to_a_hundred() {
    let mut setup = stone([1, 1, 1], f64::INFINITY);
    let small = Particle {
        radius: 0.001,
        velocity: Vec3::new(0.0, 1.0, 0.0),
        ..grain(1, Vec3::new(0.1015, 0.0, 0.0))
    };
    setup.particles = vec![Particle { radius: 0.1, ..grain(0, Vec3::zeros()) }, small];
    let mut sim = simulation(setup);
    let start = sim.energy().expect("sound").balance();
    run(&mut sim, 50_000);
    assert_eq!(sim.bond_count(), [1, 0]);
    SIZES.within("50 000 steps", missing(&mut sim, start), "–", 1e-10);
    let apart = (particles(&mut sim)[1].position - particles(&mut sim)[0].position).norm();
    assert!((apart / 0.1015 - 1.0).abs() < 0.01, "{apart} m apart");
}
