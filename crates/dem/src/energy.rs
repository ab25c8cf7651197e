//! The energy ledger: each term by its own formula.

use crate::bodies::BodyState;
use crate::contacts::{Contacts, Kind, With};
use crate::effects::DISSIPATORS;
use crate::kernel::LEDGER;
use crate::particles::mass;
use crate::setup::{Particle, Setup};
use serde::{Deserialize, Serialize};

/// Energy of one instant, of the particles that are free, and what has come and gone since the start [J].
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
    /// Taken by the fluid.
    pub drag: f64,
    /// Brought by particles that became free at a calculation plane, and work of those before it.
    pub entered: f64,
    /// Taken along by particles that passed a storage plane, and work on those behind it.
    pub left: f64,
}

impl Energy {
    /// Everything that was there at the start: constant up to the integrator's error.
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
            + self.drag
            + self.left
            - self.walls
            - self.entered
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
            drag: account.drag,
            entered: account.entered,
            left: account.left,
            elastic: contacts.ledger.chunks_exact(LEDGER).map(|row| row[0]).sum(),
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
}

impl Energy {
    /// Adds a rigid clump: ½ m v², ½ ω·L, −m g·x.
    pub(crate) fn add_body(&mut self, body: &BodyState, setup: &Setup) {
        self.translation += 0.5 * body.mass * body.velocity.norm_squared();
        self.rotation += 0.5 * body.spin.dot(&body.angular_momentum);
        self.potential -= body.mass * setup.gravity.dot(&body.position);
    }
}

/// Translation, rotation, potential of a particle [J]; what a fluid displaced lifts is no longer heavy.
pub(crate) fn carried(p: &Particle, setup: &Setup) -> [f64; 3] {
    let density = setup.materials[p.material as usize].density;
    let m = mass(p.radius, density);
    let heavy = 1.0 - setup.drag.map_or(0.0, |d| d.lift(density));
    [
        0.5 * m * p.velocity.norm_squared(),
        0.2 * m * p.radius * p.radius * p.spin.norm_squared(),
        -m * heavy * setup.gravity.dot(&p.position),
    ]
}

/// Sums since the start [J].
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Account {
    dissipated: [f64; DISSIPATORS],
    walls: f64,
    pub(crate) slept: f64,
    pub(crate) drag: f64,
    pub(crate) entered: f64,
    pub(crate) left: f64,
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
