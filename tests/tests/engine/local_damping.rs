//! Local damping against closed forms, and the mean unbalanced force.

use dem::setup::*;
use dem::{Setup, Simulation};
use geom::Vec3;
use grainpipe_tests::same_bits::{Run, particle_bits, steps};
use grainpipe_tests::setups::{
    HOOKE, LAWS, Law, empty, grain, lattice, particles, plane, run_until, with_friction,
};

const K: f64 = 1e4;
const ALPHA: f64 = 0.7;

fn weight() -> f64 {
    dem::mass(0.01, 2500.0) * 9.81
}

/// A grain on a plane that starts `share` of its overlap at rest above its place at rest.
fn resting(share: f64, alpha: Option<f64>) -> Setup {
    let mut setup = empty(HOOKE, 1.0);
    (setup.gravity, setup.local_damping) = (Vec3::z() * -9.81, alpha);
    setup.step = Step::Auto(0.02);
    setup.walls = vec![plane(Vec3::z())];
    setup.particles = vec![grain(1, Vec3::z() * (0.01 - (1.0 - share) * weight() / K))];
    setup
}

/// F_d = −α |F| sign v: a spring is (1 + α) as stiff on the way out, (1 − α) on the way back, so that amplitudes fall by √((1 − α)/(1 + α)).
#[test]
fn amplitudes_fall_as_the_stiffness_of_both_ways() {
    let mut sim = Simulation::new(resting(0.5, Some(ALPHA))).expect("sound");
    let rest = 0.01 - weight() / K;
    let (mut turns, mut before) = (vec![0.5 * weight() / K], -1.0f64);
    while turns.len() < 5 {
        sim.step().expect("within the guards");
        let p = particles(&mut sim)[0];
        if p.velocity.z * before < 0.0 {
            turns.push((p.position.z - rest).abs());
        }
        before = p.velocity.z;
    }
    for pair in turns.windows(2) {
        let (found, wanted) = (pair[1] / pair[0], ((1.0 - ALPHA) / (1.0 + ALPHA)).sqrt());
        assert!((found / wanted - 1.0).abs() < 2e-2, "{found} instead of {wanted}: {turns:?}");
    }
}

/// What moves uniformly is not damped; what falls, falls with (1 − α) g.
#[test]
fn uniform_motion_is_not_damped() {
    let mut setup = with_friction(empty(HOOKE, 0.5), 0.3);
    setup.local_damping = Some(ALPHA);
    setup.particles = vec![grain(1, Vec3::zeros())];
    (setup.particles[0].velocity, setup.particles[0].spin) = (Vec3::new(1.0, -2.0, 0.5), Vec3::z());
    let mut sim = Simulation::new(setup.clone()).expect("sound");
    run_until(&mut sim, 0.1);
    let p = particles(&mut sim)[0];
    assert_eq!((p.velocity, p.spin), (Vec3::new(1.0, -2.0, 0.5), Vec3::z()));
    setup.gravity = Vec3::z() * -9.81;
    setup.particles[0].velocity = Vec3::zeros();
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, 0.1);
    let p = particles(&mut sim)[0];
    let wanted = -(1.0 - ALPHA) * 9.81 * sim.time();
    // The first step has no velocity yet.
    assert!((p.velocity.z / wanted - 1.0).abs() < 1e-2, "{} instead of {wanted}", p.velocity.z);
}

/// A clump is damped as one body: it falls with (1 − α) g, and turns uniformly without a moment.
#[test]
fn a_clump_is_damped_as_a_whole() {
    let mut setup = empty(HOOKE, 0.5);
    (setup.gravity, setup.local_damping) = (Vec3::z() * -9.81, Some(ALPHA));
    let spheres = [(Vec3::x() * -0.008, 0.01), (Vec3::x() * 0.012, 0.006)];
    let shape = ClumpShape::new("pear", 0, &spheres, &geom::Moments::of_sum(&spheres));
    let (orientation, spin) = (nalgebra::UnitQuaternion::identity(), Vec3::x() * 3.0);
    let (position, velocity) = (Vec3::z(), Vec3::zeros());
    let placed = vec![Body { id: 1, shape: 0, scale: 1.0, position, orientation, velocity, spin }];
    setup.clumps = Clumps { shapes: vec![shape], placed, entries: vec![] };
    let mut sim = Simulation::new(setup).expect("sound");
    run_until(&mut sim, 0.1);
    let clump = sim.clumps().expect("sound")[0];
    let wanted = -(1.0 - ALPHA) * 9.81 * sim.time();
    assert!((clump.velocity.z / wanted - 1.0).abs() < 1e-2, "{} instead of {wanted}", clump.velocity.z);
    assert!((clump.spin - spin).norm() < 1e-12, "{:?}", clump.spin);
}

/// A clump of one sphere moves as that sphere does, from the very first step: it falls obliquely onto a plane that it touches at the start.
#[test]
fn a_clump_of_one_sphere_moves_as_the_sphere() {
    let of = |is_clump: bool| {
        let mut setup = with_friction(empty(HOOKE, 0.5), 0.3);
        (setup.gravity, setup.local_damping, setup.ledger) = (Vec3::z() * -9.81, Some(ALPHA), true);
        setup.walls = vec![plane(Vec3::z())];
        let (position, velocity, spin) = (Vec3::z() * 0.00999, Vec3::new(0.3, 0.1, -0.2), Vec3::y() * 5.0);
        if is_clump {
            let spheres = [(Vec3::zeros(), 0.01)];
            let shape = ClumpShape::new("ball", 0, &spheres, &geom::Moments::of_sum(&spheres));
            let orientation = nalgebra::UnitQuaternion::identity();
            let placed = vec![Body { id: 1, shape: 0, scale: 1.0, position, orientation, velocity, spin }];
            setup.clumps = Clumps { shapes: vec![shape], placed, entries: vec![] };
        } else {
            setup.particles = vec![Particle { velocity, spin, ..grain(1, position) }];
        }
        Simulation::new(setup).expect("sound")
    };
    let [mut ball, mut clump] = [false, true].map(of);
    let start = clump.energy().expect("sound").balance();
    for step in 0..400 {
        let (a, b) = (particles(&mut ball)[0], particles(&mut clump)[0]);
        let error = (a.velocity - b.velocity).norm() + 0.01 * (a.spin - b.spin).norm();
        assert!(error < 1e-12 && (a.position - b.position).norm() < 1e-14, "step {step}: {error:e} m/s");
        let energy = clump.energy().expect("sound");
        let off = (energy.balance() - start) / energy.translation.max(energy.exchanged());
        assert!(off.abs() < 1e-12, "step {step}: {off:e}");
        [&mut ball, &mut clump].into_iter().for_each(|sim| sim.step().expect("within the guards"));
    }
}

/// A heap of 60 grains of two sizes that falls on a plane.
fn heap(law: Law) -> Setup {
    let mut setup = with_friction(empty(law, 0.5), 0.4);
    setup.contacts.iter_mut().for_each(|c| c.set("rolling_resistance", 0.1));
    (setup.gravity, setup.local_damping, setup.ledger) = (Vec3::z() * -9.81, Some(ALPHA), true);
    setup.step = Step::Auto(0.3);
    setup.walls = vec![plane(Vec3::z())];
    setup.particles = lattice([4, 5, 3], Vec3::new(0.0, 0.0, 0.05));
    for p in &mut setup.particles {
        p.radius = if p.id % 3 == 0 { 0.0085 } else { 0.01 };
        p.position.x += 1e-4 * f64::from(p.id % 7);
    }
    setup
}

/// The ledger closes with a term for it.
#[test]
fn its_energy_is_in_the_ledger() {
    for law in LAWS {
        let mut sim = Simulation::new(heap(law)).expect("sound");
        let start = sim.energy().expect("sound").balance();
        for time in [0.05, 0.1, 0.3] {
            run_until(&mut sim, time);
            let e = sim.energy().expect("sound");
            let of = e.exchanged() + e.translation;
            println!(
                "{law:?} {time}: {:e}, made {:e}, {e:?}",
                (e.balance() - start) / of,
                e.integration / of
            );
            assert!(((e.balance() - start) / of).abs() < 1e-10, "{law:?}: {e:?}");
            assert!(e.integration.abs() / of < 1e-3, "{law:?}: {e:?}");
            assert!(e.local_damping > 0.1 * of, "{law:?}: {e:?}");
        }
    }
}

#[test]
fn same_bits_for_widths_threads_and_resumed_runs() {
    let look = |sim: &mut Simulation| {
        sim.unbalanced().expect("sound");
    };
    let setup = || heap(Law::Hertz);
    Run { setup: &setup, parts: [&steps(1700), &steps(1300)], look: &look, bits: &particle_bits }.check();
}

/// One grain that overlaps a plane by half of what its weight needs: |k δ − m g|/k δ = 1; at rest 0; in the air there is none.
#[test]
fn unbalanced_force_of_one_grain() {
    let mut half = Simulation::new(resting(0.5, None)).expect("sound");
    let found = half.unbalanced().expect("sound").expect("a contact");
    assert!((found - 1.0).abs() < 1e-9, "{found}");
    let found = Simulation::new(resting(0.0, None)).expect("sound").unbalanced().expect("sound");
    assert!(found.expect("a contact") < 1e-9, "{found:?}");
    let found = Simulation::new(resting(1.5, None)).expect("sound").unbalanced().expect("sound");
    assert_eq!(found, None);
}

/// A heap comes to a mean unbalanced force of 1e-5 of the mean contact force.
#[test]
fn heap_comes_to_rest() {
    let mut sim = Simulation::new(heap(HOOKE)).expect("sound");
    let mut found = 1.0;
    while found > 1e-5 && sim.time() < 5.0 {
        (0..200).for_each(|_| sim.step().expect("within the guards"));
        found = sim.unbalanced().expect("sound").unwrap_or(1.0);
    }
    println!("{found:e} at {} s", sim.time());
    assert!(found <= 1e-5, "{found}");
}
