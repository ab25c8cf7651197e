//! Walton and Braun's law: a spring that yields loses the same share at every speed, on grains and on walls, with everything that rubs.

use super::simulation;
use dem::setup::*;
use dem::{Setup, Simulation};
use geom::Vec3;
use grainpipe_tests::same_bits::{Run, particle_bits};
use grainpipe_tests::setups::{HOOKE, empty, grain, particles, plane, run_until, with_friction};

/// Stiffness of loading k₁ [N/m].
const LOADING: f64 = 1e4;

fn yielding(restitution: f64) -> Setup {
    let mut setup = empty(HOOKE, restitution);
    setup.contacts.iter_mut().for_each(|law| law.choose("law", "walton_braun"));
    setup
}

/// A grain falls onto a floor, or two grains meet: they part at e times the speed at which they met, whatever that is.
#[test]
fn rebounds_with_the_same_restitution_at_every_speed() {
    for e in [0.3, 0.6, 1.0] {
        for speed in [0.01, 0.1, 1.0] {
            for wall in [false, true] {
                let mut setup = yielding(e);
                setup.step = Step::Auto(0.002);
                let mut a = grain(1, Vec3::new(0.0, 0.0, 0.010_001));
                a.velocity.z = -speed;
                let b = grain(2, Vec3::new(0.0, 0.0, -0.01));
                setup.particles = if wall { vec![a] } else { vec![a, b] };
                setup.walls = if wall { vec![plane(Vec3::z())] } else { vec![] };
                let mut sim = simulation(setup);
                run_until(&mut sim, 0.2 / speed.min(0.1) * 0.05 + 0.03);
                let after = particles(&mut sim);
                let parted = after[0].velocity.z - if wall { 0.0 } else { after[1].velocity.z };
                let got = parted / speed;
                assert!((got - e).abs() < 2e-3, "e = {e}, {speed} m/s, wall {wall}: {got}");
            }
        }
    }
}

/// The force goes up along k₁ and comes back along k₂ = k₁/e², from the deepest overlap: followed on a wall that pushes a held grain.
#[test]
fn loads_along_one_line_and_unloads_along_a_steeper_one() {
    let e = 0.5;
    let mut setup = yielding(e);
    setup.step = Step::Fixed(1e-5);
    let mut wall = plane(Vec3::z());
    // Deepest after 10 ms, at 0.5 mm.
    (wall.motion.amplitude, wall.motion.frequency) = (Vec3::new(0.0, 0.0, 0.000_5), 25.0);
    setup.walls = vec![wall];
    // So dense that it stays where it is.
    setup.materials[0].density = 1e12;
    setup.particles = vec![grain(1, Vec3::new(0.0, 0.0, 0.01))];
    let mut sim = simulation(setup);
    let mut force = |time: f64| {
        run_until(&mut sim, time);
        let (now, deepest) = (sim.time(), 0.000_5);
        let overlap = deepest * (2.0 * std::f64::consts::PI * 25.0 * now).sin();
        let found = sim.record_contacts().expect("no guard trips");
        (overlap, found.first().map_or(0.0, |c| c.force.z))
    };
    for (time, loading) in [(0.004, true), (0.008, true), (0.011, false), (0.012, false), (0.018, false)] {
        let (overlap, force) = force(time);
        let rest = (1.0 - e * e) * 0.000_5;
        let wanted = if loading { LOADING * overlap } else { LOADING / (e * e) * (overlap - rest).max(0.0) };
        assert!((force - wanted).abs() < 2e-4 * LOADING * 0.000_5, "{time} s: {force} N, not {wanted} N");
    }
}

/// Grains dropped onto a shaking floor, with everything that rubs.
fn pile() -> Setup {
    let mut setup = with_friction(yielding(0.5), 0.4);
    for law in &mut setup.contacts {
        law.set("rolling_resistance", 0.1);
        law.set("twisting_resistance", 0.05);
    }
    (setup.gravity.z, setup.ledger, setup.step) = (-9.81, true, Step::Auto(0.1));
    let mut floor = plane(Vec3::z());
    (floor.motion.amplitude, floor.motion.frequency) = (Vec3::new(0.001, 0.0, 0.002), 20.0);
    setup.walls = vec![floor];
    let at =
        |k: u32| Vec3::new(0.002 * f64::from(k % 2), 0.0015 * f64::from(k % 3), 0.011 + 0.021 * f64::from(k));
    setup.particles =
        (0..12).map(|k| Particle { spin: Vec3::new(0.0, 5.0, 30.0), ..grain(k, at(k)) }).collect();
    setup
}

/// Plastic work is in the ledger: what comes in, goes out and stays add up.
#[test]
fn the_ledger_closes() {
    let mut sim = simulation(pile());
    run_until(&mut sim, 0.3);
    let e = sim.energy().expect("no guard trips");
    let exchanged = e.normal + e.sliding + e.rolling + e.twisting + e.walls.abs();
    assert!(e.normal > 0.0 && e.elastic >= 0.0, "{e:?}");
    assert!(e.integration.abs() < 5e-3 * exchanged, "{:e} of {exchanged:e} J", e.integration);
}

/// Every width of lanes, and a run that is resumed, give the same bits.
#[test]
fn same_bits_in_lanes_and_resumed() {
    let parts: [&(dyn Fn(&mut Simulation) + Sync); 2] =
        [&|sim| run_until(sim, 0.06), &|sim| run_until(sim, 0.1)];
    let look = |sim: &mut Simulation| {
        particles(sim);
    };
    Run { setup: &pile, parts, look: &look, bits: &particle_bits }.check();
}
