//! Which particles pass a storage plane in a step, and when within it.
//!
//! A step moves a particle along a parabola; its passage is where what is tested of it meets the plane there:
//!
//! ```text
//! d(b) = d − v b + ½ a b² = 0        b [s] before the end of the step, v and a along the normal at the end and in the step
//! b = 2 d / (v + √(v² − 2 a d))
//! ```

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::passes::ledger::carried_in_the_middle;
use crate::passes::touching::touching;
use crate::passes::zones::held_back;
use crate::passes::zones::idle_contacts::take_along;
use crate::passes::zones::removed::take_out;
use crate::passes::zones::travel::follow_motion;
use crate::passes::zones::whole::{rows_with, test_point, test_point_before};
use crate::setup::{Crossing, EntryClump, Particle, Touch, ZoneMotion, cluster_of};
use crate::state::clumps::starts;
use crate::state::{Direction, ListStatus, State, ZoneParticle};
use geom::Vec3;
use nalgebra::UnitQuaternion;

/// What a particle has to do with a storage plane.
enum PlanePassage {
    /// It is so far past it [m], and free.
    Past(f64),
    /// It was past it without a crossing, and has come back.
    Back,
    /// It has crossed, gone on freely, and come back; or is through the zone.
    Leaves(Leave),
}

/// How a particle that has crossed leaves, which was free in the zone.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Leave {
    FallenBack,
    Through,
}

/// What a step has done at storage planes.
#[derive(Default)]
struct Found {
    /// Particles that have passed one, with their states there.
    crossings: Vec<(usize, Crossing)>,
    /// Those that leave behind one, of which outlet, and how.
    leaving: Vec<(usize, usize, Leave)>,
}

/// b of the module's head.
fn since_passage(past: f64, speed: f64, acceleration: f64) -> f64 {
    let square = speed * speed - 2.0 * acceleration * past;
    2.0 * past / (speed + square.max(0.0).sqrt())
}

pub fn find_crossings(model: &Model, state: &mut State, lists: &NeighbourLists) {
    let mut found = Found::default();
    for outlet in 0..state.zones.outlets.len() {
        cross_outlet(model, state, lists, outlet, &mut found);
    }
    for (k, outlet, leave) in found.leaving {
        state.zones.crossed[outlet].remove(&state.particles.id[k]);
        // One that falls back has been recorded all the same.
        state.zones.lost.returned.fallen[outlet] += u64::from(leave == Leave::FallenBack);
        take_out(model, state, lists, k);
    }
    // A particle that passes several planes in one step passes the first of them.
    let mut found = found.crossings;
    found.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.time.total_cmp(&b.1.time)).then(a.1.outlet.cmp(&b.1.outlet)));
    found.dedup_by_key(|f| f.0);
    for (k, crossing) in found {
        take_over(model, state, lists, k, crossing);
    }
    state.zones.crossings.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.particle.id.cmp(&b.particle.id)));
}

/// Finds the particles that have passed one plane, and those that leave behind it.
fn cross_outlet(model: &Model, state: &mut State, lists: &NeighbourLists, outlet: usize, found: &mut Found) {
    let left_margin = state.listing.status != ListStatus::Valid;
    let near = std::mem::take(&mut state.zones.near[outlet]);
    let all = || 0..state.particles.len() as u32;
    debug_assert!(
        left_margin || all().all(|k| passage(state, outlet, k as usize).is_none() || near.contains(&k))
    );
    // A particle that has just left its margin may be anywhere.
    let looked_at = if left_margin { all().collect() } else { Vec::new() };
    for &k in if left_margin { &looked_at } else { &near } {
        let k = k as usize;
        match passage(state, outlet, k) {
            None => {}
            Some(PlanePassage::Back) => {
                state.zones.beyond[outlet].remove(&state.particles.id[k]);
                state.zones.lost.returned.outlets[outlet] += 1;
            }
            Some(PlanePassage::Leaves(leave)) => found.leaving.push((k, outlet, leave)),
            Some(PlanePassage::Past(past)) => {
                let crossing = crossing(model, state, lists, k, outlet as u32, past);
                // One that does not move with the flow has not passed yet: carried on by its velocity, it would never leave.
                if crossing.particle.velocity.dot(&state.zones.outlets[outlet].plane.normal) > 0.0 {
                    found.crossings.push((k, crossing));
                }
            }
        }
    }
    state.zones.near[outlet] = near;
}

/// What particle `k` has to do with a storage plane now.
fn passage(state: &State, outlet: usize, k: usize) -> Option<PlanePassage> {
    let (zones, id) = (&state.zones, state.particles.id[k]);
    if zones.gone[k] {
        return None;
    }
    let (position, radius) = test_point(state, k)?;
    let past = zones.outlets[outlet].past(&position, radius);
    if zones.crossed[outlet].contains(&id) {
        let leave = if past < 0.0 { Leave::FallenBack } else { Leave::Through };
        return (!(0.0..zones.outlets[outlet].length).contains(&past)).then_some(PlanePassage::Leaves(leave));
    }
    let beyond = &zones.beyond[outlet];
    match past < 0.0 {
        true => beyond.contains(&id).then_some(PlanePassage::Back),
        false => {
            let passes = !zones.prescribed[k] && !beyond.contains(&id) && !zones.has_crossed(id);
            passes.then_some(PlanePassage::Past(past))
        }
    }
}

/// Particle `k`, and all members of its clump, move by the motion of the zone from its passage on.
///
/// Where paths are recorded they stay free: a prescribed motion, of which forces change nothing, would hold back what is denser than free fall, as a
/// stream is that has just left a mouth.
fn take_over(model: &Model, state: &mut State, lists: &NeighbourLists, k: usize, crossing: Crossing) {
    held_back::count(state, k, &crossing);
    let (since, outlet) = (crossing.time, crossing.outlet as usize);
    let zone = state.zones.outlets[outlet];
    if zone.motion == ZoneMotion::Recorded {
        state.zones.crossed[outlet].insert(state.particles.id[k]);
        state.zones.crossings.push(crossing);
        return;
    }
    if model.setup.ledger {
        book_leaving(model, state, k);
        take_along(model, state, lists, k);
    }
    let (starts, turn) = starts(&crossing.particle, crossing.clump.as_ref(), &model.setup);
    let (centre, lead) = (crossing.particle.position, zone.lead(crossing.particle.radius));
    for (at, start) in rows_with(state, k).into_iter().zip(starts) {
        let k = at as usize;
        state.zones.prescribed[k] = true;
        if let Some(sleepers) = &mut state.sleepers {
            sleepers.wake_particle(k);
        }
        state.clumps.take(k);
        let direction = Direction::Out(crossing.outlet);
        let (turned, passing_id) = (crossing.turn, crossing.particle.id);
        let particle_in_zone =
            ZoneParticle { at, since, start, passing_id, centre, lead, turn, turned, direction, clear: true };
        follow_motion(model, state, &particle_in_zone, state.time());
        state.zones.zone_particles.push(particle_in_zone);
    }
    state.zones.crossings.push(crossing);
}

/// What leaves the ledger with free particle `k`, and all that passes together with it: what they had in the middle of the last move. From then on the
/// work of what they still act on is that of zone particles.
pub fn book_leaving(model: &Model, state: &mut State, k: usize) {
    let of_clump = state.clumps.energy_before_half(k, &model.setup, model.dt);
    state.ledger.left += of_clump.unwrap_or_else(|| carried_in_the_middle(model, state, k));
}

/// State of particle `k` at its passage; its tested point is now `past` [m] behind the plane.
fn crossing(
    model: &Model,
    state: &State,
    lists: &NeighbourLists,
    k: usize,
    outlet: u32,
    past: f64,
) -> Crossing {
    let zone = &state.zones.outlets[outlet as usize];
    let (velocity, acceleration) = motion_of(state, k);
    // Past the plane at the start of the step already, but not with the flow: it passes now.
    let (before, radius) = test_point_before(model, state, k);
    let late = zone.past(&before, radius) >= 0.0;
    let back = if late {
        0.0
    } else {
        since_passage(past, velocity.dot(&zone.plane.normal), acceleration.dot(&zone.plane.normal))
    };
    let back = if back.is_finite() { back.clamp(0.0, model.dt) } else { 0.0 };
    // A passage belongs to its step: rounding must not put it before a sample that was taken when the step began.
    let began = state.steps.saturating_sub(1) as f64 * model.dt;
    let time = (state.time() - back).max(began);
    let mut touches: Vec<Touch> = Vec::new();
    rows_with(state, k).iter().for_each(|&m| touches.extend(touching(model, state, lists, m as usize)));
    let (particle, clump) = state_back(model, state, k, back);
    let turn = turn_back(model, state, k, back);
    let bonds = state.bonds.crossing(k, &state.particles.id);
    let cluster = cluster_of(&state.clusters, particle.id);
    Crossing { time, outlet, particle, clump, turn, cluster, touching: touches, bonds }
}

/// Velocity and acceleration of the tested point of particle `k`.
fn motion_of(state: &State, k: usize) -> (Vec3, Vec3) {
    let own = (state.particles.rows[k].velocity(), state.particles.acceleration[k].vector());
    state.clumps.body_of(k).map_or(own, |clump| (clump.velocity, clump.acceleration))
}

/// How particle `k` had turned a time `back` [s] before the end of the step.
fn turn_back(model: &Model, state: &State, k: usize, back: f64) -> Option<UnitQuaternion<f64>> {
    let turn = state.bonds.turn_of(k)?;
    let (w, a) = (&state.particles.spins[k], &state.particles.angular_acceleration[k]);
    let by = [0, 1, 2].map(|axis| (0.5 * model.dt * a[axis] - w[axis]) * back);
    Some(crate::space::rotation::spun(&Vec3::from(by)) * turn)
}

/// State of particle `k`, or of the clump that it is a member of, a time `back` [s] before the end of the step.
pub fn state_back(model: &Model, state: &State, k: usize, back: f64) -> (Particle, Option<EntryClump>) {
    match state.clumps.state_back(k, back, model.dt, &model.setup) {
        None => (sphere_back(state, k, back), None),
        Some((particle, clump)) => (particle, Some(clump)),
    }
}

/// State of a sphere a time `back` [s] before the end of the step.
fn sphere_back(state: &State, k: usize, back: f64) -> Particle {
    let p = &state.particles;
    let (velocity, a) = motion_of(state, k);
    let (spin, angular_acceleration) = p.rotation(k);
    let position = p.position(k) - velocity * back + a * (0.5 * back * back);
    let (velocity, spin) = (velocity - a * back, spin - angular_acceleration * back);
    Particle { id: p.id[k], material: p.material[k], radius: p.rows[k].radius(), position, velocity, spin }
}
