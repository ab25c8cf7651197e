//! Entries: checked when they are queued, added to the particles when they are due.

use crate::model::in_range::out_of_range;
use crate::model::{Allowed, Check, Entrance, Halt, Model, SetupError, Subject};
use crate::neighbours::NeighbourLists;
use crate::passes::zones::removed;
use crate::passes::zones::room::Room;
use crate::setup::bond::join;
use crate::setup::clumps::members;
use crate::setup::{Entry, EntryClump, Particle, Setup, WallShape, WhenBlocked, Zone, ZoneMotion};
use crate::state::clumps::starts;
use crate::state::{Direction, Kinematics, LOOK_AHEAD, ListStatus, Path, State, ZoneParticle, Zones};
use geom::Vec3;
use std::collections::BTreeSet;

impl Zones {
    /// Queues an entry.
    pub fn enter(&mut self, entry: Entry, now: f64, setup: &Setup) -> Result<(), SetupError> {
        let id = entry.particle.id;
        let before = now.max(self.latest);
        if entry.time < before {
            return Err(SetupError::EntryLate { id, time: entry.time, now: before });
        }
        announced(&entry, setup)?;
        let Some(zone) = self.inlets.get(entry.inlet as usize).copied() else {
            let (quantity, value) = (Subject::Entry(id).quantity("inlet"), entry.inlet.into());
            return Err(out_of_range(quantity, value, "[–]", Allowed::IndexOf("inlets")));
        };
        // Seen again before it was out of sight: entries come ahead of their time.
        if zone.motion == ZoneMotion::Recorded && self.comes_back(&entry, setup)? {
            self.latest = entry.time;
            return Ok(());
        }
        let path = match zone.motion {
            ZoneMotion::Recorded => Some(Path::new(&entry)),
            _ => {
                arrives(&entry, &zone, setup)?;
                None
            }
        };
        let members = entry.clump.map_or(1, |c| members(&c, setup));
        for id in (0..members).map(|k| id.wrapping_add(k)) {
            if !self.ids.insert(id) {
                return Err(SetupError::DuplicateEntryId { id, time: entry.time });
            }
        }
        self.paths.extend(path.map(|path| (id, path)));
        self.latest = entry.time;
        self.pending.push_back(entry);
        Ok(())
    }
}

/// Refuses what the inlet did not announce.
fn announced(entry: &Entry, setup: &Setup) -> Result<(), SetupError> {
    let Particle { id, radius, position, velocity, spin, material } = entry.particle;
    let quantity = |name| Subject::Entry(id).quantity(name);
    let numbers = position.iter().chain(&velocity).chain(&spin).chain([&entry.time]);
    if let Some(&wrong) = numbers.into_iter().find(|x| !x.is_finite()) {
        return Err(out_of_range(quantity("state"), wrong, "", "the finite numbers"));
    }
    if let Some(clump) = &entry.clump {
        return crate::model::clumps::check_entry(clump, &entry.particle, setup);
    }
    if !setup.entry_materials.contains(&material) {
        let value = material.into();
        return Err(out_of_range(quantity("material"), value, "[–]", "what the inlet announced"));
    }
    if !(radius >= setup.smallest_entry && radius <= setup.largest_entry) {
        return Err(out_of_range(quantity("radius"), radius, "m", "what the inlet announced"));
    }
    Check(|| Subject::Entry(id)).near("position", &position, radius)
}

/// Refuses an entry that never gets to the calculation plane, or becomes free behind a plane at rest.
fn arrives(entry: &Entry, zone: &Zone, setup: &Setup) -> Result<(), SetupError> {
    let p = &entry.particle;
    let past = zone.plane.signed_distance(&p.position) + lead(p, entry.clump.as_ref(), zone, setup);
    let Some(time) = zone.arrives_after(past, &p.velocity, &setup.gravity) else {
        let speed = zone.plane.normal.dot(&p.velocity);
        let quantity = Subject::EntryAlongFlow(p.id).quantity("velocity");
        let allowed = "what brings it to the calculation plane: above 0, or in free fall";
        return Err(out_of_range(quantity, speed, "m/s", allowed));
    };
    let flow = Kinematics::after(time, p, zone.acceleration(&setup.gravity));
    let free = p.position + flow.shift;
    for wall in setup.walls.iter().filter(|w| !w.moves()) {
        let WallShape::Plane(plane) = &wall.shape else { continue };
        let depth = -plane.signed_distance(&free);
        if depth >= 0.0 {
            return Err(SetupError::EntryBehindPlane { id: p.id, depth, wall: wall.name.clone() });
        }
    }
    Ok(())
}

/// How far before the centre of an entry the point lies that is tested [m].
fn lead(p: &Particle, clump: Option<&EntryClump>, zone: &Zone, setup: &Setup) -> f64 {
    let Some(EntryClump { shape, scale, orientation }) = clump else { return zone.lead(p.radius) };
    let shape = &setup.clumps.shapes[*shape as usize];
    let (turn, normal) = (orientation * shape.frame, zone.plane.normal);
    // Of spheres, so that `test = "centre"` tests the centre.
    let of = |(centre, radius): &(Vec3, f64)| match zone.lead(radius * scale) {
        0.0 => 0.0,
        radius => normal.dot(&(turn * (centre * *scale))) + radius,
    };
    shape.spheres.iter().map(of).fold(f64::NEG_INFINITY, f64::max)
}

/// Entries due until time() + this [s] must have been given before the next step.
pub fn look_ahead(model: &Model) -> f64 {
    model.dt * LOOK_AHEAD as f64
}

/// Entries that wait for room in one insertion, and of which the places are looked at: the time of a look does not grow with their number.
const LOOKED_AT: usize = 256;

/// Adds entries that are due, and those due soon, to the particles, as far as there is room for what is inserted; the lists are those of before.
///
/// # Errors
/// There is no room for one, and its insertion is to stop the run.
pub fn insert_due(model: &Model, state: &mut State, lists: &NeighbourLists) -> Result<(), Halt> {
    let (now, zones) = (state.time(), &state.zones);
    let due = zones.pending.front().is_some_and(|e| e.time <= now);
    if !due && (zones.waiting.is_empty() || state.steps < zones.look_again) {
        return Ok(());
    }
    // What was due to be given before the last step, with a step for rounding: when a state is observed, what the next step must know has not been given yet, and
    // observing changes nothing.
    let (horizon, first) = (now + look_ahead(model) - 2.0 * model.dt, state.particles.len());
    let mut coming = std::mem::take(&mut state.zones.waiting);
    let waited = coming.len();
    coming.iter_mut().for_each(|e| e.time = now);
    while let Some(e) = state.zones.pending.pop_front_if(|e| e.time <= horizon) {
        coming.push_back(e);
    }
    let room = Room::near(model, state, coming.iter(), horizon - now);
    state.zones.announced.retain(|e| e.time > now);
    let (mut halt, mut looked_at) = (Ok(()), vec![0; state.zones.inlets.len()]);
    let mut later = Vec::new();
    for n in 0..coming.len() {
        let (e, waits) = (coming[n], n < waited);
        looked_at[e.inlet as usize] += usize::from(waits);
        if waits && looked_at[e.inlet as usize] > LOOKED_AT {
            state.zones.waiting.push_back(e);
            continue;
        }
        let looks = state.zones.inlets[e.inlet as usize].when_blocked.is_some();
        match looks.then(|| room.taken_by(model, state, &e)).flatten() {
            None => {
                add(model, state, &e, now);
                state.zones.announced.extend((looks && e.time > now).then_some(e));
            }
            // What has its place may have gone by then: that is decided when it is due.
            Some(_) if e.time > now => later.push(e),
            Some(k) => halt = no_room(model, state, e, state.particles.id[k], waits),
        }
        if halt.is_err() {
            // Nothing is lost: a run that goes on begins with what has no room.
            later.extend(coming.iter().skip(n));
            break;
        }
    }
    later.into_iter().rev().for_each(|e| state.zones.pending.push_front(e));
    state.zones.look_again = state.steps + LOOK_AHEAD;
    count_waiting(state);
    if state.particles.len() > first {
        forget_clusters(state);
        removed::make_room(model, state, lists, first);
        state.listing.outdate(ListStatus::Outdated);
    }
    halt
}

/// What becomes of an entry whose place particle `other` has; `again`: it waited before.
fn no_room(model: &Model, state: &mut State, e: Entry, other: u32, again: bool) -> Result<(), Halt> {
    let (time, zones) = (state.time(), &mut state.zones);
    let counted = zones.lost.returned.no_room(e.inlet);
    match zones.inlets[e.inlet as usize].when_blocked.unwrap_or_default() {
        WhenBlocked::Wait => {
            counted.waited += u64::from(!again);
            zones.waiting.push_back(e);
        }
        WhenBlocked::Skip => {
            counted.skipped += 1;
            let members = e.clump.map_or(1, |c| members(&c, &model.setup));
            for k in 0..members {
                zones.ids.remove(&e.particle.id.wrapping_add(k));
            }
        }
        WhenBlocked::Stop => {
            let by = Entrance::of(e.inlet, model.setup.guards.cuts);
            let (id, position) = (e.particle.id, e.particle.position);
            return Err(Halt::NoRoom { time, id, by, partner: other, position });
        }
    }
    Ok(())
}

/// Counts those that wait.
fn count_waiting(state: &mut State) {
    let Zones { waiting, lost, .. } = &mut state.zones;
    lost.returned.inserts.iter_mut().for_each(|insert| insert.waiting = 0);
    waiting.iter().for_each(|e| lost.returned.no_room(e.inlet).waiting += 1);
}

/// Forgets the clusters of particles that have left, once these are as many as those that are here: the list does not grow with the stream.
fn forget_clusters(state: &mut State) {
    if state.clusters.len() > 2 * state.particles.len() {
        let here: BTreeSet<u32> = state.particles.id.iter().copied().collect();
        state.clusters.retain(|(id, _)| here.contains(id));
    }
}

fn add(model: &Model, state: &mut State, e: &Entry, now: f64) {
    let zone = state.zones.inlets[e.inlet as usize];
    let flow = match state.zones.paths.get(&e.particle.id) {
        Some(path) => path.flow(now, &e.particle.position, &model.setup.gravity),
        None => Kinematics::after(now - e.time, &e.particle, zone.acceleration(&model.setup.gravity)),
    };
    let (position, velocity) = (e.particle.position + flow.shift, flow.velocity);
    let present = Particle { position, velocity, ..e.particle };
    let at = state.particles.len() as u32;
    match &e.clump {
        None => state.particles.push(&present, &model.setup.materials),
        Some(clump) => {
            let turned = (now - e.time).max(0.0);
            state.clumps.enter(&present, turned, clump, &model.setup, &mut state.particles);
        }
    }
    if e.cluster != 0 {
        let members = state.particles.len() as u32 - at;
        (0..members).for_each(|k| join(&mut state.clusters, e.particle.id.wrapping_add(k), e.cluster));
    }
    let (starts, turn) = starts(&e.particle, e.clump.as_ref(), &model.setup);
    let (centre, lead) = (e.particle.position, lead(&e.particle, e.clump.as_ref(), &zone, &model.setup));
    for (at, start) in (at..).zip(starts) {
        state.zones.prescribed.push(true);
        state.zones.gone.push(false);
        state.zones.lost.push();
        if let Some(sleepers) = &mut state.sleepers {
            sleepers.push();
        }
        let (direction, turned) = (Direction::In(e.inlet), e.turn.or(e.clump.map(|c| c.orientation)));
        let passing_id = e.particle.id;
        let since = e.time;
        let particle_in_zone = ZoneParticle {
            at,
            since,
            start,
            passing_id,
            centre,
            lead,
            turn,
            turned,
            direction,
            clear: false,
        };
        state.bonds.push(particle_in_zone.has_turned(now, &flow, &state.zones));
        state.zones.zone_particles.push(particle_in_zone);
    }
}
