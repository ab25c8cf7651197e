//! The ledger of zones: the work of contacts on zone particles goes in or out, because nothing acts on these.

use crate::kernel::{LEDGER, SlotEnd};
use crate::model::Model;
use crate::neighbours::{NeighbourLists, Segment};
use crate::passes::zones::muted::Entering;
use crate::setup::Particle;
use crate::state::{Direction, State};

/// The ledger of one step, before the zones move.
pub fn add_zones(model: &Model, state: &mut State, lists: &NeighbourLists) {
    let (now, entering) = (state.time(), Entering::now(state));
    for t in &state.zones.zone_particles {
        let flow = t.flow(now, &state.zones, &model.setup);
        let moving = Particle { velocity: flow.velocity, spin: flow.spin, ..t.start };
        let k = t.at as usize;
        let muted = match t.direction {
            Direction::In(_) => entering.power(state, lists, k, &moving),
            Direction::Out(_) => 0.0,
        };
        let work = (power(state, k, &moving) - muted) * model.dt;
        state.ledger.passed += work;
        match t.direction {
            Direction::In(_) => state.ledger.entered -= work,
            Direction::Out(_) => state.ledger.left += work,
        }
    }
}

/// Of the contacts of particle `k` on it [W], in the step before the last move.
pub fn power(state: &State, k: usize, moving: &Particle) -> f64 {
    let (force, moment) = state.contacts.sums().on(k, moving.radius);
    force.dot(&moving.velocity) + moment.dot(&moving.spin)
}

/// The same for particle `k`, or for a member of the clump that moves like this about its centre.
pub fn power_of_member(state: &State, k: usize, whole: &Particle) -> f64 {
    let r = state.clumps.arm(k);
    let velocity = whole.velocity + whole.spin.cross(&r);
    power(state, k, &Particle { radius: state.particles.rows[k][3], velocity, ..*whole })
}

/// Elastic energy [J] of the contacts that act on no particle.
pub fn energy_of_idle(state: &State, lists: &NeighbourLists) -> f64 {
    if state.zones.none() {
        return 0.0;
    }
    let of = |s: &Segment| -> f64 {
        let idle = |slot: &usize| state.zones.is_idle(lists.slots.ends(s, *slot));
        s.contacts().filter(idle).map(|slot| state.contacts.ledger[slot * LEDGER]).sum()
    };
    lists.slots.segments.iter().map(of).sum()
}

/// Elastic energy [J] of the contacts of particle `k` with those that have not left before it.
pub fn held(state: &State, lists: &NeighbourLists, k: usize) -> f64 {
    let slots = &lists.slots;
    let of = |&end: &SlotEnd| {
        let slot = end.slot();
        let wall = slots.segment_of(slot).with.is_wall();
        let gone = !wall && state.zones.is_gone(slots.other(end) as usize);
        if gone { 0.0 } else { state.contacts.ledger[slot * LEDGER] }
    };
    slots.of_particle(k).iter().map(of).sum()
}
