//! Who passes a storage plane in a step, and when within it.
//!
//! A step moves a particle along a parabola; its passage is where what is tested of it meets the plane there:
//!
//! ```text
//! d(b) = d − v b + ½ a b² = 0        b [s] before the end of the step, v and a along the normal at the end and in the step
//! b = 2 d / (v + √(v² − 2 a d))
//! ```

use crate::observe::energy::carried;
use crate::passes::zones::travel::Traveller;
use crate::passes::zones::travel::Way;
use crate::setup::Crossing;
use crate::setup::EntryClump;
use crate::setup::Particle;
use crate::setup::Touch;
use crate::setup::Zone;
use crate::simulation::Simulation;
use geom::Vec3;
use nalgebra::UnitQuaternion;
use std::collections::BTreeSet;

/// What a particle has to do with a storage plane.
enum Passage {
    /// It is so far past it [m], and free.
    Past(f64),
    /// It was past it without a crossing, and has come back.
    Back,
}

impl Simulation {
    pub(crate) fn find_crossings(&mut self) {
        let mut found = Vec::new();
        for outlet in 0..self.zones.outlets.len() {
            self.look_at(outlet, &mut found);
        }
        // Who passes several planes in one step passes the first of them.
        found.sort_by(|a, b| {
            a.0.cmp(&b.0).then(a.1.time.total_cmp(&b.1.time)).then(a.1.outlet.cmp(&b.1.outlet))
        });
        found.dedup_by_key(|f| f.0);
        for (k, crossing) in found {
            self.hand_over(k, crossing);
        }
        self.zones
            .crossings
            .sort_by(|a, b| a.time.total_cmp(&b.time).then(a.particle.id.cmp(&b.particle.id)));
    }

    /// Notes who may pass a storage plane, or come back through it, before lists are made anew: nobody else's room reaches it. Where what is tested
    /// is the centre of a clump, rooms of its members say nothing.
    pub(crate) fn note_near(&mut self) {
        let p = &self.particles;
        let near = |(zone, beyond): (&Zone, &BTreeSet<u32>)| {
            let stays = |k: usize| {
                let (home, room) = (Vec3::new(p.home[k][0], p.home[k][1], p.home[k][2]), p.home[k][3]);
                let past = zone.past(&home, p.rows[k][3]);
                !self.bodies.is_member(k) && (past < -room || (past > room && beyond.contains(&p.id[k])))
            };
            (0..p.len() as u32).filter(|&k| !stays(k as usize)).collect()
        };
        self.zones.near = self.zones.outlets.iter().zip(&self.zones.beyond).map(near).collect();
    }

    /// Finds who has passed one plane.
    fn look_at(&mut self, outlet: usize, found: &mut Vec<(usize, Crossing)>) {
        let near = std::mem::take(&mut self.zones.near[outlet]);
        let all = || 0..self.particles.len() as u32;
        debug_assert!(
            self.out || all().all(|k| self.passage(outlet, k as usize).is_none() || near.contains(&k))
        );
        // Whoever has just left their room may be anywhere.
        let looked_at = if self.out { all().collect() } else { Vec::new() };
        for &k in if self.out { &looked_at } else { &near } {
            let k = k as usize;
            match self.passage(outlet, k) {
                None => {}
                Some(Passage::Back) => {
                    self.zones.beyond[outlet].remove(&self.particles.id[k]);
                    self.zones.lost.came_upstream(outlet);
                }
                Some(Passage::Past(past)) => {
                    let crossing = self.crossing(k, outlet as u32, past);
                    // One that does not move with the flow has not passed yet: carried on by its velocity, it would never leave.
                    if crossing.particle.velocity.dot(&self.zones.outlets[outlet].plane.normal) > 0.0 {
                        found.push((k, crossing));
                    }
                }
            }
        }
        self.zones.near[outlet] = near;
    }

    /// What particle `k` has to do with a storage plane now.
    fn passage(&self, outlet: usize, k: usize) -> Option<Passage> {
        let (zones, id) = (&self.zones, self.particles.id[k]);
        if zones.gone[k] {
            return None;
        }
        let (place, radius) = self.tested(k)?;
        let past = zones.outlets[outlet].past(&place, radius);
        let beyond = &zones.beyond[outlet];
        match past < 0.0 {
            true => beyond.contains(&id).then_some(Passage::Back),
            false => (!zones.busy[k] && !beyond.contains(&id)).then_some(Passage::Past(past)),
        }
    }

    /// Particle `k`, and all members of its clump, move by the motion of the zone from its passage on.
    fn hand_over(&mut self, k: usize, crossing: Crossing) {
        let since = crossing.time;
        let zone = self.zones.outlets[crossing.outlet as usize];
        let after = self.time() - since;
        if self.setup.ledger {
            self.account_crossing(k, &crossing, after);
        }
        let (starts, turn) = match &crossing.clump {
            None => (vec![crossing.particle], None),
            Some(clump) => {
                let (starts, turn) =
                    crate::passes::clumps::zones::starts(&crossing.particle, clump, &self.setup);
                (starts, Some(turn))
            }
        };
        let (centre, lead) = (crossing.particle.position, zone.lead(crossing.particle.radius));
        for (at, start) in self.together(k).into_iter().zip(starts) {
            let k = at as usize;
            self.zones.busy[k] = true;
            if let Some(sleepers) = &mut self.sleepers {
                sleepers.rouse(k);
            }
            self.bodies.take(k);
            let way = Way::Out(crossing.outlet);
            let (turned, whose) = (crossing.turn, crossing.particle.id);
            let traveller = Traveller { at, since, start, whose, centre, lead, turn, turned, way };
            self.carry_on(&traveller, self.time());
            self.zones.travellers.push(traveller);
        }
        self.zones.crossings.push(crossing);
    }

    /// What leaves the ledger with a crossing, `after` [s] before the end of the step.
    fn account_crossing(&mut self, k: usize, crossing: &Crossing, after: f64) {
        let start = &crossing.particle;
        let carried: f64 = match &crossing.clump {
            None => carried(start, &self.setup).iter().sum(),
            Some(clump) => self.bodies.energy_of(k, start, clump, &self.setup),
        };
        let power: f64 = self.together(k).iter().map(|&m| self.power_about(m as usize, start)).sum();
        let taken = carried + power * after;
        self.account.left += taken;
        match self.bodies.energy_before_half(k, &self.setup, self.dt) {
            None => self.close_account(k, taken),
            Some(energy) => self.account.passed += taken - energy,
        }
    }

    /// State of particle `k` when what is tested of it was on the plane that it is `past` [m] of now.
    fn crossing(&self, k: usize, outlet: u32, past: f64) -> Crossing {
        let zone = &self.zones.outlets[outlet as usize];
        let (velocity, acceleration) = self.motion_of(k);
        // Past the plane at the start of the step already, but not with the flow: it passes now.
        let (before, radius) = self.tested_before(k);
        let late = zone.past(&before, radius) >= 0.0;
        let back = if late {
            0.0
        } else {
            since_passage(past, velocity.dot(&zone.plane.normal), acceleration.dot(&zone.plane.normal))
        };
        let back = if back.is_finite() { back.clamp(0.0, self.dt) } else { 0.0 };
        // A passage belongs to its step: rounding must not put it before a sample that was taken when the step began.
        let began = self.steps.saturating_sub(1) as f64 * self.dt;
        let time = (self.time() - back).max(began);
        let mut touching: Vec<Touch> = Vec::new();
        self.together(k).iter().for_each(|&m| touching.extend(self.touching(m as usize)));
        let (particle, clump) = self.state_back(k, back);
        let turn = self.turn_back(k, back);
        let links = self.bonds.links(k, &self.particles.id);
        Crossing { time, outlet, particle, clump, turn, touching, links }
    }

    /// Velocity and acceleration of what is tested in the name of particle `k`.
    fn motion_of(&self, k: usize) -> (Vec3, Vec3) {
        let (row, a) = (&self.particles.rows[k], self.particles.acceleration[k]);
        let own = (Vec3::new(row[4], row[5], row[6]), Vec3::new(a[0], a[1], a[2]));
        self.bodies.motion_at(k).unwrap_or(own)
    }

    /// How particle `k` had turned a time `back` [s] before the end of the step.
    fn turn_back(&self, k: usize, back: f64) -> Option<UnitQuaternion<f64>> {
        let turn = self.bonds.turn_of(k)?;
        let (w, a) = (&self.particles.spins[k], &self.particles.turning[k]);
        let by = [0, 1, 2].map(|axis| (0.5 * self.dt * a[axis] - w[axis]) * back);
        Some(crate::space::rotation::spun(&Vec3::from(by)) * turn)
    }

    /// State of particle `k`, or of the clump that it is a member of, a time `back` [s] before the end of the step.
    pub(crate) fn state_back(&self, k: usize, back: f64) -> (Particle, Option<EntryClump>) {
        match self.bodies.state_back(k, back, self.dt, &self.setup) {
            None => (self.sphere_back(k, back), None),
            Some((particle, clump)) => (particle, Some(clump)),
        }
    }

    /// State of a sphere a time `back` [s] before the end of the step.
    fn sphere_back(&self, k: usize, back: f64) -> Particle {
        let p = &self.particles;
        let (velocity, a) = self.motion_of(k);
        let spin = match (p.spins.get(k), p.turning.get(k)) {
            (Some(w), Some(t)) => Vec3::new(w[0] - t[0] * back, w[1] - t[1] * back, w[2] - t[2] * back),
            _ => Vec3::zeros(),
        };
        let position = p.position(k) - velocity * back + a * (0.5 * back * back);
        let velocity = velocity - a * back;
        Particle { id: p.id[k], material: p.material[k], radius: p.rows[k][3], position, velocity, spin }
    }
}

/// b of the module's head.
fn since_passage(past: f64, speed: f64, acceleration: f64) -> f64 {
    let square = speed * speed - 2.0 * acceleration * past;
    2.0 * past / (speed + square.max(0.0).sqrt())
}
