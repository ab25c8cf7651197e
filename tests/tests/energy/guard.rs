//! Energy without work stops a run.

use crate::scenes::poured;
use dem::setup::*;
use dem::{Halt, Simulation};
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::normals::NORMALS;
use scene::advice::explain_halt;
use scene::advice::explain_setup_error;

const STOPS: Case = case("Guards", "energy from nothing stops a run");

/// Grains that bounce without loss, in a step that is allowed but coarse: the energy gained is reported, and the state is finite.
#[test]
fn energy_without_work_stops_a_run() {
    let mut setup = poured(&NORMALS[0]);
    let mut plain = NORMALS[0].setup(1.0);
    std::mem::swap(&mut setup.contacts, &mut plain.contacts);
    (setup.step, setup.sampling) = (Step::Auto(1.0), Sampling::Sampled);
    let run = |energy: f64| {
        let mut setup = setup.clone();
        setup.guards.energy = energy;
        let mut sim = Simulation::new(setup).expect("sound");
        let halt = (0..20_000).find_map(|_| sim.step().err());
        (halt, sim)
    };
    let (halt, mut sim) = run(0.01);
    let halt = halt.expect("stopped");
    assert!(matches!(halt, Halt::Energy { .. }), "{halt}");
    STOPS.refused(
        "hooke, e = 1, at the critical step",
        &explain_halt(&halt),
        &["guards.energy", "smaller time.safety", "J"],
    );
    assert!(sim.particles().expect("sound").iter().all(|p| p.velocity.norm().is_finite()));
    assert!(run(1e3).0.is_none(), "a wide limit lets it run");
    // One ball that bounces without loss, in steps that resolve it: what the step gives and takes within an impact is no gain.
    for safety in [0.02, 0.1, 0.5] {
        let mut setup = setup.clone();
        setup.particles.truncate(1);
        setup.step = Step::Auto(safety);
        setup.guards.energy = 0.05;
        let mut sim = Simulation::new(setup).expect("sound");
        let halt = (0..(2000.0 / safety) as u32).find_map(|_| sim.step().err());
        assert!(halt.is_none(), "safety {safety}: {halt:?}");
    }
    // A limit without the ledger that it needs.
    setup.ledger = false;
    setup.guards.energy = 0.01;
    let error = explain_setup_error(&Simulation::new(setup).err().expect("refused"));
    STOPS.refused("without a ledger", &error, &["guards.energy", "ledger"]);
}
