//! The ledger of zones: what contacts do to travellers goes in or out, because nothing acts on them.

use crate::kernel::LEDGER;
use crate::model::Model;
use crate::model::kind::With;
use crate::neighbours::NeighbourLists;
use crate::neighbours::contacts::Segment;
use crate::neighbours::ends::idles;
use crate::setup::Particle;
use crate::state::State;
use crate::state::zone_particle::Direction;
use geom::Vec3;

/// The ledger of one step, before the zones move.
pub fn add_zones(model: &Model, state: &mut State, lists: &mut NeighbourLists) {
    let now = state.time();
    for t in &state.zones.zone_particles {
        let flow = t.flow(now, &state.zones, &model.setup);
        let moving = Particle { velocity: flow.velocity, spin: flow.spin, ..t.start };
        let work = power(lists, t.at as usize, &moving) * model.dt;
        state.ledger.passed += work;
        match t.way {
            Direction::In(_) => state.ledger.entered -= work,
            Direction::Out(_) => state.ledger.left += work,
        }
    }
}

/// Of the contacts of particle `k` on it [W], in the step before the last move.
pub fn power(lists: &NeighbourLists, k: usize, state: &Particle) -> f64 {
    let (force, moment) = lists.contacts.sums().on(k, state.radius);
    Vec3::from(force).dot(&state.velocity) + Vec3::from(moment).dot(&state.spin)
}

/// The same for particle `k`, or for a member of the clump that moves like this about its centre.
pub fn power_of_member(state: &State, lists: &NeighbourLists, k: usize, whole: &Particle) -> f64 {
    let r = state.bodies.arm_at(k);
    let velocity = whole.velocity + whole.spin.cross(&r);
    power(lists, k, &Particle { radius: state.particles.rows[k][3], velocity, ..*whole })
}

/// Elastic energy [J] of the contacts that act on no particle.
pub fn energy_of_idle(model: &Model, state: &State, lists: &NeighbourLists) -> f64 {
    if state.zones.none() {
        return 0.0;
    }
    let c = &lists.contacts;
    let of = |s: &Segment| -> f64 {
        let idle = |place: &usize| idles(state, lists, model.kinds[s.kind].with, *place);
        s.contacts().filter(idle).map(|place| c.ledger[place * LEDGER]).sum()
    };
    c.segments.iter().map(of).sum()
}

/// Elastic energy [J] of the contacts of particle `k` with those that have not left before it.
pub fn held(model: &Model, state: &State, lists: &NeighbourLists, k: usize) -> f64 {
    let c = &lists.contacts;
    let entries = &c.entries[c.starts[k] as usize..c.starts[k + 1] as usize];
    let of = |&entry: &u32| {
        let (place, second) = ((entry >> 1) as usize, entry & 1 == 1);
        let wall = matches!(model.kinds[c.segment_of(place).kind].with, With::Wall(_));
        let other = if second { c.i[place] } else { c.partner[place] } as usize;
        if !wall && state.zones.is_gone(other) { 0.0 } else { c.ledger[place * LEDGER] }
    };
    entries.iter().map(of).sum()
}
