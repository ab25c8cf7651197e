//! Looks for particles that zones have lost.

use crate::model::{Halt, Model};
use crate::neighbours::NeighbourLists;
use crate::passes::zones::removed;
use crate::passes::zones::whole::test_point;
use crate::setup::CameBack;
use crate::state::State;

/// Looks for grains that zones have lost: one that came in by a cut and has gone back through the whole zone, and one that
/// comes in too fast for the step. Those behind a calculation plane again are counted. At no cost without inlets.
///
/// # Errors
/// Such a grain, unless the guard has it removed.
pub fn look_back(model: &Model, state: &mut State, lists: &NeighbourLists) -> Result<(), Halt> {
    let time = state.time();
    state.zones.fast(time, model.dt, &model.setup)?;
    let mut found = None;
    for k in 0..if state.zones.lost.any { state.particles.len() } else { 0 } {
        let Some((position, radius)) = test_point(state, k) else { continue };
        let Some((inlet, behind)) = state.zones.came_back(k, &position, radius) else {
            continue;
        };
        match model.setup.guards.zones {
            CameBack::Stops if behind > 0.0 && found.is_none() => {
                found = Some(Halt::CameBack { time, id: state.particles.id[k], inlet, position, behind });
            }
            CameBack::IsRemoved if behind > 0.0 => removed::remove(model, state, lists, k, inlet),
            _ => {}
        }
    }
    found.map_or(Ok(()), Err)
}
