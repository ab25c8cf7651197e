//! The ledger of zones: the work of contacts on zone particles goes in or out, because nothing acts on these.

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::passes::zones::idle_contacts::power_of_passive;
use crate::setup::Particle;
use crate::state::{Direction, State};

/// Work [J] on zone particles in a step, of all that acts on free particles too.
#[derive(Debug, Clone, Copy, Default)]
pub struct ZoneWork {
    /// On those on their way in.
    pub entering: f64,
    /// On those on their way out.
    pub leaving: f64,
}

impl ZoneWork {
    /// Of the step around this instant, whose forces are known: half of it is still to come.
    pub fn of(model: &Model, state: &State, lists: &NeighbourLists) -> ZoneWork {
        let now = state.time();
        let mut work = ZoneWork::default();
        for t in &state.zones.zone_particles {
            let flow = t.flow(now, &state.zones, &model.setup);
            let moving = Particle { velocity: flow.velocity, spin: flow.spin, ..t.start };
            let k = t.at as usize;
            let acts = (power(state, k, &moving) - power_of_passive(state, lists, k, &moving)) * model.dt;
            match t.direction {
                Direction::In(_) => work.entering += acts,
                Direction::Out(_) => work.leaving += acts,
            }
        }
        work
    }
}

/// Of the contacts of particle `k` on it [W], in the step before the last move.
fn power(state: &State, k: usize, moving: &Particle) -> f64 {
    let (force, moment) = state.contacts.sums().on(k, moving.radius);
    force.dot(&moving.velocity) + moment.dot(&moving.spin)
}
