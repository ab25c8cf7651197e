//! Contacts of particles on their way in with walls and with each other: they act on nothing, so the ledger books nothing of them.
//!
//! Such a particle may come through a wall. What its contacts hold when it becomes free acts from then on, and is brought in with it. A contact begins to
//! count in the middle of its step: half of what the step has booked of it is taken back.

use crate::effects::DISSIPATORS;
use crate::kernel::{LEDGER, SlotEnd, WrenchSums};
use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::setup::Particle;
use crate::state::{Direction, State};
use std::collections::BTreeSet;

/// Particles on their way in.
pub struct Entering(BTreeSet<u32>);

impl Entering {
    /// Those of now.
    pub fn now(state: &State) -> Entering {
        let is_in = |d: Direction| matches!(d, Direction::In(_));
        Entering(state.zones.zone_particles.iter().filter(|t| is_in(t.direction)).map(|t| t.at).collect())
    }

    /// Contacts of particle `k`, which is one of them or was until now, that act on nothing.
    fn contacts<'a>(&'a self, lists: &'a NeighbourLists, k: usize) -> impl Iterator<Item = SlotEnd> + 'a {
        let slots = &lists.slots;
        let with_wall = |end: SlotEnd| slots.segment_of(end.slot()).with.is_wall();
        slots
            .of_particle(k)
            .iter()
            .copied()
            .filter(move |&end| with_wall(end) || self.0.contains(&slots.other(end)))
    }

    /// Power [W] on particle `k`, which moves like this, of those contacts.
    pub fn power(&self, state: &State, lists: &NeighbourLists, k: usize, moving: &Particle) -> f64 {
        self.contacts(lists, k).map(|end| power_at(state, end, moving)).sum()
    }
}

/// Power [W] of one contact on the particle at this end.
fn power_at(state: &State, end: SlotEnd, moving: &Particle) -> f64 {
    let contacts = &state.contacts;
    let all = WrenchSums { first: 0, layout: contacts.layout, sums: contacts.wrenches.slices() };
    let (force, moment) = all.on(end.slot(), moving.radius);
    if !end.is_second() {
        return force.dot(&moving.velocity) + moment.dot(&moving.spin);
    }
    // Of the second particle the torque is the opposite one, and the moment of the tangential force the same.
    let torque = all.on(end.slot(), 0.0).1;
    (moment - torque * 2.0).dot(&moving.spin) - force.dot(&moving.velocity)
}

/// After forces: takes what acts on nothing out of the ledger's rows.
pub fn mute(model: &Model, state: &mut State, lists: &NeighbourLists) {
    if !model.setup.ledger || state.zones.zone_particles.is_empty() {
        return;
    }
    let entering = Entering::now(state);
    for &k in &entering.0 {
        for end in entering.contacts(lists, k as usize) {
            state.contacts.ledger[end.slot() * LEDGER..][..LEDGER].fill(0.0);
        }
    }
}

/// Books what contacts hold that act from this instant on, because their particles `starting` have become free.
pub fn bring(model: &Model, state: &mut State, lists: &NeighbourLists, starting: &[u32]) {
    let mut entering = Entering::now(state);
    let mut brought = 0.0;
    let p = &state.particles;
    // In turn: a contact of two of them counts once.
    entering.0.extend(starting);
    for &k in starting {
        entering.0.remove(&k);
        for end in entering.contacts(lists, k as usize) {
            let row = &state.contacts.ledger[end.slot() * LEDGER..][..LEDGER];
            let gone = row[1..=DISSIPATORS].iter().sum::<f64>();
            let surface =
                if lists.slots.segment_of(end.slot()).with.is_wall() { row[1 + DISSIPATORS] } else { 0.0 };
            brought += row[0] + 0.5 * (gone - surface);
        }
    }
    entering.0.extend(starting);
    for &k in starting {
        let k = k as usize;
        let (id, material, radius) = (p.id[k], p.material[k], p.rows[k][3]);
        let (position, velocity, spin) = (p.position(k), p.rows[k].velocity(), p.rotation(k).0);
        let moving = Particle { id, material, radius, position, velocity, spin };
        brought += 0.5 * model.dt * entering.power(state, lists, k, &moving);
    }
    state.ledger.entered += brought;
    state.ledger.passed -= brought;
}
