//! The energy ledger: each term by its own formula.

use crate::bodies::BodyState;
use crate::contacts::{Contacts, Kind, With};
use crate::effects::DISSIPATORS;
use crate::kernel::LEDGER;
use crate::particles::mass;
use crate::setup::{Particle, Setup};
use serde::{Deserialize, Serialize};

/// Energy of one instant, and what has left since the start [J].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Energy {
    /// ½ m v².
    pub translation: f64,
    /// ½ I ω².
    pub rotation: f64,
    /// −m g·x, from the origin.
    pub potential: f64,
    /// In the springs of contacts; negative where cohesion binds.
    pub elastic: f64,
    /// Dissipated by the normal law: its dashpot, and what it takes to part grains that adhere.
    pub normal: f64,
    /// Dissipated by sliding friction, dashpot included.
    pub sliding: f64,
    /// Dissipated by rolling resistance, dashpot included.
    pub rolling: f64,
    /// Dissipated by twisting resistance, dashpot included.
    pub twisting: f64,
    /// Work of moving walls on particles.
    pub walls: f64,
    /// Kinetic energy of particles that fell asleep.
    pub slept: f64,
}

impl Energy {
    /// Everything that was there at the start: constant up to the integrator's error, as long as no particle
    /// enters or leaves.
    pub fn balance(&self) -> f64 {
        self.translation
            + self.rotation
            + self.potential
            + self.elastic
            + self.normal
            + self.sliding
            + self.rolling
            + self.twisting
            + self.slept
            - self.walls
    }

    pub(crate) fn of(
        particles: &[Particle],
        setup: &Setup,
        contacts: &Contacts,
        account: &Account,
    ) -> Energy {
        let mut e = Energy {
            normal: account.dissipated[0],
            sliding: account.dissipated[1],
            rolling: account.dissipated[2],
            twisting: account.dissipated[3],
            walls: account.walls,
            slept: account.slept,
            elastic: contacts.ledger.chunks_exact(LEDGER).map(|row| row[0]).sum(),
            ..Energy::default()
        };
        for p in particles {
            let m = mass(p.radius, setup.materials[p.material as usize].density);
            e.translation += 0.5 * m * p.velocity.norm_squared();
            e.rotation += 0.2 * m * p.radius * p.radius * p.spin.norm_squared();
            e.potential -= m * setup.gravity.dot(&p.position);
        }
        e
    }
}

impl Energy {
    /// Adds a rigid clump: ½ m v², ½ ω·L, −m g·x.
    pub(crate) fn add_body(&mut self, body: &BodyState, setup: &Setup) {
        self.translation += 0.5 * body.mass * body.velocity.norm_squared();
        self.rotation += 0.5 * body.spin.dot(&body.angular_momentum);
        self.potential -= body.mass * setup.gravity.dot(&body.position);
    }
}

/// Sums since the start [J].
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Account {
    dissipated: [f64; DISSIPATORS],
    walls: f64,
    pub(crate) slept: f64,
}

impl Account {
    /// Adds one step's ledger, in its order.
    pub fn add(&mut self, kinds: &[Kind], contacts: &Contacts) {
        for segment in &contacts.segments {
            let places = segment.contacts();
            let rows = &contacts.ledger[places.start * LEDGER..places.end * LEDGER];
            let wall = matches!(kinds[segment.kind].with, With::Wall(_));
            for row in rows.chunks_exact(LEDGER) {
                for (sum, part) in self.dissipated.iter_mut().zip(&row[1..=DISSIPATORS]) {
                    *sum += part;
                }
                if wall {
                    self.walls += row[1 + DISSIPATORS];
                }
            }
        }
    }
}
