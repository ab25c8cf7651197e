//! Walls that follow a force: a wall pushes along its direction until the contacts push back as much, and keeps that force however the
//! particles move.
//!
//! ```text
//! s' = G e + I,   I' = e/M,   e = F − P      P: force of the wall on the particles along its direction; |s'|, |I| ≤ speed limit
//! G = α/S,  M = κ S Δt,  α = ½, κ = 2        S = Σ (k Δt + c) over its contacts, k and c at the overlap of each
//! s_{n+1} = s_n + s'_{n+1} Δt                s'_{n+1} from the forces of step n
//! ```
//!
//! G e alone is the servo mechanism of Cundall, as described for PFC (Itasca: G = α A/(k N Δt)). It needs a lack of force e = v/G to move at a speed
//! v, so its force is wrong while a specimen is sheared. The integral I takes over that speed: the lack that is left is M dv/dt.
//!
//! **Stability.** Forces see s and s' of the step before. With grains that do not give way, e = −K s − C s' (K Δt + C ≤ S), the loop turns unstable by an
//! eigenvalue of −1, where s = s' Δt/2 and I = e Δt/2M: at (G + Δt/2M) (K Δt/2 + C) = 1. Here it is at most α + 1/2κ = ¾.
//!
//! **Passive.** The mobility G + 1/(i ω M) of the wall has a positive real part at all frequencies: it is a body of mass M in a row with a dashpot of
//! 1/G, both under the constant force F, so it adds no energy but the work of F. With springs alone M falls with Δt²: a wall without mass that bears F.
//!
//! **First contact.** A wall that touches nothing has I = 0 and moves at its speed limit (stays, where its force is 0). From there until the force is nearly
//! reached κ is larger, and at the speed limit I does not grow: it lands as the proportional servo does, without a store of speed.
//!
//! S is that of the step. k is the slope of the law at the overlap of each contact a step later at the speed limit, or at most twice that overlap. P and S are
//! summed in the order of the contact list: the same bits for any number of threads.

use crate::model::servo::Response;
use crate::model::{Halt, Model, With};
use crate::neighbours::NeighbourLists;
use crate::neighbours::poses::pose;
use crate::passes::touching::position_before;
use crate::setup::{Length, Servo, WallShape};
use crate::state::clumps::FREE;
use crate::state::{Governor, Held, State};
use geom::Vec3;
use serde::{Deserialize, Serialize};

/// Share α of the gain at which one contact is answered in one step [–].
const SHARE: f64 = 0.5;
/// Mass κ of the integral, in S Δt [–].
const MASS: f64 = 2.0;
/// The same from the first contact until the force is nearly reached [–].
const LANDING: f64 = 2000.0;
/// Lack of force, as a share of the force, at which it is [–].
const LANDED: f64 = 0.1;
/// Steps between two searches for a wall that has passed all particles.
const SEARCH_EVERY: u64 = 512;

/// What acts on a wall at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct WallForce {
    /// Force of the particles on the wall [N].
    pub force: Vec3,
    /// How far the wall has been shifted since t = 0 [m], its turn apart.
    pub shift: Vec3,
    /// Number of grains that touch it; a clump is one.
    pub contacts: u32,
    /// What its servo follows, and how well.
    pub servo: Option<ServoReport>,
}

/// What a servo follows at one instant, and how well it has held that.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct ServoReport {
    /// Force that is wanted along its direction [N].
    pub target: f64,
    /// Force of the wall on the particles along its direction [N].
    pub push: f64,
    /// Area that a stress acts on [m²]; `None`: it follows a force.
    pub area: Option<f64>,
    /// How well it has held its target.
    pub held: Held,
}

/// Force on each wall, and where it is.
pub fn wall_forces(model: &Model, state: &State, lists: &NeighbourLists) -> Vec<WallForce> {
    let time = state.time();
    let of = |w: usize| {
        let push = wall_push(state, lists, w, |_, _| 0.0);
        let along = |s: &Servo| push.force.dot(&s.direction);
        let servo = model.walls[w].servo.as_ref();
        let servo = servo.map(|s| ServoReport { push: along(s), ..report(model, state, w, s) });
        let shift = pose(model, state, w, time).shift();
        WallForce { force: -push.force, shift, contacts: push.grains, servo }
    };
    (0..model.walls.len()).map(of).collect()
}

/// What each servo follows now, and how well it has held that; by wall. Pushes are those of the last step.
pub fn reports(model: &Model, state: &State) -> Vec<(usize, ServoReport)> {
    let of = |w: usize| Some((w, report(model, state, w, model.walls[w].servo.as_ref()?)));
    (0..state.servos.len()).filter_map(of).collect()
}

fn report(model: &Model, state: &State, wall: usize, servo: &Servo) -> ServoReport {
    let (held, area) = (state.servos[wall].held, area(model, state, servo));
    ServoReport { target: target(servo, area, state.time()), push: held.push, area, held }
}

/// Area that a stress acts on now [m²]; `None` for a force.
fn area(model: &Model, state: &State, servo: &Servo) -> Option<f64> {
    let face = |w: usize| match &model.setup.walls[w].shape {
        WallShape::Plane(plane) => (pose(model, state, w, state.time()).position(&plane.point), plane.normal),
        _ => (Vec3::zeros(), Vec3::zeros()),
    };
    let length = |side: &Length| match *side {
        Length::Fixed(length) => length,
        Length::Between(a, b) => {
            let ((one, normal), (other, _)) = (face(a), face(b));
            (other - one).dot(&normal)
        }
    };
    servo.area.as_ref().map(|sides| sides.iter().map(length).product())
}

/// Force that is wanted at `time` [N].
fn target(servo: &Servo, area: Option<f64>, time: f64) -> f64 {
    servo.target.at(time) * area.unwrap_or(1.0).max(0.0)
}

/// What a wall does to the particles.
#[derive(Debug, Clone, Copy, Default)]
pub struct Push {
    /// Force on the particles [N].
    pub force: Vec3,
    /// How many contacts push.
    pub contacts: u32,
    /// How many grains do: one that touches several spheres of the wall, or a clump that touches it in several places, is one.
    pub grains: u32,
    /// Sum of what `response` gives for each contact.
    pub response: f64,
}

/// Force of a wall on the particles, how many it pushes, and the sum of a `response` of them (by segment and slot): those in zones feel nothing, and push
/// no wall.
pub fn wall_push(
    state: &State,
    lists: &NeighbourLists,
    wall: usize,
    response: impl Fn(usize, usize) -> f64,
) -> Push {
    let (mut push, mut bodies) = (Push::default(), Vec::new());
    let clump = |k: u32| state.clumps.of.get(k as usize).copied().filter(|&clump| clump != FREE);
    let body = |k: u32| clump(k).map_or(k, |clump| state.particles.len() as u32 + clump);
    for (at, segment) in lists.slots.segments.iter().enumerate().filter(|(_, s)| s.with == With::Wall(wall)) {
        let acts = |slot: &usize| !state.zones.is_idle(lists.slots.ends(segment, *slot));
        for slot in segment.contacts().filter(acts) {
            let force = state.contacts.force(slot);
            if force != Vec3::zeros() {
                push.contacts += 1;
                let grain = body(lists.slots.i[slot]);
                if bodies.last() != Some(&grain) {
                    bodies.push(grain);
                }
                push.response += response(at, slot);
            }
            push.force += force;
        }
    }
    // Contacts of one particle follow each other, those of one clump need not.
    bodies.sort_unstable();
    bodies.dedup();
    push.grains = bodies.len() as u32;
    push
}

/// k Δt + c of the contact of a wall in a slot, at its overlap before the last move [N·s/m].
pub fn answer(
    model: &Model,
    state: &State,
    lists: &NeighbourLists,
    (at, slot): (usize, usize),
    ahead: f64,
) -> f64 {
    let segment = &lists.slots.segments[at];
    let response: &Response = &model.responses[segment.kind];
    let (k, p) = (lists.slots.i[slot] as usize, &state.particles);
    let (point, radius) = lists.partner(p, segment, slot, |k| p.position(k));
    let mine = p.rows[k].radius();
    let overlap = ahead + mine + radius - (position_before(model, state, k) - point).norm();
    response.at(overlap / if radius == 0.0 { mine } else { mine.min(radius) })
}

/// Moves the servos to the next step, by the forces of this one.
///
/// # Errors
/// A wall whose position is lost by that, or that has passed all particles.
pub fn drive(model: &Model, state: &mut State, lists: &NeighbourLists) -> Result<(), Halt> {
    if state.servos.is_empty() {
        return Ok(());
    }
    let time = state.time();
    let of = |w: usize| {
        let servo = model.walls[w].servo.as_ref()?;
        let ahead = servo.speed_limit * model.dt;
        let push = wall_push(state, lists, w, |at, slot| answer(model, state, lists, (at, slot), ahead));
        // All areas are those before any wall moves.
        Some((w, push, target(servo, area(model, state, servo), time)))
    };
    let pushes: Vec<(usize, Push, f64)> = (0..state.servos.len()).filter_map(of).collect();
    let mut halt = None;
    for (w, push, target) in pushes {
        let Some(servo) = &model.walls[w].servo else { continue };
        let along = push.force.dot(&servo.direction);
        let s = &mut state.servos[w];
        s.governor.follow(servo.speed_limit, (push.contacts, push.response), (target, target - along));
        s.shift += s.governor.speed * model.dt;
        s.held.touched |= push.contacts > 0;
        s.held.add(time, along, target, s.governor.speed.abs() >= servo.speed_limit);
        let name = || model.setup.walls[w].name.clone();
        if !state.servos[w].is_finite() {
            halt = halt.or(Some(Halt::WallNotANumber { time: time + model.dt, wall: name(), push: along }));
        } else if push.contacts == 0
            && state.steps.is_multiple_of(SEARCH_EVERY)
            && is_past_all(model, state, w)
        {
            let shift = state.servos[w].shift;
            halt = halt.or(Some(Halt::WallPastAll { time, wall: name(), shift }));
        }
    }
    halt.map_or(Ok(()), Err)
}

impl Governor {
    /// The next rate, up to `limit`, where a `target` is missed by a `lack` and `contacts` answer with a sum S.
    pub fn follow(&mut self, limit: f64, (contacts, response): (u32, f64), (target, lack): (f64, f64)) {
        if contacts == 0 {
            (self.drift, self.landed) = (0.0, false);
            self.speed = if target == 0.0 { 0.0 } else { limit };
            return;
        }
        self.landed |= lack <= LANDED * target;
        let (gain, mass) = (SHARE / response, if self.landed { MASS } else { LANDING });
        let drift = (self.drift + lack / (mass * response)).clamp(-limit, limit);
        // Beyond the limit nothing is stored.
        if (gain * lack + drift).abs() <= limit || drift.abs() < self.drift.abs() {
            self.drift = drift;
        }
        self.speed = (gain * lack + self.drift).clamp(-limit, limit);
    }
}

/// Whether all particles are behind a wall that touches none: it moves away from them, and meets nothing any more. Planes have no end, and periodic axes
/// bring particles back.
fn is_past_all(model: &Model, state: &State, wall: usize) -> bool {
    let (body, setup) = (&model.walls[wall], &model.setup);
    let Some(servo) = &body.servo else { return false };
    let returns = (0..3).any(|a| setup.periodic[a].is_some() && servo.direction[a] != 0.0);
    let [lo, hi] = body.bounds;
    if returns || state.servos[wall].governor.speed <= 0.0 || !lo.iter().chain(&hi).all(|x| x.is_finite()) {
        return false;
    }
    let pose = pose(model, state, wall, state.time());
    let corner = |k: usize| Vec3::from([0, 1, 2].map(|a| if k >> a & 1 == 1 { hi[a] } else { lo[a] }));
    let rear = (0..8).map(|k| pose.position(&corner(k)).dot(&servo.direction)).fold(f64::INFINITY, f64::min);
    let present = |k: &usize| !state.zones.is_gone(*k);
    let particles = (0..state.particles.len()).filter(present);
    let front = particles
        .map(|k| state.particles.position(k).dot(&servo.direction) + state.particles.rows[k].radius());
    let front = front.fold(f64::NEG_INFINITY, f64::max);
    front > f64::NEG_INFINITY && front < rear
}
