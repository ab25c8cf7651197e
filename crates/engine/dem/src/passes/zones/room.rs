//! Whether there is room for what an insertion brings.
//!
//! ```text
//! it is due      → a place that another particle has at that time: it waits, is left out, or the run stops
//! listed, before → it meets a free particle: it is looked at again when it is due
//! on its way     → it meets a free particle or one that comes in at another velocity, or a wall after it was clear of walls: it is free from then on
//! end of its way → it is free
//! ```
//!
//! So an insertion never puts a particle onto another one, and never pushes with more than the momentum of what it brings.

use crate::model::{Model, With};
use crate::neighbours::NeighbourLists;
use crate::passes::touching::position_before;
use crate::setup::{Entry, Particle};
use crate::state::clumps::starts;
use crate::state::{Direction, State, ZoneParticle};
use geom::Vec3;
use std::collections::BTreeSet;

/// Overlap over the smaller radius that is rounding [–].
const ROUNDING: f64 = 1e-6;
/// Overlap with a wall over its radius, up to which a particle may become free [–]: it holds 1e-4 of what the contact holds at its radius, and walls of spheres stand out by more than
/// their surface.
const INSIDE: f64 = 1e-2;

/// Entries that are due before a time, and the particles near their places.
pub struct Room {
    /// Those that were there before, and near enough to count.
    near: Vec<usize>,
    /// Rows of those that have been added since.
    first: usize,
    now: f64,
}

impl Room {
    /// For these entries, of which the last is due after a time `ahead` [s].
    pub fn near<'a>(
        model: &Model,
        state: &State,
        entries: impl Iterator<Item = &'a Entry>,
        ahead: f64,
    ) -> Room {
        let (now, periodic) = (state.time(), model.setup.periodic);
        let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
        for entry in entries.filter(|e| state.zones.inlets[e.inlet as usize].when_blocked.is_some()) {
            let p = &entry.particle;
            for x in [p.position, p.position - p.velocity * (entry.time - now).max(0.0)] {
                for axis in 0..3 {
                    low[axis] = low[axis].min(x[axis] - p.radius);
                    high[axis] = high[axis].max(x[axis] + p.radius);
                }
            }
        }
        let is_near = |&k: &usize| {
            let row = &state.particles.rows[k];
            let reach = row.radius() + row.velocity().norm() * ahead;
            !state.zones.is_gone(k)
                && (0..3).all(|axis| {
                    let beside = row[axis] + reach < low[axis] || row[axis] - reach > high[axis];
                    periodic[axis].is_some() || !beside
                })
        };
        let first = state.particles.len();
        let near = if low[0] <= high[0] { (0..first).filter(is_near).collect() } else { Vec::new() };
        Room { near, first, now }
    }

    /// The particle that has the place of an entry when it is due, as both move until then; the first of them.
    pub fn taken_by(&self, model: &Model, state: &State, entry: &Entry) -> Option<usize> {
        let ahead = (entry.time - self.now).max(0.0);
        let (spheres, _) = starts(&entry.particle, entry.clump.as_ref(), &model.setup);
        let overlaps = |sphere: &Particle, k: usize| {
            let row = &state.particles.rows[k];
            let here = sphere.position - sphere.velocity * ahead;
            let apart = model.cell().nearest(row.position() - here);
            let towards = row.velocity() - sphere.velocity;
            // The nearest that they come, each on a straight way.
            let when = (-apart.dot(&towards) / towards.norm_squared()).clamp(0.0, ahead);
            let nearest = if when > 0.0 { apart + towards * when } else { apart };
            let (one, other) = (sphere.radius, row.radius());
            one + other - nearest.norm() > ROUNDING * one.min(other)
        };
        let added = self.first..state.particles.len();
        let mut all = self.near.iter().copied().chain(added);
        all.find(|&k| spheres.iter().any(|sphere| overlaps(sphere, k)))
    }
}

/// A particle that becomes free inside a wall.
pub struct InWall {
    /// Which wall.
    pub wall: usize,
    /// Overlap [m].
    pub overlap: f64,
}

/// What an inserted particle on its way had met when forces were computed.
#[derive(Default)]
struct Meets {
    /// Whether a particle that is in its way.
    particle: bool,
    /// The wall that it overlaps most.
    wall: Option<InWall>,
}

impl Meets {
    fn of(model: &Model, state: &State, lists: &NeighbourLists, t: &ZoneParticle) -> Meets {
        let (k, before) = (t.at as usize, state.time() - model.dt);
        let flow = t.own(t.centre_flow(before, &state.zones, &model.setup), before, &state.zones);
        let home = state.particles.home[k].vector();
        let here = home + model.cell().nearest(t.start.position + flow.shift - home);
        let position = |m: usize| if m == k { here } else { position_before(model, state, m) };
        let (radius, mut found) = (t.start.radius, Meets::default());
        for &end in lists.slots.of_particle(k) {
            let (slot, slots) = (end.slot(), &lists.slots);
            let segment = slots.segment_of(slot);
            let wall = if let With::Wall(wall) = segment.with { Some(wall) } else { None };
            let (partner, of_partner) = lists.partner(&state.particles, segment, slot, position);
            let first = slots.i[slot] as usize;
            let reach = state.particles.rows[first].radius() + of_partner;
            let overlap = reach - (position(first) - partner).norm();
            let other = if wall.is_some() { radius } else { reach - radius };
            if !(overlap > ROUNDING * radius.min(other)) {
                continue;
            }
            match wall {
                None => found.particle |= is_in_the_way(state, slots.other(end), flow.velocity),
                Some(wall) if found.wall.as_ref().is_none_or(|deepest| overlap > deepest.overlap) => {
                    found.wall = Some(InWall { wall, overlap });
                }
                Some(_) => {}
            }
        }
        found
    }
}

/// Whether particle `k`, which one that is inserted with a `velocity` [m/s] overlaps, is in its way: it is free, or comes in at another velocity.
fn is_in_the_way(state: &State, k: u32, velocity: Vec3) -> bool {
    if state.zones.is_free(k as usize) {
        return true;
    }
    let other = state.zones.zone_particles.iter().find(|other| other.at == k);
    let moves = state.particles.rows[k as usize].velocity();
    other.is_some_and(|other| has_come_in(state, other, state.time())) && moves != velocity
}

/// What inserted particles have met, by the id of what passes: a particle, or the first member of its clump.
#[derive(Default)]
pub struct Met {
    /// Those that have come in: they are free from now on.
    pub freed: BTreeSet<u32>,
    /// Those that are still to come in, and have met a particle that is in their way.
    pub taken: BTreeSet<u32>,
}

/// What inserted particles have met in the last step; particles are where that has put them.
pub fn met(model: &Model, state: &mut State, lists: &NeighbourLists) -> Met {
    let now = state.time();
    let mut met = Met::default();
    for n in 0..state.zones.zone_particles.len() {
        let t = &state.zones.zone_particles[n];
        if !is_watched(state, t) {
            continue;
        }
        let Meets { particle, wall } = Meets::of(model, state, lists, t);
        if !(now > t.since) {
            met.taken.extend(particle.then_some(t.passing_id));
            continue;
        }
        if particle || wall.is_some() && t.clear {
            met.freed.insert(t.passing_id);
        }
        if wall.is_none() {
            state.zones.zone_particles[n].clear = true;
        }
    }
    met
}

/// Whether a particle is being inserted, and whatever it meets counts.
pub fn is_watched(state: &State, t: &ZoneParticle) -> bool {
    let Direction::In(inlet) = t.direction else { return false };
    state.zones.inlets[inlet as usize].when_blocked.is_some()
}

/// Whether a particle is being inserted, and has come in by a time [s].
pub fn has_come_in(state: &State, t: &ZoneParticle, now: f64) -> bool {
    now > t.since && is_watched(state, t)
}

/// The wall that an inserted particle becomes free in; it has not been clear of walls on its way.
pub fn in_wall(model: &Model, state: &State, lists: &NeighbourLists, t: &ZoneParticle) -> Option<InWall> {
    if t.clear || !has_come_in(state, t, state.time()) {
        return None;
    }
    Meets::of(model, state, lists, t).wall.filter(|wall| wall.overlap > INSIDE * t.start.radius)
}
