//! Walls that follow a force: a piston that pushes along its direction until the contacts push back as much.
//!
//! ```text
//! s' = G (F − P), |s'| ≤ speed limit        P: force of the wall on the particles along its direction
//! G  = α / (N (k Δt + c)),  α = 1/2          N contacts that push, k and c the stiffest of them
//! s_{n+1} = s_n + s'_{n+1} Δt                s'_{n+1} from the forces of step n
//! ```
//!
//! The servo mechanism of Cundall, as described for PFC (Itasca: G = α A / (k N Δt)), with the dashpots of the contacts in the
//! gain. Forces see s and s' of the step before: s'_{n+1} = G (F − K s_n − C s'_n) with K = N k, C = N c turns unstable by an eigenvalue of −1, where
//! s = s' Δt/2, at G (K Δt/2 + C) = 1: at α = 2 for springs alone, at α = 1 for dashpots alone; α = ½ is half of the least. A wall moved like this is a piston
//! without mass in a dashpot of 1/G under the constant force F: passive, so it adds no energy but its work, which the ledger has.
//! A wall that touches nothing moves at its speed limit, and stays where its force is 0. N is that of the step; k is the slope of the law at the overlap limit, so that the real gain is lower.
//!
//! P is summed in the order of the contact list: the same bits for any number of threads.

use crate::model::{Halt, Model, With};
use crate::neighbours::NeighbourLists;
use crate::neighbours::poses::pose;
use crate::state::State;
use geom::Vec3;
use serde::{Deserialize, Serialize};

/// Share α of the gain at which one contact is answered in one step [–].
const SHARE: f64 = 0.5;

/// What acts on a wall at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct WallForce {
    /// Force of the particles on the wall [N].
    pub force: Vec3,
    /// How far the wall has been shifted since t = 0 [m], its turn apart.
    pub shift: Vec3,
    /// Number of contacts.
    pub contacts: u32,
}

/// Force on each wall, and where it is.
pub fn wall_forces(model: &Model, state: &State, lists: &NeighbourLists) -> Vec<WallForce> {
    let time = state.time();
    let of = |w: usize| {
        let (push, contacts) = wall_push(state, lists, w);
        WallForce { force: -push, shift: pose(model, state, w, time).shift(), contacts }
    };
    (0..model.walls.len()).map(of).collect()
}

/// Force of a wall on the particles [N], and how many it pushes: those in zones feel nothing, and push no wall.
fn wall_push(state: &State, lists: &NeighbourLists, wall: usize) -> (Vec3, u32) {
    let (mut sum, mut count) = (Vec3::zeros(), 0);
    for segment in lists.slots.segments.iter().filter(|s| s.with == With::Wall(wall)) {
        let acts = |slot: &usize| !state.zones.is_idle(lists.slots.ends(segment, *slot));
        for force in segment.contacts().filter(acts).map(|slot| state.contacts.force(slot)) {
            count += u32::from(force != Vec3::zeros());
            sum += force;
        }
    }
    (sum, count)
}

/// Moves the servos to the next step, by the forces of this one; an error where a wall is lost by that.
pub fn drive(model: &Model, state: &mut State, lists: &mut NeighbourLists) -> Result<(), Halt> {
    let mut lost = None;
    for w in 0..state.servos.len() {
        let Some(servo) = model.walls[w].servo else { continue };
        let (push, count) = wall_push(state, lists, w);
        let lack = servo.force - push.dot(&servo.direction);
        let gain = SHARE / (f64::from(count.max(1)) * model.servo_gains[w]);
        let servo_state = &mut state.servos[w];
        let free = if lack == 0.0 { 0.0 } else { lack.signum() * servo.speed_limit };
        let speed = if count == 0 { free } else { gain * lack };
        servo_state.speed = speed.clamp(-servo.speed_limit, servo.speed_limit);
        servo_state.shift += servo_state.speed * model.dt;
        if !servo_state.is_finite() {
            lost = lost.or(Some((w, servo.force - lack)));
        }
    }
    let time = state.time() + model.dt;
    lost.map_or(Ok(()), |(w, push)| {
        let wall = model.setup.walls[w].name.clone();
        Err(Halt::WallNotANumber { time, wall, push })
    })
}
