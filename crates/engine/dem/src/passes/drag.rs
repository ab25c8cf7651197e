//! A fluid at uniform velocity: its drag on every particle, and its lift ([`laws::slowing::fluid`] has the formulas).
//!
//! On a rigid clump it acts as on a sphere of its volume at its centre
//! ([`crate::state::clumps`]). Left out: the shape of a clump, the mass of fluid that moves along, the torque of the fluid on a particle that
//! spins, and what particles do to the fluid and through it to each other.
//!
//! Stable step: that scheme, on v' = −λ v, needs λ Δt ≤ 1; with contacts, 1/Δt ≥ 1/Δt_contacts + λ is on the safe side, because
//! (ω Δt)²/4 + 2 ζ ω Δt + λ Δt ≤ 1 follows from it (see [`crate::model::limit`]).

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::state::State;
use crate::threads::{FEW, share};
use geom::Vec3;
use laws::slowing::{Moved, has_left};

/// Particles of one task.
const CHUNK: usize = 256;

/// Acceleration [m/s²] of particle `k` besides that of its contacts; a fluid acts on clumps as a whole.
pub fn body_acceleration(model: &Model, state: &State, k: usize) -> Vec3 {
    let (gravity, row) = (model.setup.gravity, &state.particles.rows[k]);
    let drag = model.setup.drag.filter(|_| !state.clumps.is_member(k));
    drag.map_or(gravity, |d| gravity + d.acceleration(row, &gravity))
}

/// What the fluid takes from particle `k` [W].
pub fn drag_power(model: &Model, state: &State, k: usize) -> f64 {
    let row = &state.particles.rows[k];
    model.setup.drag.map_or(0.0, |d| -d.slowing(row).dot(&row.velocity()) / row.inverse_mass())
}

/// After a move: what the fluid adds to it. Returns whether a particle has left its margin.
pub fn apply(model: &Model, state: &mut State, lists: &mut NeighbourLists) -> bool {
    let Some(drag) = model.setup.drag.filter(|_| !state.clumps.carry_all(state.particles.len())) else {
        return false;
    };
    let (dt, gravity, zones, clumps) = (model.dt, model.setup.gravity, &state.zones, &state.clumps);
    let ahead = model.ahead();
    let (p, before) = (&mut state.particles, &lists.before);
    let count = p.len();
    let rows = p.rows[..count].chunks_mut(CHUNK).zip(p.acceleration.chunks_mut(CHUNK));
    let tiles = rows.zip(before[..count].chunks(CHUNK)).zip(p.home.chunks(CHUNK)).enumerate();
    let done: Vec<(f64, bool)> =
        share(count >= FEW, tiles.collect(), |(tile, (((rows, accelerations), before), home))| {
            let (mut taken, mut out) = (0.0, false);
            for k in 0..rows.len() {
                let at = tile * CHUNK + k;
                if !zones.is_free(at) || clumps.is_member(at) {
                    continue;
                }
                let (row, was) = (&mut rows[k], &before[k]);
                let acceleration = &mut accelerations[k];
                taken += Moved { row: &mut *row, acceleration, was }.drag(&drag, &gravity, dt);
                out |= has_left(row, &home[k], ahead);
            }
            (taken, out)
        });
    if model.setup.ledger {
        done.iter().for_each(|d| state.ledger.drag += d.0);
    }
    done.iter().any(|d| d.1)
}
