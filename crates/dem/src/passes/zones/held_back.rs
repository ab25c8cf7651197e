//! How much a cut holds back the stream: what particles in the zone of an outlet push those that are still free, over the momentum of those that pass.
//!
//! Behind the plane of an undivided stream that falls freely hardly anything is pushed; a zone whose particles do not accelerate as those that follow is in
//! their way, and less flows.

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::passes::zones::muted::force_of_passive;
use crate::setup::Crossing;
use crate::state::{Direction, State};

/// Adds one step, whose forces are known, before zones move.
pub fn add(model: &Model, state: &mut State, lists: &NeighbourLists) {
    for n in 0..state.zones.zone_particles.len() {
        let t = &state.zones.zone_particles[n];
        let Direction::Out(outlet) = t.direction else { continue };
        let k = t.at as usize;
        let by_all = state.contacts.sums().on(k, t.start.radius).0;
        let normal = state.zones.outlets[outlet as usize].plane.normal;
        let push = (by_all - force_of_passive(state, lists, k)).dot(&normal);
        state.zones.lost.returned.held_back[outlet as usize].impulse += push * model.dt;
    }
}

/// Counts particle `k`, with all that passes together with it.
pub fn count(state: &mut State, k: usize, crossing: &Crossing) {
    let mass = state.clumps.body_of(k).map_or_else(|| 1.0 / state.particles.rows[k][7], |f| f.mass);
    let speed = crossing.particle.velocity.dot(&state.zones.outlets[crossing.outlet as usize].plane.normal);
    let of = &mut state.zones.lost.returned.held_back[crossing.outlet as usize];
    of.momentum += mass * speed;
    of.passed += 1;
}
