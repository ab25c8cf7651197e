//! After a move: prescribed motion, crossings, releases, exclusions.

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::passes::zones::cross::find_crossings;
use crate::passes::zones::travel::move_zone_particles;
use crate::state::State;

/// After a move: prescribed motion, crossings, releases, exclusions.
pub fn advance(model: &Model, state: &mut State, lists: &mut NeighbourLists) {
    move_zone_particles(model, state, lists);
    find_crossings(model, state, lists);
}
