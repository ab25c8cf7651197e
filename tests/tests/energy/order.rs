//! What the finite step makes falls with the step.

use crate::scenes::poured;
use dem::setup::*;
use dem::{Setup, Simulation};
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::normals::{NORMALS, Normal};
use grainpipe_tests::setups::{bond, lattice, run_until};

const ORDER: Case =
    case("Energy", "energy created by the finite step, over the energy exchanged, falls with the step");

/// A grain that spins falls on a floor and bounces.
fn dropped(normal: &Normal, rubs: bool) -> Setup {
    let mut setup = Setup { sampling: Sampling::Sampled, ..poured(normal) };
    setup.particles.truncate(1);
    let p = &mut setup.particles[0];
    (p.position, p.velocity) = (Vec3::new(0.0, 0.0, 0.03), Vec3::new(0.1, 0.0, 0.0));
    p.spin = Vec3::new(3.0, -2.0, 10.0);
    if !rubs {
        let plain = normal.setup(1.0).contacts;
        setup.contacts = plain;
    }
    setup
}

/// Root of the mean square over phases of the first touch within a step: one impact alone may be lucky.
fn made(setup: &Setup, safety: f64) -> f64 {
    let phases = 16;
    let of = |phase: u32| {
        let mut setup = Setup { step: Step::Auto(safety), ..setup.clone() };
        // It falls at 0.6 m/s: some steps of any size here.
        setup.particles[0].position.z += 4e-4 * f64::from(phase) / f64::from(phases);
        let mut sim = Simulation::new(setup).expect("the setup is sound");
        run_until(&mut sim, 0.15);
        let e = sim.energy().expect("sound");
        (e.integration / e.exchanged().max(e.translation)).powi(2)
    };
    ((0..phases).map(of).sum::<f64>() / f64::from(phases)).sqrt()
}

/// Two bonded grains that swing against each other in every way, without loss: the largest change of energy.
#[test]
fn what_the_step_makes_of_a_bond_falls_with_its_square() {
    let made = |safety: f64| {
        let mut setup = poured(&NORMALS[0]);
        (setup.gravity, setup.walls) = (Vec3::zeros(), vec![]);
        (setup.bonds, setup.particles) = (vec![bond((0, 0))], lattice([2, 1, 1], Vec3::zeros()));
        for (p, sign) in setup.particles.iter_mut().zip([1.0, -1.0]) {
            p.velocity = Vec3::new(0.3, 0.2, 0.1) * sign * 0.03;
            p.spin = Vec3::new(0.5, -0.2, 0.4) * sign + Vec3::new(0.3, 0.2, 0.1);
        }
        setup.step = Step::Auto(safety);
        let mut sim = Simulation::new(setup).expect("the setup is sound");
        let of = |sim: &mut Simulation| sim.energy().expect("sound");
        let start = of(&mut sim).translation;
        let mut most = 0.0f64;
        for _ in 0..(1000.0 / safety) as u64 {
            sim.step().expect("no guard trips");
            most = most.max((of(&mut sim).integration / start).abs());
        }
        most
    };
    let points = [0.4, 0.2, 0.1, 0.05].map(|safety| (safety, made(safety)));
    ORDER.order("a bonded pair, elastic", &points, 2.0, 0.3);
}

/// Hooke's force has no jump but that of its dashpot; friction on a Hertzian contact sets in with a stiffness that rises from nothing,
/// and JKR's contact is made with a jump of the force within a step: of first order.
#[test]
fn what_the_step_makes_falls_at_the_order_of_the_law() {
    let orders = [(2.0, 2.0), (2.0, 1.0), (1.0, 1.0), (2.0, 2.0), (2.0, 1.0)];
    for (normal, (elastic, damped)) in NORMALS.iter().zip(orders) {
        for (name, rubs, order) in
            [("elastic", false, elastic), ("damped, rubbing, rolling, twisting", true, damped)]
        {
            let setup = dropped(normal, rubs);
            let points = [0.4, 0.2, 0.1, 0.05, 0.025].map(|safety| (safety, made(&setup, safety)));
            ORDER.order(&format!("{}, {name}", normal.name), &points, order, 0.3);
        }
    }
}
