//! Contacts of particles in zones with walls and with each other: they act on nothing, so the ledger books nothing of them.
//!
//! A particle on its way in may come through a wall, one on its way out fall through one. What such a contact holds when its particle becomes
//! free acts from then on, and is brought in with it; what it holds when its particle passes a storage plane is taken along. Both are booked in the
//! middle of a step: half of what the step at its instant did counts on the side where it acts.

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::passes::zones::whole::rows_with;
use crate::setup::Particle;
use crate::state::State;
use geom::Vec3;
use laws::contact::{LEDGER, SlotEnd, WrenchSums};
use laws::effects::DISSIPATORS;

/// Contacts of particle `k` that act on nothing while it is in a zone.
fn passive<'a>(state: &'a State, lists: &'a NeighbourLists, k: usize) -> impl Iterator<Item = SlotEnd> + 'a {
    lists.slots.of_particle(k).iter().copied().filter(move |&end| is_passive(state, lists, end))
}

/// Whether what is at the other end of a contact is a wall, or in a zone.
fn is_passive(state: &State, lists: &NeighbourLists, end: SlotEnd) -> bool {
    let slots = &lists.slots;
    slots.segment_of(end.slot()).with.is_wall() || state.zones.is_prescribed(slots.other(end) as usize)
}

/// Power [W] on particle `k` of a zone, which moves like this, of its contacts that act on nothing.
pub fn power_of_passive(state: &State, lists: &NeighbourLists, k: usize, moving: &Particle) -> f64 {
    passive(state, lists, k).map(|end| power_at(state, end, moving)).sum()
}

/// Force [N] on particle `k` of a zone of its contacts that act on nothing.
pub fn force_of_passive(state: &State, lists: &NeighbourLists, k: usize) -> Vec3 {
    passive(state, lists, k).map(|end| force_at(state, end)).sum()
}

/// Force [N] of a contact on the particle at this end.
pub fn force_at(state: &State, end: SlotEnd) -> Vec3 {
    let force = state.contacts.force(end.slot());
    if end.is_second() { -force } else { force }
}

/// Energy [J] that contact `end` of particle `k` holds half a step before the instant of its row, or after it.
fn held_beside((model, state, lists): Seen, (k, end): (usize, SlotEnd), beside: Beside) -> f64 {
    let row = &state.contacts.ledger[end.slot() * LEDGER..][..LEDGER];
    let gone = row[1..=DISSIPATORS].iter().sum::<f64>();
    let at = |k: usize, end: SlotEnd| power_at(state, end, &moving(model, state, k, beside));
    let mut power = at(k, end);
    if lists.slots.segment_of(end.slot()).with.is_wall() {
        power -= row[1 + DISSIPATORS] / model.dt;
    } else {
        let other = SlotEnd::new(end.slot(), !end.is_second());
        power += at(lists.slots.other(end) as usize, other);
    }
    let half = 0.5 * (gone + power * model.dt);
    row[0] + if beside == Beside::Before { half } else { -half }
}

/// What is looked at.
type Seen<'a> = (&'a Model, &'a State, &'a NeighbourLists);

/// On which side of the instant of the forces.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Beside {
    Before,
    /// Particles have been moved.
    After,
}

/// How particle `k` moves at the instant of the forces.
fn moving(model: &Model, state: &State, k: usize, beside: Beside) -> Particle {
    let p = &state.particles;
    let (a, (spin, angular_acceleration)) = (p.acceleration[k].vector(), p.rotation(k));
    let since = if beside == Beside::After { model.dt } else { 0.0 };
    let (velocity, spin) = (p.rows[k].velocity() - a * since, spin - angular_acceleration * since);
    let (id, material, radius) = (p.id[k], p.material[k], p.rows[k].radius());
    Particle { id, material, radius, position: p.position(k), velocity, spin }
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

/// After forces: takes what acts on nothing out of the ledger's rows, and contacts of those that are out of the calculation: a law that adheres
/// would release what it held at the place where they wait for the next listing.
pub fn mute(model: &Model, state: &mut State, lists: &NeighbourLists) {
    let zones = &state.zones;
    if !model.setup.ledger || (zones.zone_particles.is_empty() && zones.left.is_empty()) {
        return;
    }
    let of_zones = zones.zone_particles.iter().flat_map(|t| passive(state, lists, t.at as usize));
    let of_gone = zones.left.iter().flat_map(|(k, _)| lists.slots.of_particle(*k as usize)).copied();
    let muted: Vec<SlotEnd> = of_zones.chain(of_gone).collect();
    for end in muted {
        state.contacts.ledger[end.slot() * LEDGER..][..LEDGER].fill(0.0);
    }
}

/// Books what contacts hold that act from this instant on, because their particles `starting` have become free.
pub fn bring(model: &Model, state: &mut State, lists: &NeighbourLists, starting: &[u32]) {
    let of = |&k: &u32| -> f64 {
        // A contact of two of them counts once.
        let first = |end: &SlotEnd| {
            let other = lists.slots.other(*end);
            !lists.slots.segment_of(end.slot()).with.is_wall() && other < k && starting.contains(&other)
        };
        let ends = lists.slots.of_particle(k as usize).iter().copied();
        ends.filter(|end| is_passive(state, lists, *end) || first(end))
            .map(|end| held_beside((model, state, lists), (k as usize, end), Beside::Before))
            .sum()
    };
    let brought: f64 = starting.iter().map(of).sum();
    state.ledger.entered += brought;
    state.ledger.passed -= brought;
}

/// Books what contacts hold that no longer act, because particle `k`, with all that passes together with it, has passed a storage plane in the last move.
pub fn take_along(model: &Model, state: &mut State, lists: &NeighbourLists, k: usize) {
    let of = |k: u32| -> f64 {
        let held = |end| held_beside((model, state, lists), (k as usize, end), Beside::After);
        passive(state, lists, k as usize).map(held).sum()
    };
    let taken: f64 = rows_with(state, k).into_iter().map(of).sum();
    state.ledger.left += taken;
    state.ledger.passed += taken;
}

/// Energy [J] that contacts of particle `k`, which leaves, hold in the middle of the last move: of those that act on something, and whose other
/// particle has not left before it.
pub fn held(model: &Model, state: &State, lists: &NeighbourLists, k: usize) -> f64 {
    let slots = &lists.slots;
    let travels = state.zones.is_prescribed(k);
    let of = |&end: &SlotEnd| {
        let wall = slots.segment_of(end.slot()).with.is_wall();
        let gone = !wall && state.zones.is_gone(slots.other(end) as usize);
        let acts = !gone && !(travels && is_passive(state, lists, end));
        if acts { held_beside((model, state, lists), (k, end), Beside::After) } else { 0.0 }
    };
    slots.of_particle(k).iter().map(of).sum()
}
