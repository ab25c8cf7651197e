//! Local damping of particles, for packings that are to come to rest ([`laws::slowing::local_damping`] has the formulas).
//!
//! v and ω are those predicted for the instant, v less that of the flow where the periodic cell is strained. A
//! particle in balance, or one that moves uniformly, is not damped; a falling one falls with (1 − α) g. So the damping is for specimens that are made, not
//! for flows. A force that slows counts 1 + α times: the critical step is divided by that ([`crate::model::limit`]).

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::passes::drag::body_acceleration;
use crate::state::State;
use crate::threads::{FEW, share};
use laws::contact::WrenchSums;
use laws::slowing::local_damping::against;
use laws::slowing::{Moved, Turned, has_left};
use laws::space::sphere::inverse_inertia;

/// Particles of one task.
const CHUNK: usize = 256;

/// What local damping takes from particle `k` at this instant [W].
pub fn power(model: &Model, state: &State, k: usize, sums: &WrenchSums) -> f64 {
    let Some(factor) = model.setup.local_damping else { return 0.0 };
    let (p, row) = (&state.particles, &state.particles.rows[k]);
    let (force, moment) = sums.on(k, row.radius());
    let (velocity, flow) = (row.velocity(), state.cell(model).flow(&row.position()));
    let slowed = against(
        factor,
        &(force * row.inverse_mass() + body_acceleration(model, state, k)),
        &(velocity - flow),
    );
    let mut taken = -slowed.dot(&velocity) / row.inverse_mass();
    if p.rotates() {
        let (spin, inverse) = (p.spins[k].vector(), inverse_inertia(row.radius(), row.inverse_mass()));
        taken -= against(factor, &(moment * inverse), &spin).dot(&spin) / inverse;
    }
    taken
}

/// After a move and what the fluid adds to it, of spheres; clumps are damped when they move ([`crate::passes::clumps`]). Returns whether a particle has left its margin.
pub fn apply(model: &Model, state: &mut State, lists: &NeighbourLists) -> bool {
    let all_carried = state.clumps.carry_all(state.particles.len());
    let Some(factor) = model.setup.local_damping.filter(|_| !all_carried) else { return false };
    let (dt, ahead, cell) = (model.dt, model.ahead(), state.cell(model));
    let (zones, clumps) = (&state.zones, &state.clumps);
    let p = &mut state.particles;
    let (count, rotates) = (p.len(), p.rotates());
    let turning = if rotates { count } else { 0 };
    // Without rotation there are no spins, and an empty part for each chunk.
    let spins = p.spins[..turning].chunks_mut(CHUNK).chain(std::iter::repeat_with(Default::default));
    let turns = p.angular_acceleration.chunks_mut(CHUNK).chain(std::iter::repeat_with(Default::default));
    let rows =
        p.rows[..count].chunks_mut(CHUNK).zip(p.acceleration.chunks_mut(CHUNK)).zip(p.home.chunks(CHUNK));
    let tiles: Vec<_> = rows.zip(spins.zip(turns)).enumerate().collect();
    let done: Vec<(f64, bool)> =
        share(count >= FEW, tiles, |(tile, (((rows, accelerations), home), (spins, turns)))| {
            let (mut taken, mut out) = (0.0, false);
            let mine = |k: &usize| zones.is_free(tile * CHUNK + k) && !clumps.is_member(tile * CHUNK + k);
            for k in (0..rows.len()).filter(mine) {
                let at = tile * CHUNK + k;
                let turned = match (spins.get_mut(k), turns.get_mut(k), lists.spins_before.get(at)) {
                    (Some(spin), Some(acceleration), Some(was)) => Some(Turned { spin, acceleration, was }),
                    _ => None,
                };
                let (row, acceleration, was) = (&mut rows[k], &mut accelerations[k], &lists.before[at]);
                let flow = cell.flow(&was.position());
                taken += Moved { row, acceleration, was }.damp(factor, &flow, turned, dt);
                out |= has_left(&rows[k], &home[k], ahead);
            }
            (taken, out)
        });
    if model.setup.ledger {
        done.iter().for_each(|d| state.ledger.damped += d.0);
    }
    done.iter().any(|d| d.1)
}
