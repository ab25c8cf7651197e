//! Prescribed motion, in closed form from the state at one time: no drift, and the same bits after a resume.

use crate::model::Model;
use crate::neighbours::NeighbourLists;
use crate::passes::touching::position_before;
use crate::passes::zones::ledger::held;
use crate::passes::zones::memory::recollect;
use crate::passes::zones::whole::tested;
use crate::setup::{Particle, Zone};
use crate::simd::Row4;
use crate::space::sphere::away;
use crate::state::State;
use crate::state::clump::quaternion;
use crate::state::ledger::carried;
use crate::state::path::Stage;
use crate::state::zone_particle::{Flow, Traveller, Way};
use geom::Vec3;

pub fn move_travellers(model: &Model, state: &mut State, lists: &mut NeighbourLists) {
    let now = state.time();
    let mut travellers = std::mem::take(&mut state.zones.travellers);
    // All members of a clump follow one path.
    let mut ended = Vec::new();
    travellers.retain(|t| {
        let stage = state.zones.paths.get_mut(&t.whose).map(|path| path.follow(now));
        let (centre, flow) = carry_on(model, state, t, now);
        let zone = *t.zone(&state.zones);
        let past = zone.plane.signed_distance(&centre) + t.lead;
        match (t.way, stage) {
            (Way::Out(o), _) => stays_behind(model, state, lists, t, o, (&zone, past), &flow),
            (Way::In(_), Some(Stage::Inside)) => true,
            (Way::In(_), Some(Stage::Gone)) => {
                ended.push(t.whose);
                state.zones.ids.remove(&t.start.id);
                state.zones.told(t.start.id);
                exclude(model, state, lists, t.at as usize);
                false
            }
            (Way::In(_), None) if now < t.since || past < 0.0 => true,
            (Way::In(i), _) => {
                ended.push(t.whose);
                let_in(model, state, lists, t, i, centre, &flow);
                false
            }
        }
    });
    ended.iter().for_each(|id| drop(state.zones.paths.remove(id)));
    state.zones.travellers = travellers;
}

/// Puts a traveller where it is at a time [s]; where its centre is then, and how that flows.
pub fn carry_on(model: &Model, state: &mut State, t: &Traveller, time: f64) -> (Vec3, Flow) {
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
fn stays_behind(
    model: &Model,
    state: &mut State,
    lists: &mut NeighbourLists,
    t: &Traveller,
    outlet: u32,
    (zone, past): (&Zone, f64),
    flow: &Flow,
) -> bool {
    // One that falls back has been recorded all the same.
    let back = past < 0.0 && !(flow.velocity.dot(&zone.plane.normal) > 0.0);
    let stays = past < zone.length && !back;
    if !stays {
        if back && tested(state, t.at as usize).is_some() {
            state.zones.lost.fell_back(outlet);
        }
        exclude(model, state, lists, t.at as usize);
    }
    stays
}

/// Puts particle `k` in its place in a flow: the one of its images that is nearest to where it was listed.
pub fn place(model: &Model, state: &mut State, k: usize, mut place: Vec3, flow: &Flow) {
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
    state.out |= (place - Vec3::new(home[0], home[1], home[2])).norm() > home[3];
}

/// Out of everyone's reach until the next listing drops it.
fn exclude(model: &Model, state: &mut State, lists: &mut NeighbourLists, k: usize) {
    if model.setup.ledger {
        let held = held(model, state, lists, k) + state.bonds.held(k);
        state.account.left += held;
        state.account.passed += held;
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
fn let_in(
    model: &Model,
    state: &mut State,
    lists: &mut NeighbourLists,
    t: &Traveller,
    inlet: u32,
    centre: Vec3,
    flow: &Flow,
) {
    let k = t.at as usize;
    let zone = &state.zones.inlets[inlet as usize];
    let since = (zone.plane.signed_distance(&centre) + t.lead) / flow.velocity.dot(&zone.plane.normal);
    state.bodies.release(k, if since.is_finite() { since.clamp(0.0, model.dt) } else { 0.0 });
    if model.setup.ledger {
        let Flow { velocity, spin, .. } = *flow;
        let free = Particle { position: state.particles.position(k), velocity, spin, ..t.start };
        state.account.entered += match state.bodies.energy_at(k, &model.setup) {
            None => carried(&free, &model.setup).iter().sum::<f64>(),
            Some(energy) => energy,
        };
    }
    state.zones.busy[k] = false;
    state.fresh.push(k as u32);
    recollect(model, state, lists, k);
    if tested(state, k).is_none() {
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
