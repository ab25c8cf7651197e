//! Prescribed motion, in closed form from the state at one time: no drift, and the same bits after a resume.

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::passes::touching::position_before;
use crate::passes::zones::ledger::held;
use crate::passes::zones::memory::restore_history;
use crate::passes::zones::whole::test_point;
use crate::setup::{Particle, Zone};
use crate::simd::Row4;
use crate::space::sphere::away;
use crate::state::clump::quaternion;
use crate::state::ledger::carried;
use crate::state::path::PathStage;
use crate::state::zone_particle::{Direction, Kinematics, ZoneParticle};
use crate::state::{ListStatus, State};
use geom::Vec3;

pub fn move_zone_particles(model: &Model, state: &mut State, lists: &mut NeighbourLists) {
    let now = state.time();
    let mut zone_particles = std::mem::take(&mut state.zones.zone_particles);
    // All members of a clump follow one path.
    let mut ended = Vec::new();
    zone_particles.retain(|t| {
        let stage = state.zones.paths.get_mut(&t.whose).map(|path| path.follow(now));
        let (centre, flow) = follow_motion(model, state, t, now);
        let zone = *t.zone(&state.zones);
        let past = zone.plane.signed_distance(&centre) + t.lead;
        match (t.way, stage) {
            (Direction::Out(o), _) => stays_in_zone(model, state, lists, t, o, (&zone, past), &flow),
            (Direction::In(_), Some(PathStage::Inside)) => true,
            (Direction::In(_), Some(PathStage::Gone)) => {
                ended.push(t.whose);
                state.zones.ids.remove(&t.start.id);
                state.zones.told(t.start.id);
                exclude(model, state, lists, t.at as usize);
                false
            }
            (Direction::In(_), None) if now < t.since || past < 0.0 => true,
            (Direction::In(i), _) => {
                ended.push(t.whose);
                release(model, state, lists, t, i, centre, &flow);
                false
            }
        }
    });
    ended.iter().for_each(|id| drop(state.zones.paths.remove(id)));
    state.zones.zone_particles = zone_particles;
}

/// Puts a traveller where it is at a time [s]; where its centre is then, and how that flows.
pub fn follow_motion(model: &Model, state: &mut State, t: &ZoneParticle, time: f64) -> (Vec3, Kinematics) {
    let flow = t.centre_flow(time, &state.zones, &model.setup);
    let (centre, own) = (t.centre + flow.shift, t.own(flow, time, &state.zones));
    place(model, state, t.at as usize, t.start.position + own.shift, &own);
    if !state.bonds.none() {
        state.bonds.put_turn(t.at as usize, t.has_turned(time, &flow, &state.zones));
    }
    if let Some(turn) = &t.turn {
        let turned = t.turned_since(time, &flow, &state.zones) * quaternion(turn);
        state.bodies.carry(t.at as usize, centre, flow.velocity, (turned, flow.spin));
    }
    (centre, flow)
}

/// Whether a particle that is `past` a storage plane stays in its zone; otherwise it is out of the calculation.
fn stays_in_zone(
    model: &Model,
    state: &mut State,
    lists: &mut NeighbourLists,
    t: &ZoneParticle,
    outlet: u32,
    (zone, past): (&Zone, f64),
    flow: &Kinematics,
) -> bool {
    // One that falls back has been recorded all the same.
    let back = past < 0.0 && !(flow.velocity.dot(&zone.plane.normal) > 0.0);
    let stays = past < zone.length && !back;
    if !stays {
        if back && test_point(state, t.at as usize).is_some() {
            state.zones.lost.fell_back(outlet);
        }
        exclude(model, state, lists, t.at as usize);
    }
    stays
}

/// Puts particle `k` where a flow has it: at the image that is nearest to where it was listed.
pub fn place(model: &Model, state: &mut State, k: usize, mut place: Vec3, flow: &Kinematics) {
    let home = state.particles.home[k];
    for (axis, range) in model.setup.periodic.iter().enumerate() {
        if let Some((lo, hi)) = range {
            place[axis] += (hi - lo) * ((home[axis] - place[axis]) / (hi - lo)).round();
        }
    }
    let (v, a, spin) = (flow.velocity, flow.acceleration, flow.spin);
    let row = &mut state.particles.rows[k];
    (row[0], row[1], row[2], row[4], row[5], row[6]) = (place.x, place.y, place.z, v.x, v.y, v.z);
    state.particles.acceleration[k] = Row4([a.x, a.y, a.z, 0.0]);
    if let Some(row) = state.particles.spins.get_mut(k) {
        *row = Row4([spin.x, spin.y, spin.z, 0.0]);
    }
    if let Some(turning) = state.particles.turning.get_mut(k) {
        *turning = Row4::default();
    }
    if (place - Vec3::new(home[0], home[1], home[2])).norm() > home[3] {
        state.listing.outdate(ListStatus::MarginLeft);
    }
}

/// Out of everyone's reach until the next listing drops it.
fn exclude(model: &Model, state: &mut State, lists: &mut NeighbourLists, k: usize) {
    if model.setup.ledger {
        let held = held(model, state, lists, k) + state.bonds.held(k);
        state.ledger.left += held;
        state.ledger.passed += held;
    }
    state.bonds.leave(k);
    state.zones.left.push((k as u32, state.particles.home[k]));
    let far = away(k);
    state.particles.rows[k][..3].copy_from_slice(&far);
    state.particles.home[k][..3].copy_from_slice(&far);
    state.zones.busy[k] = false;
    state.zones.gone[k] = true;
}

/// Past the calculation plane, in the flow of its centre.
fn release(
    model: &Model,
    state: &mut State,
    lists: &mut NeighbourLists,
    t: &ZoneParticle,
    inlet: u32,
    centre: Vec3,
    flow: &Kinematics,
) {
    let k = t.at as usize;
    let zone = &state.zones.inlets[inlet as usize];
    let since = (zone.plane.signed_distance(&centre) + t.lead) / flow.velocity.dot(&zone.plane.normal);
    state.bodies.release(k, if since.is_finite() { since.clamp(0.0, model.dt) } else { 0.0 });
    if model.setup.ledger {
        let Kinematics { velocity, spin, .. } = *flow;
        let free = Particle { position: state.particles.position(k), velocity, spin, ..t.start };
        state.ledger.entered += match state.bodies.energy_at(k, &model.setup) {
            None => carried(&free, &model.setup).iter().sum::<f64>(),
            Some(energy) => energy,
        };
    }
    state.zones.busy[k] = false;
    state.starting.push(k as u32);
    restore_history(model, state, lists, k);
    if test_point(state, k).is_none() {
        return;
    }
    // What passes a storage plane in this very step crosses it.
    let before = match t.turn {
        None => position_before(model, state, k),
        Some(_) => centre - (flow.velocity - flow.acceleration * (0.5 * model.dt)) * model.dt,
    };
    for (zone, beyond) in state.zones.outlets.iter().zip(&mut state.zones.beyond) {
        let radius = if t.turn.is_some() { 0.0 } else { t.start.radius };
        if zone.past(&before, radius) >= 0.0 {
            beyond.insert(state.particles.id[k]);
        }
    }
    state.zones.lost.freed(k, inlet);
}
