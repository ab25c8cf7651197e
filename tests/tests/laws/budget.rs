//! The energy of many grains that rub.

use crate::simulation;
use dem::setup::*;
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{LAWS, empty, grain, plane, run_until, with_friction};

const BUDGET: Case = case(
    "Many grains",
    "kinetic + potential + elastic + dissipated − work of walls is kept: 60 grains in a shaken box, 0.05 of the critical step",
);

/// Kinetic + potential + elastic + dissipated − work of walls stays the same: grains dropped into a box on a shaking floor.
#[test]
fn energy_budget_closes() {
    for law in LAWS {
        let mut setup = with_friction(empty(law, 0.5), 0.3);
        setup.contacts.iter_mut().for_each(|c| c.rolling_resistance = Some(0.05));
        setup.gravity.z = -9.81;
        setup.ledger = true;
        setup.walls = vec![plane(Vec3::z())];
        setup.walls[0].motion.amplitude = Vec3::new(0.001, 0.0, 0.002);
        setup.walls[0].motion.frequency = 20.0;
        let offset = |k: u32| 0.001 * ((k * 7919) % 13) as f64;
        setup.particles = (0..60)
            .map(|k| {
                grain(
                    k,
                    Vec3::new(
                        0.034 * (k % 4) as f64 + offset(k),
                        0.034 * (k / 4 % 3) as f64 + offset(k + 5),
                        0.03 + 0.034 * (k / 12) as f64,
                    ),
                )
            })
            .collect();
        let closing = |safety: f64| {
            let mut setup = setup.clone();
            setup.step = Step::Auto(safety);
            let mut sim = simulation(setup);
            let start = sim.energy().expect("sound").balance();
            run_until(&mut sim, 0.3);
            let e = sim.energy().expect("sound");
            let exchanged = e.normal + e.sliding + e.rolling + e.walls.abs();
            assert!(e.normal > 0.0 && e.sliding > 0.0 && e.rolling > 0.0 && e.walls != 0.0, "{e:?}");
            (e.balance() - start).abs() / exchanged
        };
        let fine = closing(0.05);
        BUDGET.within(&format!("{law:?}"), fine, "of what was exchanged", 1e-9);
    }
}
