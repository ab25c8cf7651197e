//! Prescribed motion, in closed form from the state at one time: no drift, and the same bits after a resume.

use crate::observe::energy::carried;
use crate::setup::Particle;
use crate::setup::Setup;
use crate::setup::Zone;
use crate::simd::Row4;
use crate::simulation::Simulation;
use crate::space::rotation::spun;
use crate::state::clump::quaternion;
use crate::state::particles::away;
use crate::state::path::Path;
use crate::state::path::Stage;
use crate::state::zones::Zones;
use geom::Vec3;
use nalgebra::UnitQuaternion;
use serde::Deserialize;
use serde::Serialize;

/// Which zone a traveller is in.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Way {
    Out(u32),
    In(u32),
}

/// A particle in a zone: x(t) = x₀ + v₀ τ + ½ a τ², τ = t − t₀. A member of a clump turns about its centre with the spin that it began with.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Traveller {
    pub at: u32,
    pub since: f64,
    /// Its state then; of a member of a clump, with the velocity of the centre.
    pub start: Particle,
    /// Id of what passes: its own, or that of the first member of its clump.
    pub whose: u32,
    /// What must be past the plane, at that time: the centre, or that of the whole clump [m].
    pub centre: Vec3,
    /// And how far before it the point lies that is tested [m].
    pub lead: f64,
    /// Principal axes of the clump to space at that time.
    pub turn: Option<[f64; 4]>,
    /// How a sphere had turned by then that may be bonded; orientation of the clump that comes in.
    pub turned: Option<UnitQuaternion<f64>>,
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

    /// Of a point that was this far from the centre [m] before the clump turned for `tau` [s].
    fn about(self, arm: &Vec3, tau: f64) -> Flow {
        if self.spin == Vec3::zeros() || tau < 0.0 {
            return self;
        }
        self.around(arm, &(spun(&(self.spin * tau)) * arm))
    }

    /// Of a point that was at `arm` from the centre [m], and is at `r`.
    fn around(self, arm: &Vec3, r: &Vec3) -> Flow {
        let spin = self.spin;
        let (around, inwards) = (spin.cross(r), spin.cross(&spin.cross(r)));
        Flow {
            shift: self.shift + (r - arm),
            velocity: self.velocity + around,
            acceleration: self.acceleration + inwards,
            spin,
        }
    }
}

impl Traveller {
    /// At `time` [s].
    pub fn flow(&self, time: f64, zones: &Zones, setup: &Setup) -> Flow {
        self.own(self.centre_flow(time, zones, setup), time, zones)
    }

    /// The path that it follows.
    fn path<'a>(&self, zones: &'a Zones) -> Option<&'a Path> {
        if let Way::In(_) = self.way { zones.paths.get(&self.whose) } else { None }
    }

    /// Its own flow, where that of the centre is known.
    fn own(&self, centre: Flow, time: f64, zones: &Zones) -> Flow {
        if self.turn.is_none() {
            return centre;
        }
        let arm = self.start.position - self.centre;
        match self.path(zones) {
            Some(_) => centre.around(&arm, &(self.turned_since(time, &centre, zones) * arm)),
            None => centre.about(&arm, time - self.since),
        }
    }

    /// By how much it has turned since it began.
    fn turned_since(&self, time: f64, flow: &Flow, zones: &Zones) -> UnitQuaternion<f64> {
        match self.path(zones) {
            Some(path) => path.turned(time) * self.turned.unwrap_or_default().inverse(),
            None => spun(&(flow.spin * (time - self.since).max(0.0))),
        }
    }

    /// Of its centre, at `time` [s].
    fn centre_flow(&self, time: f64, zones: &Zones, setup: &Setup) -> Flow {
        if let Some(path) = self.path(zones) {
            let flow = path.flow(time, &self.centre, &setup.gravity);
            // What is rigid moves as it turns.
            return if self.turn.is_some() { Flow { spin: path.rate(time), ..flow } } else { flow };
        }
        let a = self.zone(zones).acceleration(&setup.gravity);
        Flow::after(time - self.since, &self.start, a)
    }

    /// How it has turned by `time` [s], in the flow of then.
    pub fn has_turned(&self, time: f64, flow: &Flow, zones: &Zones) -> UnitQuaternion<f64> {
        if let Some(path) = self.path(zones) {
            return path.turned(time);
        }
        spun(&(flow.spin * (time - self.since))) * self.turned.unwrap_or_default()
    }

    pub fn zone<'a>(&self, zones: &'a Zones) -> &'a Zone {
        match self.way {
            Way::Out(o) => &zones.outlets[o as usize],
            Way::In(i) => &zones.inlets[i as usize],
        }
    }
}

impl Simulation {
    pub(crate) fn move_travellers(&mut self) {
        let now = self.time();
        let mut travellers = std::mem::take(&mut self.zones.travellers);
        // All members of a clump follow one path.
        let mut ended = Vec::new();
        travellers.retain(|t| {
            let stage = self.zones.paths.get_mut(&t.whose).map(|path| path.follow(now));
            let (centre, flow) = self.carry_on(t, now);
            let zone = *t.zone(&self.zones);
            let past = zone.plane.signed_distance(&centre) + t.lead;
            match (t.way, stage) {
                (Way::Out(o), _) => self.stays_behind(t, o, (&zone, past), &flow),
                (Way::In(_), Some(Stage::Inside)) => true,
                (Way::In(_), Some(Stage::Gone)) => {
                    ended.push(t.whose);
                    self.zones.ids.remove(&t.start.id);
                    self.zones.told(t.start.id);
                    self.exclude(t.at as usize);
                    false
                }
                (Way::In(_), None) if now < t.since || past < 0.0 => true,
                (Way::In(i), _) => {
                    ended.push(t.whose);
                    self.let_in(t, i, centre, &flow);
                    false
                }
            }
        });
        ended.iter().for_each(|id| drop(self.zones.paths.remove(id)));
        self.zones.travellers = travellers;
    }

    /// Puts a traveller where it is at a time [s]; where its centre is then, and how that flows.
    pub(crate) fn carry_on(&mut self, t: &Traveller, time: f64) -> (Vec3, Flow) {
        let flow = t.centre_flow(time, &self.zones, &self.setup);
        let (centre, own) = (t.centre + flow.shift, t.own(flow, time, &self.zones));
        self.place(t.at as usize, t.start.position + own.shift, &own);
        if !self.bonds.none() {
            self.bonds.put_turn(t.at as usize, t.has_turned(time, &flow, &self.zones));
        }
        if let Some(turn) = &t.turn {
            let turned = t.turned_since(time, &flow, &self.zones) * quaternion(turn);
            self.bodies.carry(t.at as usize, centre, flow.velocity, (turned, flow.spin));
        }
        (centre, flow)
    }

    /// Whether a particle that is `past` a storage plane stays in its zone; otherwise it is out of the calculation.
    fn stays_behind(&mut self, t: &Traveller, outlet: u32, (zone, past): (&Zone, f64), flow: &Flow) -> bool {
        // One that falls back has been recorded all the same.
        let back = past < 0.0 && !(flow.velocity.dot(&zone.plane.normal) > 0.0);
        let stays = past < zone.length && !back;
        if !stays {
            if back && self.tested(t.at as usize).is_some() {
                self.zones.lost.fell_back(outlet);
            }
            self.exclude(t.at as usize);
        }
        stays
    }

    /// Puts particle `k` in its place in a flow: the one of its images that is nearest to where it was listed.
    pub(crate) fn place(&mut self, k: usize, mut place: Vec3, flow: &Flow) {
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
            let held = self.held(k) + self.bonds.held(k);
            self.account.left += held;
            self.account.passed += held;
        }
        self.bonds.leave(k);
        self.zones.left.push((k as u32, self.particles.home[k]));
        let far = away(k);
        self.particles.rows[k][..3].copy_from_slice(&far);
        self.particles.home[k][..3].copy_from_slice(&far);
        self.zones.busy[k] = false;
        self.zones.gone[k] = true;
    }

    /// Past the calculation plane, in the flow of its centre.
    fn let_in(&mut self, t: &Traveller, inlet: u32, centre: Vec3, flow: &Flow) {
        let k = t.at as usize;
        let zone = &self.zones.inlets[inlet as usize];
        let since = (zone.plane.signed_distance(&centre) + t.lead) / flow.velocity.dot(&zone.plane.normal);
        self.bodies.release(k, if since.is_finite() { since.clamp(0.0, self.dt) } else { 0.0 });
        if self.setup.ledger {
            let Flow { velocity, spin, .. } = *flow;
            let free = Particle { position: self.particles.position(k), velocity, spin, ..t.start };
            self.account.entered += match self.bodies.energy_at(k, &self.setup) {
                None => carried(&free, &self.setup).iter().sum::<f64>(),
                Some(energy) => energy,
            };
        }
        self.zones.busy[k] = false;
        self.fresh.push(k as u32);
        self.recollect(k);
        if self.tested(k).is_none() {
            return;
        }
        // What passes a storage plane in this very step crosses it.
        let before = match t.turn {
            None => self.position_before(k),
            Some(_) => centre - (flow.velocity - flow.acceleration * (0.5 * self.dt)) * self.dt,
        };
        for (zone, beyond) in self.zones.outlets.iter().zip(&mut self.zones.beyond) {
            let radius = if t.turn.is_some() { 0.0 } else { t.start.radius };
            if zone.past(&before, radius) >= 0.0 {
                beyond.insert(self.particles.id[k]);
            }
        }
        self.zones.lost.freed(k, inlet);
    }
}
