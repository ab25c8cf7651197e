//! Recorded paths: what is recorded.

use crate::model::Model;
use crate::passes::zones::cross::state_back;
use crate::passes::zones::whole::test_point;
use crate::setup::{PathSample, ZoneMotion, cluster_of};
use crate::state::{EARLY, State};
use std::collections::BTreeSet;

/// Where free particles near a storage plane of recorded motion are now, and which have gone back upstream since they were
/// sampled last, by outlet and id.
pub fn sample_paths(model: &Model, state: &mut State) -> Vec<PathSample> {
    let mut out = Vec::new();
    for outlet in 0..state.zones.outlets.len() {
        if state.zones.outlets[outlet].motion == ZoneMotion::Recorded {
            sample_paths_of(model, state, outlet, &mut out);
        }
    }
    out
}

fn sample_paths_of(model: &Model, state: &mut State, outlet: usize, out: &mut Vec<PathSample>) {
    let zone = state.zones.outlets[outlet];
    let first = out.len();
    for k in 0..state.particles.len() {
        let Some((position, radius)) = test_point(state, k) else { continue };
        let id = state.particles.id[k];
        if !(zone.past(&position, radius) >= -EARLY * zone.length)
            || !state.zones.is_free(k)
            || state.zones.beyond[outlet].contains(&id)
            || state.zones.has_crossed(id)
        {
            continue;
        }
        out.push(sample(model, state, k, outlet as u32, false));
    }
    out[first..].sort_unstable_by_key(|s| s.particle.id);
    let now: BTreeSet<u32> = out[first..].iter().map(|s| s.particle.id).collect();
    let before = std::mem::replace(&mut state.zones.sampled[outlet], now);
    let now = &state.zones.sampled[outlet];
    // Those that have passed, or are not free any more, did not go back: their crossing ends the path.
    let gone = |k: &usize| {
        let id = &state.particles.id[*k];
        before.contains(id) && !now.contains(id) && state.zones.is_free(*k) && !state.zones.has_crossed(*id)
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
    let cluster = cluster_of(&state.clusters, particle.id);
    PathSample { outlet, particle, clump, turn: state.bonds.turn_of(k), cluster, gone }
}
