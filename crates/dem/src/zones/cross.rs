//! Who passes a storage plane in a step, and when within it.
//!
//! A step moves a particle along a parabola; its passage is where what is tested of it meets the plane there:
//!
//! ```text
//! d(b) = d − v b + ½ a b² = 0        b [s] before the end of the step, v and a along the normal at the end and in the step
//! b = 2 d / (v + √(v² − 2 a d))
//! ```

use super::travel::{Flow, Traveller, Way};
use crate::energy::carried;
use crate::setup::{Crossing, Particle};
use crate::simulation::Simulation;
use geom::Vec3;

impl Simulation {
    pub(super) fn find_crossings(&mut self) {
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

    /// Finds who has passed one plane.
    fn look_at(&mut self, outlet: usize, found: &mut Vec<(usize, Crossing)>) {
        let zone = self.zones.outlets[outlet];
        for k in 0..self.particles.len() {
            let past = zone.past(&self.particles.position(k), self.particles.rows[k][3]);
            if past < 0.0 {
                let beyond = &mut self.zones.beyond[outlet];
                if !beyond.is_empty() && !self.zones.gone[k] && beyond.remove(&self.particles.id[k]) {
                    self.zones.lost.came_upstream(outlet);
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
            // One that does not move with the flow has not passed yet: carried on by its velocity, it would never leave.
            if crossing.particle.velocity.dot(&zone.plane.normal) > 0.0 {
                found.push((k, crossing));
            }
        }
    }

    /// Particle `k` moves by the motion of the zone from its passage on.
    fn hand_over(&mut self, k: usize, crossing: Crossing) {
        let (start, since) = (crossing.particle, crossing.time);
        let zone = self.zones.outlets[crossing.outlet as usize];
        let after = self.time() - since;
        if self.setup.ledger {
            let carried: f64 = carried(&start, &self.setup).iter().sum();
            let taken = carried + self.power(k, &start) * after;
            self.account.left += taken;
            self.close_account(k, taken);
        }
        self.zones.busy[k] = true;
        if let Some(sleepers) = &mut self.sleepers {
            sleepers.rouse(k);
        }
        let flow = Flow::after(after, &start, zone.acceleration(&self.setup.gravity));
        self.place(k, start.position + flow.shift, &flow);
        let (centre, lead) = (start.position, zone.lead(start.radius));
        let way = Way::Out(crossing.outlet);
        self.zones.travellers.push(Traveller { at: k as u32, since, start, centre, lead, way });
        self.zones.crossings.push(crossing);
    }

    /// State of particle `k` when what is tested of it was on the plane that it is `past` [m] of now.
    fn crossing(&self, k: usize, outlet: u32, past: f64) -> Crossing {
        let p = &self.particles;
        let (row, a) = (&p.rows[k], p.acceleration[k]);
        let zone = &self.zones.outlets[outlet as usize];
        let (velocity, a) = (Vec3::new(row[4], row[5], row[6]), Vec3::new(a[0], a[1], a[2]));
        // Past the plane at the start of the step already, but not with the flow: it passes now.
        let late = zone.past(&self.position_before(k), row[3]) >= 0.0;
        let back = if late {
            0.0
        } else {
            since_passage(past, velocity.dot(&zone.plane.normal), a.dot(&zone.plane.normal))
        };
        let back = if back.is_finite() { back.clamp(0.0, self.dt) } else { 0.0 };
        let spin = match (p.spins.get(k), p.turning.get(k)) {
            (Some(w), Some(t)) => Vec3::new(w[0] - t[0] * back, w[1] - t[1] * back, w[2] - t[2] * back),
            _ => Vec3::zeros(),
        };
        let position = p.position(k) - velocity * back + a * (0.5 * back * back);
        let velocity = velocity - a * back;
        let particle =
            Particle { id: p.id[k], material: p.material[k], radius: row[3], position, velocity, spin };
        Crossing { time: self.time() - back, outlet, particle, touching: self.touching(k) }
    }
}

/// b of the module's head.
fn since_passage(past: f64, speed: f64, acceleration: f64) -> f64 {
    let square = speed * speed - 2.0 * acceleration * past;
    2.0 * past / (speed + square.max(0.0).sqrt())
}
