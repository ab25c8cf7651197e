//! Looks for particles that zones have lost.

use crate::model::Model;
use crate::model::halt::Halt;
use crate::passes::zones::whole::test_point;
use crate::state::State;

/// Looks for grains that zones have lost: one that came in by a cut and has gone back through the whole zone, and one that
/// comes in too fast for the step. Those behind a calculation plane again are counted. At no cost without inlets.
///
/// # Errors
/// Such a grain.
pub fn look_back(model: &Model, state: &mut State) -> Result<(), Halt> {
    let time = state.time();
    state.zones.fast(time, model.dt, &model.setup)?;
    let mut found = None;
    for k in 0..if state.zones.lost.any { state.particles.len() } else { 0 } {
        let Some((place, radius)) = test_point(state, k) else { continue };
        let Some((inlet, behind)) = state.zones.came_back(k, &place, radius) else {
            continue;
        };
        if behind > 0.0 && model.setup.guards.zones && found.is_none() {
            let (id, [x, y, z]) = (state.particles.id[k], [place.x, place.y, place.z]);
            found = Some(Halt::CameBack { time, id, inlet, x, y, z, behind });
        }
    }
    found.map_or(Ok(()), Err)
}
