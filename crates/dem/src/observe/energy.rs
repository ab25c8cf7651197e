//! The energy ledger: each term by its own formula.

use crate::neighbours::contacts::Contacts;
use crate::passes::clumps::instant::BodyState;
use crate::setup::{Particle, Setup};
use crate::state::bonds::Bonds;
use crate::state::energy::Energy;
use crate::state::ledger::{LedgerSums, carried, heavy};

impl Energy {
    pub(crate) fn of(
        particles: &[Particle],
        setup: &Setup,
        (contacts, bonds): (&Contacts, &Bonds),
        ledger: &LedgerSums,
    ) -> Energy {
        let mut e = Energy {
            normal: ledger.dissipated[0] + ledger.lost,
            sliding: ledger.dissipated[1],
            rolling: ledger.dissipated[2],
            twisting: ledger.dissipated[3],
            bonds: ledger.by_bonds(),
            walls: ledger.walls,
            slept: ledger.slept,
            drag: ledger.drag,
            entered: ledger.entered,
            left: ledger.left,
            elastic: if setup.ledger { contacts.elastic() + bonds.elastic() } else { 0.0 },
            ..Energy::default()
        };
        for p in particles {
            let [translation, rotation, potential] = carried(p, setup);
            e.translation += translation;
            e.rotation += rotation;
            e.potential += potential;
        }
        e
    }

    /// Adds a rigid clump: ½ m v², ½ ω·L, −m g·x.
    pub(crate) fn add_body(&mut self, body: &BodyState, setup: &Setup) {
        let material = setup.clumps.shapes[body.shape as usize].material;
        let heavy = heavy(setup, setup.materials[material as usize].density);
        self.translation += 0.5 * body.mass * body.velocity.norm_squared();
        self.rotation += 0.5 * body.spin.dot(&body.angular_momentum);
        self.potential -= body.mass * heavy * setup.gravity.dot(&body.position);
    }
}
