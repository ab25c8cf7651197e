//! Kinetic + potential + elastic + dissipated − work of walls − what the finite step made = constant, to rounding.

use crate::scenes::all;
use dem::Simulation;
use grainpipe_tests::findings::{Case, case};
use grainpipe_tests::setups::run_until;

const CLOSES: Case = case("Energy", "the ledger closes, relative to the energy exchanged, at dt = auto");
const MADE: Case =
    case("Energy", "energy created by the finite step, over the energy exchanged, at dt = auto");

/// In the middle of motion, and at the end. Besides rounding the turn of a clump with three moments of inertia is left, and what stops when a particle falls asleep, which
/// [`dem::Energy::integration`] does not follow.
#[test]
fn the_ledger_closes_and_the_step_makes_little() {
    for scene in all() {
        let bonded = !scene.setup.bonds.is_empty();
        let exact = scene.setup.clumps.shapes.is_empty() && scene.setup.sleep.is_none();
        let limit = if exact { 1e-10 } else { 1e-6 };
        let mut sim = Simulation::new(scene.setup).unwrap_or_else(|e| panic!("{}: {e}", scene.name));
        scene.entries.into_iter().for_each(|e| sim.enter(e).expect("in time"));
        let start = sim.energy().expect("sound").balance();
        for share in [0.37, 0.61, 1.0] {
            run_until(&mut sim, share * scene.until);
            let e = sim.energy().expect("sound");
            let of = e.exchanged() + e.translation;
            assert!(of > 1e-3, "{}: something happens: {e:?}", scene.name);
            assert_eq!(bonded, e.bonds != 0.0, "{}: {e:?}, {:?} bonds", scene.name, sim.bond_count());
            CLOSES.within(&scene.name, (e.balance() - start) / of, "–", limit);
            MADE.within(&scene.name, e.integration / of, "–", 1e-2);
        }
    }
}
