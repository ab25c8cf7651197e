//! What the springs of a contact hold when it ends is dissipated by their effects, not made by the step.

use dem::setup::*;
use dem::{Simulation, mass};
use geom::Vec3;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::{LAWS, empty, grain, plane, run_until, with_friction};

const BOOKED: Case = case(
    "Energy",
    "oblique impact that sticks until it ends, e = 1: energy created by the step, over that of the throw",
);

/// A grain thrown at 45° at a floor that it cannot slide on: its tangential spring is stretched when contact ends.
#[test]
fn a_spring_that_is_stretched_when_contact_ends_is_booked_as_sliding() {
    for law in LAWS {
        let mut setup = with_friction(empty(law, 1.0), 1e3);
        (setup.ledger, setup.step, setup.walls) = (true, Step::Auto(0.02), vec![plane(Vec3::z())]);
        let velocity = Vec3::new(1.0, 0.0, -1.0);
        setup.particles = vec![Particle { velocity, ..grain(1, Vec3::new(0.0, 0.0, 0.0101)) }];
        let mut sim = Simulation::new(setup).expect("sound");
        run_until(&mut sim, 0.02);
        let (e, start) = (sim.energy().expect("sound"), 0.5 * mass(0.01, 2500.0) * 2.0);
        assert!(e.elastic == 0.0, "{law:?}: contact has ended");
        assert!(e.sliding > 5e-3 * start, "{law:?}: {} J of {start} J", e.sliding);
        assert!(
            (start - e.translation - e.rotation - e.sliding - e.normal).abs() < 2e-3 * start,
            "{law:?}: {e:?}"
        );
        BOOKED.within(&format!("{law:?}"), e.integration / start, "–", 2e-3);
    }
}
