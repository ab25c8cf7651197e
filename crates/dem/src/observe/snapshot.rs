//! Looking at a simulation: particles, clumps and energy of this instant. Nothing that is looked at changes.

use crate::kernel::sums::Loads;
use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::observe::energy::Energy;
use crate::passes::drag::body_acceleration;
use crate::passes::ledger::{close_step, driven};
use crate::passes::zones::ledger::held_by_idle;
use crate::setup::Particle;
use crate::state::State;
use crate::state::ledger::Driven;
use geom::Vec3;
use std::collections::BTreeSet;

/// What a particle does at this instant.
struct Instant {
    velocity: Vec3,
    spin: Vec3,
    acceleration: [f64; 3],
    turning: [f64; 3],
}

/// All particles at one instant, by id.
pub struct Snapshot<'a> {
    model: &'a Model,
    state: &'a State,
    loads: Loads<'a>,
    /// Velocity and spin of those that are members of clumps.
    members: Vec<Option<(Vec3, Vec3)>>,
    order: Vec<u32>,
}

impl<'a> Snapshot<'a> {
    /// Of an instant whose forces are known.
    pub(crate) fn new(model: &'a Model, state: &'a State, lists: &'a NeighbourLists) -> Snapshot<'a> {
        let (p, loads) = (&state.particles, lists.contacts.sums());
        let members = state.bodies.member_states(p, &loads, &model.setup, model.dt);
        // All at once: a list that grows takes twice its length, beside the largest state there is.
        let (hidden, mut order) = (state.zones.hidden(state.time()), Vec::with_capacity(p.len()));
        order.extend((0..p.len() as u32).filter(|&k| !hidden(k as usize)));
        drop(hidden);
        order.sort_unstable_by_key(|&k| p.id[k as usize]);
        Snapshot { model, state, loads, members, order }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.order.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// State of the one after `n` others.
    ///
    /// # Panics
    /// Where there are not so many.
    pub fn particle(&self, n: usize) -> Particle {
        let (k, p) = (self.order[n] as usize, &self.state.particles);
        let Instant { velocity, spin, .. } = instant(self.model, self.state, k, &self.loads);
        let (velocity, spin) = self.members.get(k).copied().flatten().unwrap_or((velocity, spin));
        Particle {
            id: p.id[k],
            material: p.material[k],
            radius: p.rows[k][3],
            position: self.model.wrapped(p.position(k)),
            velocity,
            spin,
        }
    }
}

/// Particles in the calculation, by id, with velocities of this instant, whose forces are known.
pub fn particles(model: &Model, state: &State, lists: &NeighbourLists) -> Vec<Particle> {
    let seen = Snapshot::new(model, state, lists);
    (0..seen.len()).map(|n| seen.particle(n)).collect()
}

/// Corrects what was predicted for particle `k`, whose loads are those of this instant.
fn instant(model: &Model, state: &State, k: usize, loads: &Loads) -> Instant {
    let p = &state.particles;
    let row = &p.rows[k];
    let (free, half) = (!state.zones.travels(k), 0.5 * model.dt);
    let body = body_acceleration(model, state, k);
    let (force, moment) = loads.on(k, row[3]);
    let mut at = Instant {
        velocity: Vec3::new(row[4], row[5], row[6]),
        spin: Vec3::zeros(),
        acceleration: [0.0; 3],
        turning: [0.0; 3],
    };
    for a in 0..3 {
        at.acceleration[a] = force[a] * row[7] + body[a];
        if free {
            at.velocity[a] += half * (at.acceleration[a] - p.acceleration[k][a]);
        }
        if p.rotates() {
            at.spin[a] = p.spins[k][a];
            at.turning[a] = moment[a] * (2.5 * row[7] / (row[3] * row[3]));
            if free {
                at.spin[a] += half * (at.turning[a] - p.turning[k][a]);
            }
        }
    }
    at
}

/// What drives particle `k` at this instant.
pub fn driven_now(model: &Model, state: &State, k: usize, loads: &Loads) -> Driven {
    let Instant { velocity, spin, acceleration, turning } = instant(model, state, k, loads);
    Driven { velocity, spin, ..driven(model, state, k, acceleration, turning) }
}

/// Energy of this instant [J]; elastic and dissipated parts only when the setup asked for the ledger.
pub fn energy(model: &Model, state: &State, lists: &NeighbourLists) -> Energy {
    let (mut particles, mut bodies) =
        (particles(model, state, lists), state.bodies.states(model, state, lists));
    if !state.zones.none() {
        let all = 0..state.particles.len();
        let travelling: BTreeSet<u32> =
            all.filter(|&k| state.zones.travels(k)).map(|k| state.particles.id[k]).collect();
        particles.retain(|p| !travelling.contains(&p.id));
        bodies.retain(|b| !travelling.contains(&b.id));
    }
    let body_of = |id: u32| bodies[..bodies.partition_point(|b| b.id <= id)].last();
    particles.retain(|p| !body_of(p.id).is_some_and(|b| b.has(p.id)));
    let mut energy = Energy::of(&particles, &model.setup, (&lists.contacts, &state.bonds), &state.account);
    bodies.iter().for_each(|b| energy.add_body(b, &model.setup));
    if model.setup.ledger {
        let held = held_by_idle(model, state, lists);
        energy.elastic -= held;
        energy.left += held;
        close_step(model, state, lists, &mut energy);
    }
    energy
}
