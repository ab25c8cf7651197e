//! Walls on springs: the grains move them.
//!
//! ```text
//! M s'' = F − k s − c s'       F: force of the particles on the wall along its direction; s = 0 where it is drawn
//! ```
//!
//! Integrated as particles are ([`laws::contact::motion`]): forces see s and s' of one instant, s' being predicted. The weight of the wall is in balance with
//! its spring at s = 0. In the ledger the wall is one more body: what it does to the particles is no work from outside.
//!
//! **Stable step**: with K Δt + C ≤ S of the contacts as for servos ([`crate::model::servo`]) the scheme is stable for ((k Δt + c) + S) Δt/M ≤ 1; a
//! wall with so many contacts that it is not stops the run. Without contacts 20 steps in a period are asked for, as of all motions that repeat.

use crate::model::{Halt, Model};
use crate::neighbours::NeighbourLists;
use crate::passes::servo::{answer, wall_push};
use crate::setup::Mount;
use crate::state::{DrivenBody, MountState, State};
use geom::Vec3;

/// The walls on springs, with their states.
fn mounts<'a>(
    model: &'a Model,
    state: &'a State,
) -> impl Iterator<Item = (usize, &'a Mount, &'a MountState)> {
    let of = |(w, s): (usize, &'a MountState)| Some((w, model.walls[w].mount.as_ref()?, s));
    state.mounts.iter().enumerate().filter_map(of)
}

/// Force on a wall along its direction: of particles, and of spring and dashpot with it [N].
fn forces(mount: &Mount, s: &MountState, push: &Vec3) -> [f64; 2] {
    let particles = -push.dot(&mount.direction);
    [particles, particles - mount.stiffness * s.shift - mount.damping * s.speed]
}

/// Rate of the wall at this instant, whose acceleration is `a` [m/s²].
fn rate(s: &MountState, a: f64, dt: f64) -> f64 {
    s.speed + 0.5 * dt * (a - s.acceleration)
}

/// Moves the walls to the next step, by the forces of this one; first step: `starting`.
///
/// # Errors
/// A wall that is faster than its limit, or too light for its contacts.
pub fn drive(model: &Model, state: &mut State, lists: &NeighbourLists) -> Result<(), Halt> {
    let (dt, time, starting) = (model.dt, state.time(), state.steps == 0);
    let mut halt = None;
    for w in 0..state.mounts.len() {
        let Some(mount) = &model.walls[w].mount else { continue };
        let ahead = mount.speed_limit * dt;
        let push = wall_push(state, lists, w, |at, slot| answer(model, state, lists, (at, slot), ahead));
        let s = &mut state.mounts[w];
        let [particles, all] = forces(mount, s, &push.force);
        let a = all / mount.mass;
        if starting {
            s.acceleration = a;
        }
        let v = rate(s, a, dt);
        if model.setup.ledger {
            // The contacts have booked this as work from outside.
            state.ledger.walls += particles * s.speed * dt;
            state.ledger.mounts += mount.damping * s.speed * s.speed * dt;
            state.ledger.work += all * v * dt;
        }
        s.shift += v * dt + 0.5 * a * dt * dt;
        (s.speed, s.acceleration) = (v + a * dt, a);
        let name = || model.setup.walls[w].name.clone();
        let least = (mount.stiffness * dt + mount.damping + push.response) * dt;
        if !(s.speed.abs() <= mount.speed_limit) {
            let (speed, limit) = (s.speed, mount.speed_limit);
            halt = halt.or(Some(Halt::WallTooFast { time: time + dt, wall: name(), speed, limit }));
        } else if mount.mass < least {
            let (mass, contacts) = (mount.mass, push.contacts);
            halt = halt.or(Some(Halt::WallTooLight { time, wall: name(), mass, contacts, least }));
        }
    }
    halt.map_or(Ok(()), Err)
}

/// Energy of motion and in springs of the walls at this instant [J], whose forces are known.
pub fn energy(model: &Model, state: &State, lists: &NeighbourLists) -> [f64; 2] {
    let of = |(w, mount, s): (usize, &Mount, &MountState)| {
        let body = body(model, state, lists, (w, mount, s));
        [0.5 * mount.mass * body.velocity.norm_squared(), 0.5 * mount.stiffness * s.shift * s.shift]
    };
    mounts(model, state).map(of).fold([0.0; 2], |[a, b], [x, y]| [a + x, b + y])
}

/// A wall as the ledger sees it at this instant.
fn body(
    model: &Model,
    state: &State,
    lists: &NeighbourLists,
    (w, mount, s): (usize, &Mount, &MountState),
) -> DrivenBody {
    let [_, all] = forces(mount, s, &wall_push(state, lists, w, |_, _| 0.0).force);
    let v = if state.steps == 0 { s.speed } else { rate(s, all / mount.mass, model.dt) };
    let (force, velocity) = (mount.direction * all, mount.direction * v);
    let zero = Vec3::zeros();
    DrivenBody {
        inverse_mass: 1.0 / mount.mass,
        forces: [force; 2],
        moment: zero,
        turning: zero,
        velocity,
        spin: zero,
    }
}

/// The walls as the ledger sees them at this instant.
pub fn bodies(model: &Model, state: &State, lists: &NeighbourLists) -> Vec<DrivenBody> {
    mounts(model, state).map(|mount| body(model, state, lists, mount)).collect()
}

/// In the step that begins: work that contacts book as from outside, and what dashpots take [J].
pub fn step_sums(model: &Model, state: &State, lists: &NeighbourLists) -> [f64; 2] {
    let of = |(w, mount, s): (usize, &Mount, &MountState)| {
        let [particles, _] = forces(mount, s, &wall_push(state, lists, w, |_, _| 0.0).force);
        [-particles * s.speed * model.dt, mount.damping * s.speed * s.speed * model.dt]
    };
    mounts(model, state).map(of).fold([0.0; 2], |[a, b], [x, y]| [a + x, b + y])
}

/// In the springs of the walls [J].
pub fn elastic(model: &Model, state: &State) -> f64 {
    mounts(model, state).map(|(_, mount, s)| 0.5 * mount.stiffness * s.shift * s.shift).sum()
}
