//! The energy ledger: each term by its own formula.

use crate::neighbours::contacts::Contacts;
use crate::passes::clumps::instant::BodyState;
use crate::setup::{Particle, Setup};
use crate::state::bonds::Bonds;
use crate::state::energy::Energy;
use crate::state::ledger::{Account, carried, heavy};

impl Energy {
    pub(crate) fn of(
        particles: &[Particle],
        setup: &Setup,
        (contacts, bonds): (&Contacts, &Bonds),
        account: &Account,
    ) -> Energy {
        let mut e = Energy {
            normal: account.dissipated[0] + account.lost,
            sliding: account.dissipated[1],
            rolling: account.dissipated[2],
            twisting: account.dissipated[3],
            bonds: account.by_bonds(),
            walls: account.walls,
            slept: account.slept,
            drag: account.drag,
            entered: account.entered,
            left: account.left,
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
