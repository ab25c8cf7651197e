//! Prescribed motion, in closed form from the state at one time: no drift, and the same bits after a resume.

use super::Zones;
use super::path::Stage;
use crate::energy::carried;
use crate::lane::Row4;
use crate::setup::{Particle, Setup, Zone};
use crate::simulation::Simulation;
use geom::Vec3;
use serde::{Deserialize, Serialize};

/// Which zone a traveller is in.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Way {
    Out(u32),
    In(u32),
}

/// A particle in a zone: x(t) = x₀ + v₀ τ + ½ a τ², τ = t − t₀.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Traveller {
    pub at: u32,
    pub since: f64,
    pub start: Particle,
    /// What must be past the plane, at that time: the centre, or that of the whole clump [m].
    pub centre: Vec3,
    /// And how far before it the point lies that is tested [m].
    pub lead: f64,
    pub way: Way,
}

/// Shift [m] and velocity [m/s] of a traveller at one instant, and its acceleration [m/s²].
#[derive(Clone, Copy)]
pub struct Flow {
    pub shift: Vec3,
    pub velocity: Vec3,
    pub acceleration: Vec3,
    pub spin: Vec3,
}

impl Flow {
    /// After `tau` [s] from a velocity, with a spin that stays. Before its time a traveller comes along a straight line, out of everyone's sight.
    pub fn after(tau: f64, start: &Particle, acceleration: Vec3) -> Flow {
        let Particle { velocity, spin, .. } = *start;
        if tau < 0.0 {
            return Flow { shift: velocity * tau, velocity, acceleration: Vec3::zeros(), spin };
        }
        let shift = velocity * tau + acceleration * (0.5 * tau * tau);
        Flow { shift, velocity: velocity + acceleration * tau, acceleration, spin }
    }
}

impl Traveller {
    /// At `time` [s].
    pub fn flow(&self, time: f64, zones: &Zones, setup: &Setup) -> Flow {
        if let (Way::In(_), Some(path)) = (self.way, zones.paths.get(&self.start.id)) {
            return path.flow(time, &self.start.position, &setup.gravity);
        }
        let a = self.zone(zones).acceleration(&setup.gravity);
        Flow::after(time - self.since, &self.start, a)
    }

    pub fn zone<'a>(&self, zones: &'a Zones) -> &'a Zone {
        match self.way {
            Way::Out(o) => &zones.outlets[o as usize],
            Way::In(i) => &zones.inlets[i as usize],
        }
    }
}

impl Simulation {
    pub(super) fn move_travellers(&mut self) {
        let now = self.time();
        let mut travellers = std::mem::take(&mut self.zones.travellers);
        travellers.retain(|t| {
            let stage = self.zones.paths.get_mut(&t.start.id).map(|path| path.follow(now));
            let flow = t.flow(now, &self.zones, &self.setup);
            let centre = t.centre + flow.shift;
            self.place(t.at as usize, t.start.position + flow.shift, &flow);
            self.bodies.carry(t.at as usize, centre, flow.velocity);
            let zone = *t.zone(&self.zones);
            let past = zone.plane.signed_distance(&centre) + t.lead;
            match (t.way, stage) {
                (Way::Out(o), _) => self.stays_behind(t, o, (&zone, past), &flow),
                (Way::In(_), Some(Stage::Inside)) => true,
                (Way::In(_), Some(Stage::Gone)) => {
                    self.zones.paths.remove(&t.start.id);
                    self.zones.ids.remove(&t.start.id);
                    self.exclude(t.at as usize);
                    false
                }
                (Way::In(_), None) if now < t.since || past < 0.0 => true,
                (Way::In(i), _) => {
                    self.zones.paths.remove(&t.start.id);
                    self.let_in(t, i, centre, &flow);
                    false
                }
            }
        });
        self.zones.travellers = travellers;
    }

    /// Whether a particle that is `past` a storage plane stays in its zone; otherwise it is out of the calculation.
    fn stays_behind(&mut self, t: &Traveller, outlet: u32, (zone, past): (&Zone, f64), flow: &Flow) -> bool {
        // One that falls back has been recorded all the same.
        let back = past < 0.0 && !(flow.velocity.dot(&zone.plane.normal) > 0.0);
        let stays = past < zone.length && !back;
        if !stays {
            if back {
                self.zones.lost.fell_back(outlet);
            }
            self.exclude(t.at as usize);
        }
        stays
    }

    /// Puts particle `k` in its place in a flow: the one of its images that is nearest to where it was listed.
    pub(super) fn place(&mut self, k: usize, mut place: Vec3, flow: &Flow) {
        let home = self.particles.home[k];
        for (axis, range) in self.setup.periodic.iter().enumerate() {
            if let Some((lo, hi)) = range {
                place[axis] += (hi - lo) * ((home[axis] - place[axis]) / (hi - lo)).round();
            }
        }
        let (v, a, spin) = (flow.velocity, flow.acceleration, flow.spin);
        let row = &mut self.particles.rows[k];
        (row[0], row[1], row[2], row[4], row[5], row[6]) = (place.x, place.y, place.z, v.x, v.y, v.z);
        self.particles.acceleration[k] = Row4([a.x, a.y, a.z, 0.0]);
        if let Some(row) = self.particles.spins.get_mut(k) {
            *row = Row4([spin.x, spin.y, spin.z, 0.0]);
        }
        if let Some(turning) = self.particles.turning.get_mut(k) {
            *turning = Row4::default();
        }
        self.out |= (place - Vec3::new(home[0], home[1], home[2])).norm() > home[3];
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

    /// Past the calculation plane.
    fn let_in(&mut self, t: &Traveller, inlet: u32, centre: Vec3, flow: &Flow) {
        let k = t.at as usize;
        if self.setup.ledger {
            let Flow { velocity, spin, .. } = *flow;
            let free = Particle { position: self.particles.position(k), velocity, spin, ..t.start };
            // A clump does not turn on its way in.
            self.account.entered += match self.bodies.mass_at(k) {
                None => carried(&free, &self.setup).iter().sum::<f64>(),
                Some(mass) => mass * (0.5 * flow.velocity.norm_squared() - self.setup.gravity.dot(&centre)),
            };
        }
        self.zones.busy[k] = false;
        self.fresh.push(k as u32);
        self.bodies.release(k);
        // What passes a storage plane in this very step crosses it.
        let before = self.position_before(k);
        for (zone, beyond) in self.zones.outlets.iter().zip(&mut self.zones.beyond) {
            if zone.past(&before, t.start.radius) >= 0.0 {
                beyond.insert(self.particles.id[k]);
            }
        }
        self.zones.lost.freed(k, inlet);
    }
}
