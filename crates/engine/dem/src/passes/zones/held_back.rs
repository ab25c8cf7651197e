//! How much a cut holds back the stream: what particles behind the plane of an outlet push those that have not crossed it, over the momentum of those that pass.
//!
//! Behind the plane of an undivided stream that falls freely hardly anything is pushed; a zone whose particles do not accelerate as those that follow is in
//! their way, and less flows. Particles that stay free in the zone push as those of the undivided stream do, as far as the zone reaches.

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::passes::zones::idle_contacts::{force_at, force_of_passive};
use crate::passes::zones::whole::rows_with;
use crate::setup::Crossing;
use crate::state::{Direction, State};
use geom::Vec3;

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
    for outlet in 0..state.zones.outlets.len() {
        if !state.zones.crossed[outlet].is_empty() {
            let push =
                force_of_followers(state, lists, outlet).dot(&state.zones.outlets[outlet].plane.normal);
            state.zones.lost.returned.held_back[outlet].impulse += push * model.dt;
        }
    }
}

/// Force [N] on those that have crossed an outlet and are free, of those that have not.
fn force_of_followers(state: &State, lists: &NeighbourLists, outlet: usize) -> Vec3 {
    let (crossed, id) = (&state.zones.crossed[outlet], |k: usize| state.particles.id[k]);
    let first = state.zones.near[outlet].iter().map(|&k| k as usize).filter(|&k| crossed.contains(&id(k)));
    let members = first.flat_map(|k| rows_with(state, k));
    let follows = |other: usize| {
        let first = rows_with(state, other)[0] as usize;
        state.zones.is_free(first) && !crossed.contains(&id(first))
    };
    let on = |k: u32| -> Vec3 {
        let ends = lists.slots.of_particle(k as usize).iter();
        let of_others = ends.filter(|end| !lists.slots.segment_of(end.slot()).with.is_wall());
        of_others
            .filter(|end| follows(lists.slots.other(**end) as usize))
            .map(|&end| force_at(state, end))
            .sum()
    };
    members.map(on).sum()
}

/// Counts particle `k`, with all that passes together with it.
pub fn count(state: &mut State, k: usize, crossing: &Crossing) {
    let mass =
        state.clumps.body_of(k).map_or_else(|| 1.0 / state.particles.rows[k].inverse_mass(), |f| f.mass);
    let speed = crossing.particle.velocity.dot(&state.zones.outlets[crossing.outlet as usize].plane.normal);
    let of = &mut state.zones.lost.returned.held_back[crossing.outlet as usize];
    of.momentum += mass * speed;
    of.passed += 1;
}
