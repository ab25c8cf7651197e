//! Particles at one instant: velocities corrected by the forces of it, and the first acceleration of those that begin to move.

use crate::model::Model;
use crate::passes::drag::body_acceleration;
use crate::passes::ledger::driven;
use crate::state::{DrivenBody, State};
use geom::Vec3;
use laws::contact::WrenchSums;
use laws::simd::Row4;
use laws::slowing::slowed_at;
use laws::space::sphere::inverse_inertia;

/// What a particle does at this instant.
pub struct Instant {
    pub velocity: Vec3,
    pub spin: Vec3,
    pub acceleration: Vec3,
    pub angular_acceleration: Vec3,
}

/// Corrects what was predicted for particle `k`, from the forces of this instant.
pub fn instant(model: &Model, state: &State, k: usize, sums: &WrenchSums) -> Instant {
    let p = &state.particles;
    let row = &p.rows[k];
    let (free, half) = (!state.zones.is_prescribed(k), 0.5 * model.dt);
    let body = body_acceleration(model, state, k);
    let (force, moment) = sums.on(k, row.radius());
    let mut at = Instant {
        velocity: row.velocity(),
        spin: Vec3::zeros(),
        acceleration: Vec3::zeros(),
        angular_acceleration: Vec3::zeros(),
    };
    // Clumps are damped as a whole.
    let is_damped = free && !state.clumps.is_member(k);
    let against = |all: Vec3, velocity: Vec3| match model.setup.local_damping {
        Some(factor) if is_damped => slowed_at(factor, all, &velocity),
        _ => all,
    };
    let inverse = inverse_inertia(row.radius(), row.inverse_mass());
    let flow = state.cell(model).flow(&row.position());
    let driven = against(force * row.inverse_mass() + body, row.velocity() - flow);
    let turned = if p.rotates() { against(moment * inverse, p.spins[k].vector()) } else { Vec3::zeros() };
    for a in 0..3 {
        at.acceleration[a] = driven[a];
        if free {
            at.velocity[a] += half * (at.acceleration[a] - p.acceleration[k][a]);
        }
        if p.rotates() {
            at.spin[a] = p.spins[k][a];
            at.angular_acceleration[a] = turned[a];
            if free {
                at.spin[a] += half * (at.angular_acceleration[a] - p.angular_acceleration[k][a]);
            }
        }
    }
    at
}

/// What drives particle `k` at this instant.
pub fn driven_now(model: &Model, state: &State, k: usize, sums: &WrenchSums) -> DrivenBody {
    let Instant { velocity, spin, acceleration, angular_acceleration } = instant(model, state, k, sums);
    DrivenBody { velocity, spin, ..driven(model, state, k, acceleration, angular_acceleration) }
}

/// Gives particles that begin to move the acceleration of this instant as that of the step before, which velocity Verlet needs; which they are.
pub fn start(model: &Model, state: &mut State) -> Vec<u32> {
    let starting = std::mem::take(&mut state.starting);
    let sums = state.contacts.sums();
    for k in starting.iter().map(|&k| k as usize) {
        let Instant { acceleration, angular_acceleration, .. } = instant(model, state, k, &sums);
        state.particles.acceleration[k] = Row4::of(acceleration);
        if state.particles.rotates() {
            state.particles.angular_acceleration[k] = Row4::of(angular_acceleration);
        }
    }
    let cell = state.cell(model);
    state.clumps.prime(&state.particles, &model.setup, &cell);
    starting
}
