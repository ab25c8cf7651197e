//! Periodic cells that are strained, or follow a stress.

use dem::setup::*;
use dem::{CellReport, Setup, SetupError, Simulation};
use geom::Vec3;
use grainpipe_tests::same_bits::{Run, particle_bits, steps};
use grainpipe_tests::setups::{HOOKE, LAWS, Law, bond, empty, grain, particles, run_until, with_friction};

/// Stress along x and y [Pa].
const CONFINEMENT: f64 = 5e3;
/// Side of the cell [m].
const SIDE: f64 = 0.1;

/// Loose grains of three sizes, 4 along each axis.
fn loose(law: Law, restitution: f64) -> Setup {
    let mut setup = with_friction(empty(law, restitution), 0.3);
    setup.step = Step::Auto(0.2);
    setup.periodic = [Some((0.0, SIDE)); 3];
    setup.particles = (0..64u32)
        .map(|k| {
            let at = |n: u32| 0.0125 + 0.025 * f64::from(n);
            let off = |n: u32| 1e-3 * (f64::from(k * n % 11) - 5.0);
            let place = Vec3::new(at(k % 4) + 0.1 * off(3), at(k / 4 % 4) + 0.1 * off(7), at(k / 16));
            let velocity = Vec3::new(off(3), off(5), off(7)) * 4.0;
            Particle { velocity, radius: [0.012, 0.011, 0.0105][k as usize % 3], ..grain(k, place) }
        })
        .collect();
    setup
}

fn stress(target: f64) -> Option<Strain> {
    Some(Strain::Stress { target: Target::constant(target), rate_limit: 1.0 })
}

/// Stress along x and y, compression along z at a rate [1/s] from `from` [s] on.
fn triaxial(law: Law, (confinement, rate, from): (f64, f64, f64)) -> Setup {
    let mut setup = loose(law, 0.3);
    let path = Target::new(vec![[0.0, 0.0], [0.5 * from, 0.06], [from, 0.06], [from + 1.0, 0.06 + rate]]);
    setup.strain = [stress(confinement), stress(confinement), Some(Strain::Path(path.expect("rows")))];
    setup
}

fn report(sim: &mut Simulation) -> CellReport {
    sim.cell().expect("sound").expect("it is strained")
}

/// A cubic lattice, one grain an edge, overlapping by hand: lengths are h₀ exp(−ε), all grains follow, and σ = k δ/a² of the spacings a.
#[test]
fn a_lattice_is_strained_as_a_whole() {
    let mut setup = empty(HOOKE, 1.0);
    setup.step = Step::Auto(0.1);
    let spacing = 0.0199;
    setup.particles = (0..64u32)
        .map(|k| grain(k, Vec3::new(f64::from(k % 4), f64::from(k / 4 % 4), f64::from(k / 16)) * spacing))
        .collect();
    setup.periodic = [Some((-0.003, 4.0 * spacing - 0.003)); 3];
    setup.strain = [Some(Strain::Rate(0.5)), Some(Strain::Rate(-0.1)), Some(Strain::Rate(0.25))];
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, 0.01);
    let cell = report(&mut sim);
    let spacings = [0.5, -0.1, 0.25].map(|rate: f64| spacing * (-rate * sim.time()).exp());
    for a in 0..3 {
        let length = cell.range[a].map_or(0.0, |(lo, hi)| hi - lo);
        assert!((length / (4.0 * spacings[a]) - 1.0).abs() < 1e-12, "length {a}: {length}");
        let across = spacings[(a + 1) % 3] * spacings[(a + 2) % 3];
        let expected = 1e4 * (0.02 - spacings[a]) / across;
        assert!((cell.stress[(a, a)] / expected - 1.0).abs() < 1e-6, "{a}: {} {expected}", cell.stress);
        assert!(cell.stress[(a, (a + 1) % 3)].abs() < 1e-6 * expected, "{}", cell.stress);
    }
    // A spacing is the same through the cell and across its faces.
    let all = particles(&mut sim);
    for p in &all[1..4] {
        let apart = (p.position.x - all[0].position.x) / spacings[0];
        assert!((apart - apart.round()).abs() < 1e-9, "{apart}");
    }
}

#[test]
fn stress_is_held_at_three_rates_of_strain() {
    for law in LAWS {
        for rate in [0.25, 0.5, 1.0] {
            let from = 0.4;
            let mut sim = Simulation::new(triaxial(law, (CONFINEMENT, rate, from))).expect("sound");
            run_until(&mut sim, from + 0.01 / rate);
            let mut worst = 0.0f64;
            for frame in 1..=25 {
                run_until(&mut sim, from + (0.01 + 0.003 * f64::from(frame)) / rate);
                let cell = report(&mut sim);
                (0..2).for_each(|a| worst = worst.max((cell.stress[(a, a)] / CONFINEMENT - 1.0).abs()));
            }
            assert!(worst < 0.01, "{law:?}, {rate} /s: a frame is off by {worst}");
        }
    }
}

/// 216 clumps of two spheres instead of the grains.
fn clumps(mut setup: Setup) -> Setup {
    let spheres = [(Vec3::x() * -0.006, 0.01), (Vec3::x() * 0.006, 0.01)];
    let shape = ClumpShape::new("pair", 0, &spheres, &geom::Moments::of_sum(&spheres));
    let body = |k: u32| {
        let at = |n: u32| (f64::from(n % 6) + 0.5) * SIDE / 6.0;
        let orientation = nalgebra::UnitQuaternion::from_euler_angles(f64::from(k), 2.0 * f64::from(k), 0.5);
        let (velocity, spin) =
            (Vec3::new(f64::from(k % 5) - 2.0, f64::from(k % 7) - 3.0, 0.0) * 0.01, Vec3::zeros());
        let position = Vec3::new(at(k), at(k / 6), at(k / 36));
        Body { id: 10 * k, shape: 0, scale: 0.5, position, orientation, velocity, spin }
    };
    setup.clumps = Clumps { shapes: vec![shape], placed: (0..216).map(body).collect(), entries: vec![] };
    setup.particles.clear();
    setup
}

/// The stiffness counts branches between bodies: with those of spheres alone the stress would be followed too fast.
#[test]
fn stress_on_clumps_is_held() {
    let mut sim = Simulation::new(clumps(triaxial(Law::Hertz, (CONFINEMENT, 0.5, 0.6)))).expect("sound");
    run_until(&mut sim, 0.62);
    for frame in 1..=20 {
        run_until(&mut sim, 0.62 + 0.006 * f64::from(frame));
        let stress = report(&mut sim).stress;
        for a in 0..2 {
            let off = stress[(a, a)] / CONFINEMENT - 1.0;
            assert!(off.abs() < 0.01, "frame {frame}: off by {off}");
        }
    }
}

fn bits(sim: &mut Simulation) -> Vec<u64> {
    let cell = report(sim);
    let numbers = cell.strain.iter().chain(&cell.stress).copied().map(f64::to_bits).collect();
    [particle_bits(sim), numbers].concat()
}

/// Bonded grains that follow a stress, a path and a rate; so many that threads share them.
fn crowd() -> Setup {
    let mut setup = triaxial(Law::Hertz, (5e3, 0.5, 0.02));
    let strength = BondStrength::of(2e4, 2e4);
    setup.bonds = vec![Bond { damping: 0.05, strength, gap: 0.003, ..bond((0, 0)) }];
    let shift = |k: u32| Vec3::new(f64::from(k % 4), f64::from(k / 4 % 4), f64::from(k / 16)) * SIDE;
    let one = std::mem::take(&mut setup.particles);
    for k in 0..64u32 {
        let copy = |p: &Particle| Particle { id: p.id + 64 * k, position: p.position + shift(k), ..*p };
        setup.particles.extend(one.iter().map(copy));
    }
    setup.periodic = [Some((0.0, 4.0 * SIDE)); 3];
    setup
}

#[test]
fn same_bits_for_widths_threads_order_and_resume() {
    let look = |sim: &mut Simulation| {
        report(sim);
    };
    let run = Run { setup: &crowd, parts: [&steps(211), &steps(289)], look: &look, bits: &bits };
    let mut shuffled = crowd();
    shuffled.particles.reverse();
    assert!(run.end(Simulation::new(shuffled).expect("sound")) == run.check(), "another order");
}

#[test]
fn what_cannot_be_strained_is_refused() {
    let strained = || triaxial(HOOKE, (1e4, 0.5, 0.1));
    let refused = |change: &dyn Fn(&mut Setup)| {
        let mut setup = strained();
        change(&mut setup);
        Simulation::new(setup).err().map(|e| e.to_string()).unwrap_or_default()
    };
    assert_eq!(refused(&|_| {}), "");
    let gravity = refused(&|s| s.gravity.z = -9.81);
    assert!(gravity.contains("strained has no gravity"), "{gravity}");
    let walls = refused(&|s| s.walls = vec![grainpipe_tests::setups::plane(Vec3::z())]);
    assert!(walls.contains("no walls"), "{walls}");
    let open = refused(&|s| s.periodic[1] = None);
    assert!(open.contains("y is to be strained and is not periodic"), "{open}");
    let mut setup = strained();
    (setup.periodic[1], setup.strain[1]) = (None, None);
    assert_eq!(Simulation::new(setup).err(), Some(SetupError::StrainedOpen { axis: 'y' }));
}

/// A cell that nothing resists is squeezed until a grain would meet itself.
#[test]
fn a_cell_that_gets_too_small_stops() {
    let mut setup = empty(HOOKE, 0.5);
    setup.particles = vec![grain(0, Vec3::repeat(0.05))];
    setup.periodic = [Some((0.0, SIDE)); 3];
    setup.strain = [Some(Strain::Rate(10.0)), None, None];
    let mut sim = Simulation::new(setup).expect("sound");
    let halt = (0..1_000_000).find_map(|_| sim.step().err()).expect("it stops").to_string();
    assert!(halt.contains("the domain is") && halt.contains("along x"), "{halt}");
}
