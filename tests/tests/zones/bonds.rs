//! Bonds through a cut: a bonded rod is downstream what it was upstream, and nothing of it is lost.

use super::zone;
use dem::setup::*;
use dem::{Setup, Simulation};
use geom::Vec3;
use grainpipe_tests::setups::{HOOKE, bond, empty, grain, particles, run_until};

const PITCH: f64 = 0.021;
const LENGTH: f64 = 0.03;

/// A rod of five that flies along x through the storage plane and turns about itself; falling where the zone lets it fall.
fn rod(motion: ZoneMotion) -> Setup {
    let mut setup = empty(HOOKE, 0.5);
    setup.bonds = vec![bond((0, 0))];
    setup.gravity = if motion == ZoneMotion::Ballistic { Vec3::new(0.0, 0.0, -9.81) } else { Vec3::zeros() };
    setup.step = Step::Auto(0.5);
    setup.outlets = vec![Zone { motion, ..zone(0.100_03, LENGTH) }];
    setup.particles = (0..5).map(|k| grain(10 + k, Vec3::new(-PITCH * f64::from(k), 0.0, 0.0))).collect();
    setup.particles.iter_mut().for_each(|p| {
        (p.velocity, p.spin) = (Vec3::new(1.0, 0.0, 0.3), Vec3::new(30.0, 0.0, 0.0));
    });
    setup
}

/// It swings: neighbours are twisted against each other, and the ends bent.
fn swinging(motion: ZoneMotion) -> Setup {
    let mut setup = rod(motion);
    for (k, p) in setup.particles.iter_mut().enumerate() {
        p.spin = Vec3::new(if k % 2 == 0 { 20.0 } else { -20.0 }, 0.0, 0.0);
        p.velocity.y = 0.05 * (k as f64 - 2.0).powi(2);
    }
    setup
}

fn weak(mut setup: Setup, share: f64) -> Setup {
    // Of the modulus of these beams.
    let strength = 1e7 * share;
    setup.bonds[0].strength = BondStrength::of(strength, strength);
    setup
}

/// What a stage upstream tells, in the order of times.
enum News {
    Enters(Entry),
    Is(u32, Guide),
    Bonded(CrossingBond),
}

fn along_paths(setup: &Setup, until: f64) -> (Vec<News>, Simulation) {
    let mut sim = Simulation::new(setup.clone()).expect("sound");
    let (mut told, mut known) = (Vec::new(), Vec::new());
    while sim.time() < until {
        let time = sim.time();
        for s in sim.sample_paths() {
            let (p, turn) = (s.particle, s.turn);
            let sample = Sample { time, position: p.position, velocity: p.velocity, spin: p.spin, turn };
            if known.contains(&p.id) {
                told.push(News::Is(p.id, Guide::At(sample)));
            } else {
                known.push(p.id);
                told.push(News::Enters(Entry { time, inlet: 0, particle: p, clump: None, turn, cluster: 0 }));
            }
        }
        sim.step().expect("within the guards");
        for c in sim.take_crossings() {
            let (p, turn) = (c.particle, c.turn);
            let sample =
                Sample { time: c.time, position: p.position, velocity: p.velocity, spin: p.spin, turn };
            told.extend(c.bonds.into_iter().map(News::Bonded));
            told.push(News::Is(p.id, Guide::Free(sample)));
        }
    }
    (told, sim)
}

/// Each enters a time `ahead` [s] before it passes, moved back along its path.
fn in_flight(setup: &Setup, until: f64, ahead: f64) -> (Vec<News>, Simulation) {
    let mut sim = Simulation::new(setup.clone()).expect("sound");
    let a = setup.outlets[0].acceleration(&setup.gravity);
    let mut told = Vec::new();
    while sim.time() < until {
        sim.step().expect("within the guards");
        for c in sim.take_crossings() {
            let mut p = c.particle;
            p.position += a * (0.5 * ahead * ahead) - p.velocity * ahead;
            p.velocity -= a * ahead;
            let turn = c.turn.map(|turn| dem::spun(&(p.spin * -ahead)) * turn);
            told.push(News::Enters(Entry {
                time: c.time - ahead,
                inlet: 0,
                particle: p,
                clump: None,
                turn,
                cluster: 0,
            }));
            told.extend(c.bonds.into_iter().map(News::Bonded));
        }
    }
    (told, sim)
}

fn below(up: &Setup) -> Setup {
    let entry_bonds = dem::bonds_of(up).expect("sound");
    let (particles, inlets, entry_materials) = (vec![], up.outlets.clone(), vec![0]);
    let (smallest_entry, largest_entry, outlets) = (0.01, 0.01, vec![]);
    Setup {
        particles,
        inlets,
        outlets,
        smallest_entry,
        largest_entry,
        entry_materials,
        entry_bonds,
        ..up.clone()
    }
}

/// A stage downstream that gets its whole inlet at once.
fn downstream(setup: Setup, told: Vec<News>) -> Simulation {
    let mut sim = Simulation::new(setup).expect("sound");
    for one in told {
        match one {
            News::Enters(entry) => sim.enter(entry).expect("in order"),
            News::Is(id, guide) => sim.guide(id, guide).expect("in order"),
            News::Bonded(bond) => sim.enter_bond(bond),
        }
    }
    sim
}

/// Largest distance of two of one id [m].
fn apart(a: &mut Simulation, b: &mut Simulation) -> f64 {
    let (a, b) = (particles(a), particles(b));
    assert_eq!(a.len(), b.len());
    a.iter().zip(&b).map(|(p, q)| (p.position - q.position).norm()).fold(0.0, f64::max)
}

/// Its bonds come through unstrained, whatever it has turned by: a millionth of a strain or a twist would break them.
#[test]
fn a_rod_comes_through_unstrained() {
    let motions = [ZoneMotion::Constant, ZoneMotion::Ballistic, ZoneMotion::Recorded];
    for (motion, swapped) in motions.into_iter().flat_map(|m| [(m, false), (m, true)]) {
        let mut up = weak(rod(motion), 1e-6);
        if swapped {
            up.particles.iter_mut().for_each(|p| p.id = 24 - p.id);
        }
        let (told, upstream) = match motion {
            ZoneMotion::Recorded => along_paths(&up, 0.23),
            _ => in_flight(&up, 0.23, 0.025),
        };
        // All of it has left, whole; and each bond once.
        assert_eq!((upstream.particle_count(), upstream.bond_count()), (0, [4, 0]), "{motion:?}");
        let mut down = downstream(below(&up), told);
        let mut whole = Simulation::new(Setup { outlets: vec![], ..up.clone() }).expect("sound");
        run_until(&mut down, 0.3);
        run_until(&mut whole, 0.3);
        assert_eq!(down.bond_count(), [4, 0], "{motion:?}");
        let worst = apart(&mut down, &mut whole);
        assert!(worst < 1e-9, "{motion:?}: {worst} m apart");
    }
}

/// The grain that is free first is released into the strain that it passed with: the other is where it was then, with its orientation. (Later the two stages differ:
/// what travels upstream feels nothing.)
#[test]
fn a_rod_that_swings_is_strained_downstream_as_it_was_upstream() {
    let up = swinging(ZoneMotion::Recorded);
    let mut sim = Simulation::new(up.clone()).expect("sound");
    while sim.take_crossings().is_empty() {
        sim.step().expect("within the guards");
    }
    let there = sim.bonds().expect("sound")[0];
    let mut down = downstream(below(&up), along_paths(&up, 0.23).0);
    run_until(&mut down, sim.time() - 0.5 * sim.dt());
    let here = down.bonds().expect("sound")[0];
    assert_eq!((here.ids, down.steps()), ([10, 11], sim.steps()));
    let loads = |b: &dem::BondState| [b.force, b.moments[0], b.moments[1]];
    for (here, there) in loads(&here).into_iter().zip(loads(&there)) {
        assert!((here - there).norm() < 0.01 * there.norm(), "{here} instead of {there}");
        assert!(there.norm() > 0.0);
    }
    run_until(&mut down, 0.3);
    assert_eq!(down.bond_count(), [4, 0]);
}

/// One that breaks upstream while the rod passes is broken downstream.
#[test]
fn what_breaks_upstream_is_not_told_again() {
    let up = weak(swinging(ZoneMotion::Constant), 2e-3);
    let mut sim = Simulation::new(up).expect("sound");
    let mut told = Vec::new();
    while sim.time() < 0.23 {
        sim.step().expect("within the guards");
        told.extend(sim.take_crossings().into_iter().flat_map(|c| c.bonds));
    }
    let [all, broken] = sim.bond_count();
    assert!(all == 4 && broken > 0, "{broken} of {all} broke");
    let twice = |a: &CrossingBond| told.iter().any(|b| (a.id, a.partner) == (b.partner, b.id));
    assert!(told.iter().filter(|l| twice(l)).count() <= 2 * (all - broken));
}

/// The ledger closes on both sides of a cut: what bonds hold goes out and comes in with their grains.
#[test]
fn the_ledger_closes_on_both_sides() {
    for motion in [ZoneMotion::Constant, ZoneMotion::Ballistic, ZoneMotion::Recorded] {
        for (strength, damping) in [(1.0, 0.0), (2e-3, 0.3)] {
            let mut up = weak(swinging(motion), strength);
            (up.ledger, up.bonds[0].damping) = (true, damping);
            let moving = 5.0 * 0.5 * dem::mass(0.01, 2500.0);
            // The energy of the step is small as well: missing terms of the ledger would show there.
            let made = if strength < 1.0 { 2e-3 } else { 0.5 };
            let watch = |mut sim: Simulation, times: [f64; 4], stage: &str| {
                let start = sim.energy().expect("sound").balance();
                for until in times {
                    run_until(&mut sim, until);
                    let e = sim.energy().expect("sound");
                    let (open, step) = ((e.balance() - start) / moving, e.integration / moving);
                    let what = format!("{motion:?}, {strength}, {stage} at {until} s: {open}, {step}");
                    assert!(open.abs() < 1e-12 && step.abs() < made, "{what}");
                }
            };
            watch(Simulation::new(up.clone()).expect("sound"), [0.08, 0.11, 0.15, 0.23], "upstream");
            let (told, _) = match motion {
                ZoneMotion::Recorded => along_paths(&up, 0.23),
                _ => in_flight(&up, 0.23, 0.025),
            };
            watch(downstream(below(&up), told), [0.09, 0.11, 0.15, 0.3], "downstream");
        }
    }
}

/// Bonds on their way are part of the state.
#[test]
fn it_resumes_exactly() {
    let up = swinging(ZoneMotion::Recorded);
    let told = || downstream(below(&up), along_paths(&up, 0.23).0);
    let (mut whole, mut parts) = (told(), told());
    for until in [0.05, 0.09, 0.1, 0.11, 0.13, 0.2] {
        run_until(&mut whole, until);
        run_until(&mut parts, until);
        parts = Simulation::resume(below(&up), parts.checkpoint().to_static()).expect("the same setup");
        assert_eq!(particles(&mut whole), particles(&mut parts), "{until} s");
        assert_eq!(whole.bonds().expect("sound"), parts.bonds().expect("sound"), "{until} s");
    }
}

/// Incoming grains need the step that they had, and a zone that holds the longest bond.
#[test]
fn what_is_announced_bounds_step_and_zone() {
    let up = Setup { step: Step::Auto(1.0), ..rod(ZoneMotion::Constant) };
    let dt = |setup: Setup| Simulation::new(setup).expect("sound").dt();
    assert_eq!(dt(up.clone()), dt(below(&up)));
    let short = |setup: Setup, plane: f64| {
        let zones = vec![zone(plane, 0.0212)];
        let setup = if setup.inlets.is_empty() {
            Setup { outlets: zones, ..setup }
        } else {
            Setup { inlets: zones, ..setup }
        };
        Simulation::new(setup).err().expect("refused").to_string()
    };
    let wanted = "zone of 2.1200e-2 m is not longer than a bond may be at rest, 2.2000e-2 m";
    for setup in [up.clone(), below(&up)] {
        let said = short(setup, 0.1);
        assert!(said.starts_with(wanted), "{said}");
    }
}
