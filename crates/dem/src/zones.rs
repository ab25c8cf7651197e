//! Zones: particles that move by a prescribed motion, feel nothing, and act on others.
//!
//! Outlet: past the storage plane a particle's state is recorded and it goes on with constant velocity to the exclusion
//! plane. Inlet: a particle appears on the generation plane at its recorded time and goes on with constant velocity to
//! the calculation plane, where it becomes free. JP5440448B2.
//!
//! A traveller's row is overwritten after each move, so that the move itself knows nothing of zones.

use crate::contacts::With;
use crate::energy::carried;
use crate::error::{Halt, SetupError};
use crate::kernel::LEDGER;
use crate::lane::Row4;
use crate::particles::Particles;
use crate::setup::{Crossing, Entry, Particle, Setup, WallShape, Zone};
use crate::simulation::Simulation;
use geom::Vec3;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Steps ahead of their time at which entries are listed, so that not every one makes lists anew.
pub const LOOK_AHEAD: u64 = 256;

/// Which zone a traveller is in.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
enum Way {
    Out(u32),
    In(u32),
}

/// A particle in a zone: x(t) = x₀ + v₀ (t − t₀).
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Traveller {
    at: u32,
    since: f64,
    start: Particle,
    /// What must be past the plane, at that time: the centre, or that of the whole clump [m].
    centre: Vec3,
    way: Way,
}

/// All zones of a simulation and who is in them.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Zones {
    outlets: Vec<Zone>,
    inlets: Vec<Zone>,
    travellers: Vec<Traveller>,
    /// For each outlet, free particles past its plane that never crossed it.
    beyond: Vec<BTreeSet<u32>>,
    pending: VecDeque<Entry>,
    crossings: Vec<Crossing>,
    /// Whether a particle is out of the calculation and waits for the next listing.
    gone: Vec<bool>,
    /// Those, and where they were when neighbours were listed.
    pub(crate) left: Vec<(u32, Row4)>,
    /// Whether a particle travels.
    busy: Vec<bool>,
    ids: BTreeSet<u32>,
    latest: f64,
    /// Inlets, from the first on, that are cuts of a plant; a guard, which a resumed run may change.
    pub(crate) cuts: u32,
    /// Particles that have become free behind a cut, and which.
    freed: BTreeMap<u32, u32>,
}

impl Zones {
    /// Zones of a setup.
    pub fn new(setup: &Setup, particles: &Particles) -> Zones {
        let past = |zone: &Zone| {
            let there = setup.particles.iter().filter(|p| zone.plane.signed_distance(&p.position) >= 0.0);
            there.map(|p| p.id).collect()
        };
        let ids =
            if setup.inlets.is_empty() { BTreeSet::new() } else { particles.id.iter().copied().collect() };
        let zones = !setup.outlets.is_empty() || !setup.inlets.is_empty();
        let flags = if zones { vec![false; particles.len()] } else { Vec::new() };
        Zones {
            outlets: setup.outlets.clone(),
            inlets: setup.inlets.clone(),
            beyond: setup.outlets.iter().map(past).collect(),
            gone: flags.clone(),
            busy: flags,
            ids,
            latest: f64::NEG_INFINITY,
            cuts: setup.guards.cuts,
            ..Zones::default()
        }
    }

    /// Whether the scene has no zone at all.
    pub fn none(&self) -> bool {
        self.outlets.is_empty() && self.inlets.is_empty()
    }

    /// Number of particles that are listed and not in the calculation.
    pub fn hidden(&self, time: f64) -> usize {
        let early = self.travellers.iter().filter(|t| t.since > time).count();
        early + self.gone.iter().filter(|&&g| g).count()
    }

    /// Whether particle `k` is listed and not in the calculation.
    pub fn is_hidden(&self, k: usize, time: f64) -> bool {
        self.is_gone(k)
            || (self.travels(k) && self.travellers.iter().any(|t| t.at as usize == k && t.since > time))
    }

    /// Whether particle `k` has passed an exclusion plane.
    pub fn is_gone(&self, k: usize) -> bool {
        self.gone.get(k) == Some(&true)
    }

    /// Whether particle `k` is in a zone.
    pub fn travels(&self, k: usize) -> bool {
        self.busy.get(k) == Some(&true)
    }

    /// Whether each particle is in a zone; empty without zones.
    pub fn busy(&self) -> &[bool] {
        &self.busy
    }

    /// Whether grains are watched that came in by a cut.
    pub fn cut(&self) -> bool {
        !self.freed.is_empty()
    }

    /// The inlet of a free particle that is behind its generation plane again, and how far [m].
    pub fn came_back(&self, k: usize, id: u32, place: &Vec3) -> Option<(u32, f64)> {
        let behind = |z: &Zone| -z.plane.signed_distance(place) - z.length;
        let cuts = &self.inlets[..(self.cuts as usize).min(self.inlets.len())];
        if self.is_gone(k) || self.travels(k) || cuts.iter().all(|z| !(behind(z) > 0.0)) {
            return None;
        }
        let &inlet = self.freed.get(&id)?;
        Some((inlet, behind(&self.inlets[inlet as usize]))).filter(|found| found.1 > 0.0)
    }

    /// Refuses a particle on its way in that moves by more than `limit` of its radius in a step.
    pub fn fast(&self, time: f64, dt: f64, limit: f64) -> Result<(), Halt> {
        for t in &self.travellers {
            let Way::In(inlet) = t.way else { continue };
            let speed = t.start.velocity.norm();
            let share = speed * dt / t.start.radius;
            if !(share <= limit) {
                return Err(Halt::TooFast { time, id: t.start.id, inlet, speed, dt, share, limit });
            }
        }
        Ok(())
    }

    /// Crossings since the last call.
    pub fn take_crossings(&mut self) -> Vec<Crossing> {
        std::mem::take(&mut self.crossings)
    }

    /// Follows the particles to their new places; `order` names the old ones of those that stay.
    pub fn reorder(&mut self, order: &[u32]) {
        if self.none() {
            return;
        }
        let mut new = vec![u32::MAX; self.busy.len()];
        for (n, &o) in order.iter().enumerate() {
            new[o as usize] = n as u32;
        }
        for t in &mut self.travellers {
            t.at = new[t.at as usize];
        }
        self.busy = order.iter().map(|&o| self.busy[o as usize]).collect();
        self.gone = vec![false; order.len()];
        self.left.clear();
    }

    /// Queues an entry.
    pub fn enter(&mut self, entry: Entry, now: f64, setup: &Setup) -> Result<(), SetupError> {
        let Particle { id, radius, .. } = entry.particle;
        let before = now.max(self.latest);
        if entry.time < before {
            return Err(SetupError::EntryLate { id, time: entry.time, now: before });
        }
        let range =
            |what: String, value: f64, unit, range| Err(SetupError::Range { what, value, unit, range });
        let Particle { position, velocity, spin, material, .. } = entry.particle;
        let numbers = position.iter().chain(&velocity).chain(&spin).chain([&entry.time]);
        if let Some(&wrong) = numbers.into_iter().find(|x| !x.is_finite()) {
            return range(format!("inlet: state of particle {id}"), wrong, "", "the finite numbers");
        }
        if let Some(clump) = &entry.clump {
            crate::bodies::check_entry(clump, id, setup)?;
        }
        if entry.clump.is_none() && !setup.entry_materials.contains(&material) {
            return range(
                format!("inlet: material of particle {id}"),
                material.into(),
                "[–]",
                "what the inlet announced",
            );
        }
        if entry.inlet as usize >= self.inlets.len() {
            return range(format!("inlet of particle {id}"), entry.inlet as f64, "[–]", "the scene's inlets");
        }
        if entry.clump.is_none() && !(radius >= setup.smallest_entry && radius <= setup.largest_entry) {
            return range(format!("inlet: radius of particle {id}"), radius, "m", "what the inlet announced");
        }
        let zone = &self.inlets[entry.inlet as usize];
        if !(zone.plane.normal.dot(&entry.particle.velocity) > 0.0) {
            let speed = zone.plane.normal.dot(&entry.particle.velocity);
            return range(
                format!("inlet: velocity of particle {id} along the flow"),
                speed,
                "m/s",
                "above 0",
            );
        }
        free_in_front(&entry.particle, zone, setup)?;
        let members = entry.clump.map_or(1, |c| setup.clumps.shapes[c.shape as usize].spheres.len() as u32);
        for id in (0..members).map(|k| id.wrapping_add(k)) {
            if !self.ids.insert(id) {
                return Err(SetupError::IdTwice(id));
            }
        }
        self.latest = entry.time;
        self.pending.push_back(entry);
        Ok(())
    }
}

/// Refuses an entry that becomes free behind a plane at rest.
fn free_in_front(p: &Particle, zone: &Zone, setup: &Setup) -> Result<(), SetupError> {
    let rate = zone.plane.normal.dot(&p.velocity);
    let free = p.position - p.velocity * (zone.plane.signed_distance(&p.position) / rate);
    for wall in setup.walls.iter().filter(|w| !w.motion.moves()) {
        let WallShape::Plane(plane) = &wall.shape else { continue };
        let depth = -plane.signed_distance(&free);
        if depth >= 0.0 {
            return Err(SetupError::EntryBehindPlane { id: p.id, depth, wall: wall.name.clone() });
        }
    }
    Ok(())
}

impl Simulation {
    /// The ledger of one step: what contacts do to travellers goes in or out, because nothing acts on them.
    pub(crate) fn account_zones(&mut self) {
        for t in &self.zones.travellers {
            let work = self.power(t.at as usize, &t.start) * self.dt;
            self.account.passed += work;
            match t.way {
                Way::In(_) => self.account.entered -= work,
                Way::Out(_) => self.account.left += work,
            }
        }
    }

    /// Of the contacts of particle `k` on it [W], in the step before the last move.
    fn power(&self, k: usize, state: &Particle) -> f64 {
        let (force, moment) = self.all_loads().on(k, state.radius, self.particles.rotates());
        Vec3::from(force).dot(&state.velocity) + Vec3::from(moment).dot(&state.spin)
    }

    /// Elastic energy [J] of the contacts of particle `k` with those that have not left before it.
    fn held(&self, k: usize) -> f64 {
        let c = &self.contacts;
        let entries = &c.entries[c.starts[k] as usize..c.starts[k + 1] as usize];
        let of = |&entry: &u32| {
            let (place, second) = ((entry >> 1) as usize, entry & 1 == 1);
            let wall = matches!(self.kinds[c.segment_of(place).kind].with, With::Wall(_));
            let other = if second { c.i[place] } else { c.partner[place] } as usize;
            if !wall && self.zones.is_gone(other) { 0.0 } else { c.ledger[place * LEDGER] }
        };
        entries.iter().map(of).sum()
    }

    /// Adds entries that are due, and those due soon, to the particles.
    pub(crate) fn admit(&mut self) {
        let now = self.time();
        if self.zones.pending.front().is_none_or(|e| e.time > now) {
            return;
        }
        let horizon = now + self.look_ahead();
        while let Some(e) = self.zones.pending.pop_front_if(|e| e.time <= horizon) {
            let at = self.particles.len() as u32;
            let mut particle = e.particle;
            particle.position += particle.velocity * (now - e.time);
            let starts = match &e.clump {
                None => {
                    self.particles.push(&particle, &self.setup.materials);
                    vec![e.particle]
                }
                Some(clump) => {
                    self.bodies.enter(&e.particle, clump, now - e.time, &self.setup, &mut self.particles)
                }
            };
            for (at, start) in (at..).zip(starts) {
                self.zones.busy.push(true);
                self.zones.gone.push(false);
                if let Some(sleepers) = &mut self.sleepers {
                    sleepers.push();
                }
                let way = Way::In(e.inlet);
                let centre = e.particle.position;
                self.zones.travellers.push(Traveller { at, since: e.time, start, centre, way });
            }
        }
        self.stale = true;
    }

    /// After a move: prescribed motion, crossings, releases, exclusions.
    pub(crate) fn move_zones(&mut self) {
        self.move_travellers();
        for outlet in 0..self.zones.outlets.len() {
            self.find_crossings(outlet);
        }
        self.zones
            .crossings
            .sort_by(|a, b| a.time.total_cmp(&b.time).then(a.particle.id.cmp(&b.particle.id)));
    }

    fn move_travellers(&mut self) {
        let now = self.time();
        let mut travellers = std::mem::take(&mut self.zones.travellers);
        travellers.retain(|t| {
            let place = t.start.position + t.start.velocity * (now - t.since);
            let centre = t.centre + t.start.velocity * (now - t.since);
            self.place(t.at as usize, place, &t.start);
            self.bodies.carry(t.at as usize, centre);
            match t.way {
                Way::Out(o) => {
                    let zone = self.zones.outlets[o as usize];
                    let inside = zone.plane.signed_distance(&place) < zone.length;
                    if !inside {
                        self.exclude(t.at as usize);
                    }
                    inside
                }
                Way::In(i) => {
                    let inside =
                        now < t.since || self.zones.inlets[i as usize].plane.signed_distance(&centre) < 0.0;
                    if !inside {
                        if self.setup.ledger {
                            let free = Particle { position: place, ..t.start };
                            // A clump does not turn on its way in.
                            let (v, g) = (t.start.velocity, self.setup.gravity);
                            self.account.entered += match self.bodies.mass_at(t.at as usize) {
                                None => carried(&free, &self.setup).iter().sum::<f64>(),
                                Some(mass) => mass * (0.5 * v.norm_squared() - g.dot(&centre)),
                            };
                        }
                        self.release(t.at as usize, place, t.start.velocity);
                        if i < self.zones.cuts {
                            self.zones.freed.insert(self.particles.id[t.at as usize], i);
                        }
                    }
                    inside
                }
            }
        });
        self.zones.travellers = travellers;
    }

    fn place(&mut self, k: usize, place: Vec3, state: &Particle) {
        let v = state.velocity;
        let row = &mut self.particles.rows[k];
        (row[0], row[1], row[2], row[4], row[5], row[6]) = (place.x, place.y, place.z, v.x, v.y, v.z);
        if let Some(spin) = self.particles.spins.get_mut(k) {
            *spin = Row4([state.spin.x, state.spin.y, state.spin.z, 0.0]);
        }
        let h = self.particles.home[k];
        self.out |= (place - Vec3::new(h[0], h[1], h[2])).norm() > h[3];
    }

    /// Out of everyone's reach until the next listing drops it.
    fn exclude(&mut self, k: usize) {
        if self.setup.ledger {
            let held = self.held(k);
            self.account.left += held;
            self.account.passed += held;
        }
        self.zones.left.push((k as u32, self.particles.home[k]));
        // Each to a place of its own: two at one place would overlap.
        let far = [-1e100 * (k + 1) as f64; 3];
        self.particles.rows[k][..3].copy_from_slice(&far);
        self.particles.home[k][..3].copy_from_slice(&far);
        self.zones.busy[k] = false;
        self.zones.gone[k] = true;
    }

    fn release(&mut self, k: usize, place: Vec3, velocity: Vec3) {
        self.zones.busy[k] = false;
        self.fresh.push(k as u32);
        self.bodies.release(k);
        self.particles.acceleration[k] = Row4::default();
        if let Some(turning) = self.particles.turning.get_mut(k) {
            *turning = Row4::default();
        }
        // What passes a storage plane in this very step crosses it.
        let before = place - velocity * self.dt;
        for (zone, beyond) in self.zones.outlets.iter().zip(&mut self.zones.beyond) {
            if zone.plane.signed_distance(&before) >= 0.0 {
                beyond.insert(self.particles.id[k]);
            }
        }
    }

    fn find_crossings(&mut self, outlet: usize) {
        let zone = self.zones.outlets[outlet];
        for k in 0..self.particles.len() {
            let place = self.particles.position(k);
            let past = zone.plane.signed_distance(&place);
            if past < 0.0 {
                if !self.zones.beyond[outlet].is_empty() {
                    self.zones.beyond[outlet].remove(&self.particles.id[k]);
                }
                continue;
            }
            if self.zones.busy[k]
                || self.zones.gone[k]
                || self.zones.beyond[outlet].contains(&self.particles.id[k])
            {
                continue;
            }
            let crossing = self.crossing(k, outlet as u32, past);
            let way = Way::Out(outlet as u32);
            let (start, since) = (crossing.particle, crossing.time);
            let traveller = Traveller { at: k as u32, since, start, centre: start.position, way };
            let after = self.time() - crossing.time;
            if self.setup.ledger {
                let carried: f64 = carried(&crossing.particle, &self.setup).iter().sum();
                let taken = carried + self.power(k, &crossing.particle) * after;
                self.account.left += taken;
                self.close_account(k, taken);
            }
            self.zones.busy[k] = true;
            if let Some(sleepers) = &mut self.sleepers {
                sleepers.rouse(k);
            }
            self.place(k, traveller.start.position + traveller.start.velocity * after, &crossing.particle);
            self.zones.travellers.push(traveller);
            self.zones.crossings.push(crossing);
        }
    }

    /// State of particle `k` when it was on the plane that it is `past` [m] of now.
    fn crossing(&self, k: usize, outlet: u32, past: f64) -> Crossing {
        let p = &self.particles;
        let (row, now) = (&p.rows[k], p.position(k));
        let before = self.position_before(k);
        let from = self.zones.outlets[outlet as usize].plane.signed_distance(&before);
        // Between 0 (at the start of the step) and 1; a start on the plane has no way to divide.
        let share = if past - from > 0.0 { (-from / (past - from)).clamp(0.0, 1.0) } else { 0.0 };
        let a = p.acceleration[k];
        let back = (1.0 - share) * self.dt;
        let velocity = Vec3::new(row[4] - a[0] * back, row[5] - a[1] * back, row[6] - a[2] * back);
        let spin = match (p.spins.get(k), p.turning.get(k)) {
            (Some(w), Some(t)) => Vec3::new(w[0] - t[0] * back, w[1] - t[1] * back, w[2] - t[2] * back),
            _ => Vec3::zeros(),
        };
        let position = before + (now - before) * share;
        let particle =
            Particle { id: p.id[k], material: p.material[k], radius: row[3], position, velocity, spin };
        Crossing { time: self.time() - back, outlet, particle, touching: self.touching(k) }
    }
}
