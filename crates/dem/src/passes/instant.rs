//! Particles at one instant: velocities corrected by the forces of it.

use crate::kernel::sums::WrenchSums;
use crate::model::Model;
use crate::passes::drag::body_acceleration;
use crate::passes::ledger::driven;
use crate::state::State;
use crate::state::ledger::DrivenBody;
use geom::Vec3;

/// What a particle does at this instant.
pub struct Instant {
    pub velocity: Vec3,
    pub spin: Vec3,
    pub acceleration: [f64; 3],
    pub turning: [f64; 3],
}

/// Corrects what was predicted for particle `k`, whose loads are those of this instant.
pub fn instant(model: &Model, state: &State, k: usize, loads: &WrenchSums) -> Instant {
    let p = &state.particles;
    let row = &p.rows[k];
    let (free, half) = (!state.zones.travels(k), 0.5 * model.dt);
    let body = body_acceleration(model, state, k);
    let (force, moment) = loads.on(k, row[3]);
    let mut at = Instant {
        velocity: Vec3::new(row[4], row[5], row[6]),
        spin: Vec3::zeros(),
        acceleration: [0.0; 3],
        turning: [0.0; 3],
    };
    for a in 0..3 {
        at.acceleration[a] = force[a] * row[7] + body[a];
        if free {
            at.velocity[a] += half * (at.acceleration[a] - p.acceleration[k][a]);
        }
        if p.rotates() {
            at.spin[a] = p.spins[k][a];
            at.turning[a] = moment[a] * (2.5 * row[7] / (row[3] * row[3]));
            if free {
                at.spin[a] += half * (at.turning[a] - p.turning[k][a]);
            }
        }
    }
    at
}

/// What drives particle `k` at this instant.
pub fn driven_now(model: &Model, state: &State, k: usize, loads: &WrenchSums) -> DrivenBody {
    let Instant { velocity, spin, acceleration, turning } = instant(model, state, k, loads);
    DrivenBody { velocity, spin, ..driven(model, state, k, acceleration, turning) }
}
