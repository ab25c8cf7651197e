//! Free particles that are taken out because they are in a region of [`crate::setup::Removal`].

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::passes::zones::removed::take_out;
use crate::passes::zones::whole::test_point;
use crate::state::State;
use geom::Vec3;

/// Takes out what is in a region now, after the move; the first of several regions counts it.
pub fn remove_inside(model: &Model, state: &mut State, lists: &NeighbourLists) {
    if model.setup.removals.is_empty() {
        return;
    }
    for k in 0..state.particles.len() {
        // Those that go on freely to the end of an outlet's zone belong to the next stage.
        if !state.zones.is_free(k) || state.zones.has_crossed(state.particles.id[k]) {
            continue;
        }
        let Some((position, _)) = test_point(state, k) else { continue };
        let position = in_domain(model, position);
        let Some(region) = model.setup.removals.iter().position(|r| r.holds(&position)) else { continue };
        let id = state.particles.id[k];
        state.zones.beyond.iter_mut().for_each(|ids| {
            ids.remove(&id);
        });
        let mass =
            state.clumps.body_of(k).map_or_else(|| 1.0 / state.particles.rows[k].inverse_mass(), |c| c.mass);
        let removed = &mut state.zones.lost.returned.regions[region];
        removed.count += 1;
        removed.mass += mass;
        take_out(model, state, lists, k);
    }
}

/// The image of a point in the domain [m]: particles leave it until neighbours are listed again.
fn in_domain(model: &Model, mut point: Vec3) -> Vec3 {
    for (axis, range) in model.setup.periodic.iter().enumerate() {
        if let Some((low, high)) = range {
            point[axis] -= (high - low) * ((point[axis] - low) / (high - low)).floor();
        }
    }
    point
}
