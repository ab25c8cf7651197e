//! Looking at a simulation: particles, clumps and energy of this instant. Nothing that is looked at changes.

use crate::kernel::sums::WrenchSums;
use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::passes::instant::{Instant, instant};
use crate::passes::ledger::close_step;
use crate::passes::zones::ledger::energy_of_idle;
use crate::setup::Particle;
use crate::state::State;
use crate::state::energy::Energy;
use geom::Vec3;
use std::collections::BTreeSet;

/// All particles at one instant, by id.
pub struct Snapshot<'a> {
    model: &'a Model,
    state: &'a State,
    loads: WrenchSums<'a>,
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
    let mut energy = Energy::of(&particles, &model.setup, (&lists.contacts, &state.bonds), &state.ledger);
    bodies.iter().for_each(|b| energy.add_body(b, &model.setup));
    if model.setup.ledger {
        let held = energy_of_idle(model, state, lists);
        energy.elastic -= held;
        energy.left += held;
        close_step(model, state, lists, &mut energy);
    }
    energy
}
