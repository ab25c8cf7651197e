//! Prescribed motion, in closed form from the state at one time: no drift, and the same bits after a resume.

use crate::model::{Entrance, Halt, Model};
use crate::neighbours::NeighbourLists;
use crate::passes::touching::position_before;
use crate::passes::zones::history::restore_history;
use crate::passes::zones::idle_contacts::held;
use crate::passes::zones::room::{self, InWall};
use crate::passes::zones::whole::test_point;
use crate::setup::Particle;
use crate::state::bonds::row_of;
use crate::state::clump::quaternion;
use crate::state::ledger::carried;
use crate::state::{Direction, Kinematics, ListStatus, PathEnd, State, ZoneParticle};
use geom::Vec3;
use laws::simd::Row4;
use laws::space::sphere::away;

/// Moves all zone particles, and ends the motion of those that are through their zone, or are inserted and have met something on their way.
///
/// # Errors
/// One that is inserted becomes free inside a wall. The pass is whole.
pub fn move_zone_particles(model: &Model, state: &mut State, lists: &mut NeighbourLists) -> Result<(), Halt> {
    let (now, met) = (state.time(), room::met(model, state, lists));
    let mut halt = Ok(());
    let mut zone_particles = std::mem::take(&mut state.zones.zone_particles);
    // All members of a clump follow one path.
    let mut ended = Vec::new();
    zone_particles.retain(|t| {
        let stage = state.zones.paths.get_mut(&t.passing_id).map(|path| path.follow(now));
        let (centre, flow) = follow_motion(model, state, t, now);
        let zone = *t.zone(&state.zones);
        let past = zone.plane.signed_distance(&centre) + t.lead;
        match (t.direction, stage) {
            (Direction::Out(outlet), _) => {
                // One that falls back has been recorded all the same.
                let back = past < 0.0 && !(flow.velocity.dot(&zone.plane.normal) > 0.0);
                if past < zone.length && !back {
                    return true;
                }
                if back && test_point(state, t.at as usize).is_some() {
                    state.zones.lost.returned.fallen[outlet as usize] += 1;
                }
                exclude(model, state, lists, t.at as usize);
                false
            }
            (Direction::In(_), Some(PathEnd::Open)) => true,
            (Direction::In(_), Some(PathEnd::Gone)) => {
                ended.push(t.passing_id);
                state.zones.ids.remove(&t.start.id);
                state.zones.take_histories(t.start.id);
                exclude(model, state, lists, t.at as usize);
                false
            }
            (Direction::In(_), None) if met.taken.contains(&t.passing_id) => {
                exclude(model, state, lists, t.at as usize);
                false
            }
            (Direction::In(_), None) if now < t.since || past < 0.0 && !met.freed.contains(&t.passing_id) => {
                true
            }
            (Direction::In(i), _) => {
                ended.push(t.passing_id);
                if let (true, Some(InWall { wall, overlap })) =
                    (halt.is_ok(), room::in_wall(model, state, lists, t))
                {
                    let (id, position, by) = (t.start.id, centre, Entrance::of(i, model.setup.guards.cuts));
                    let wall = model.setup.walls[wall].name.clone();
                    halt = Err(Halt::FreeInWall { time: now, id, by, wall, position, overlap });
                }
                release(model, state, lists, t, i, centre, &flow);
                false
            }
        }
    });
    ended.iter().for_each(|id| drop(state.zones.paths.remove(id)));
    state.zones.zone_particles = zone_particles;
    for id in &met.taken {
        state.zones.put_back(*id);
        // Its rows leave before it is listed again.
        state.listing.outdate(ListStatus::Outdated);
    }
    halt
}

/// Moves a zone particle to where it is at a time [s]; the position of its centre then, and how that moves.
pub fn follow_motion(model: &Model, state: &mut State, t: &ZoneParticle, time: f64) -> (Vec3, Kinematics) {
    let flow = t.centre_flow(time, &state.zones, &model.setup);
    let (centre, own) = (t.centre + flow.shift, t.own(flow, time, &state.zones));
    position(model, state, t.at as usize, t.start.position + own.shift, &own);
    if !state.bonds.none() {
        state.bonds.turns[t.at as usize] = row_of(&t.has_turned(time, &flow, &state.zones));
    }
    if let Some(turn) = &t.turn {
        let turned = t.turned_since(time, &flow, &state.zones) * quaternion(turn);
        state.clumps.carry(t.at as usize, centre, &flow, turned);
    }
    (centre, flow)
}

/// Puts particle `k` where a flow has it: at the image that is nearest to where it was listed.
fn position(model: &Model, state: &mut State, k: usize, mut position: Vec3, flow: &Kinematics) {
    let home = state.particles.home[k];
    for (axis, range) in model.setup.periodic.iter().enumerate() {
        if let Some((lo, hi)) = range {
            position[axis] += (hi - lo) * ((home[axis] - position[axis]) / (hi - lo)).round();
        }
    }
    let (v, a, spin) = (flow.velocity, flow.acceleration, flow.spin);
    let row = &mut state.particles.rows[k];
    (row[0], row[1], row[2], row[4], row[5], row[6]) = (position.x, position.y, position.z, v.x, v.y, v.z);
    state.particles.acceleration[k] = Row4::of(a);
    if let Some(row) = state.particles.spins.get_mut(k) {
        *row = Row4::of(spin);
    }
    if let Some(angular_acceleration) = state.particles.angular_acceleration.get_mut(k) {
        *angular_acceleration = Row4::default();
    }
    if (position - home.vector()).norm() > home[3] {
        state.listing.outdate(ListStatus::MarginLeft);
    }
}

/// Out of reach of all others until the next listing drops it.
pub fn exclude(model: &Model, state: &mut State, lists: &NeighbourLists, k: usize) {
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
    state.zones.prescribed[k] = false;
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
    state.clumps.release(k, if since.is_finite() { since.clamp(0.0, model.dt) } else { 0.0 });
    if model.setup.ledger {
        let Kinematics { velocity, spin, .. } = *flow;
        let free = Particle { position: state.particles.position(k), velocity, spin, ..t.start };
        state.ledger.entered += match state.clumps.energy_at(k, &model.setup) {
            None => carried(&free, &model.setup).iter().sum::<f64>(),
            Some(energy) => energy,
        };
    }
    state.zones.prescribed[k] = false;
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
