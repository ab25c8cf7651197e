//! Recorded paths: what comes in of them, and what is recorded.

use crate::model::Model;
use crate::model::error::SetupError;
use crate::passes::zones::cross::state_back;
use crate::passes::zones::whole::test_point;
use crate::setup::{Guide, PathSample};
use crate::state::State;
use crate::state::path::EARLY;
use std::collections::BTreeSet;

/// Says where a particle goes that was queued for an inlet of recorded motion. The samples must reach beyond time() +
/// [`Simulation::look_ahead`] before the next step.
///
/// # Errors
/// A particle that is not on its way in, samples out of order.
pub fn guide(model: &Model, state: &mut State, id: u32, guide: Guide) -> Result<(), SetupError> {
    state.zones.guide(id, guide, &model.setup)
}

/// Where free particles near a storage plane of recorded motion are now, and which have gone back upstream since they were
/// sampled last, by outlet and id.
pub fn sample_paths(model: &Model, state: &mut State) -> Vec<PathSample> {
    let mut out = Vec::new();
    for outlet in 0..state.zones.outlets.len() {
        if state.zones.outlets[outlet].motion == crate::setup::ZoneMotion::Recorded {
            sample_paths_of(model, state, outlet, &mut out);
        }
    }
    out
}

fn sample_paths_of(model: &Model, state: &mut State, outlet: usize, out: &mut Vec<PathSample>) {
    let zone = state.zones.outlets[outlet];
    let first = out.len();
    for k in 0..state.particles.len() {
        let Some((place, radius)) = test_point(state, k) else { continue };
        let id = state.particles.id[k];
        if !(zone.past(&place, radius) >= -EARLY * zone.length)
            || state.zones.is_gone(k)
            || state.zones.travels(k)
            || state.zones.beyond[outlet].contains(&id)
        {
            continue;
        }
        out.push(sample(model, state, k, outlet as u32, false));
    }
    out[first..].sort_unstable_by_key(|s| s.particle.id);
    let now: BTreeSet<u32> = out[first..].iter().map(|s| s.particle.id).collect();
    let before = std::mem::replace(&mut state.zones.sampled[outlet], now);
    let now = &state.zones.sampled[outlet];
    // Those that are not free any more have passed: their crossing ends the path.
    let gone = |k: &usize| {
        let id = &state.particles.id[*k];
        before.contains(id) && !now.contains(id) && !state.zones.travels(*k) && !state.zones.is_gone(*k)
    };
    let mut ids: Vec<(u32, usize)> =
        (0..state.particles.len()).filter(gone).map(|k| (state.particles.id[k], k)).collect();
    ids.sort_unstable();
    for (_, k) in ids {
        out.push(sample(model, state, k, outlet as u32, true));
    }
}

/// Where particle `k`, or the clump that it is the first member of, is now.
fn sample(model: &Model, state: &State, k: usize, outlet: u32, gone: bool) -> PathSample {
    let (particle, clump) = state_back(model, state, k, 0.0);
    PathSample { outlet, particle, clump, turn: state.bonds.turn_of(k), gone }
}
