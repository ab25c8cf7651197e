//! A particle that moves by the prescribed motion of a zone.

use crate::setup::{Particle, Setup, Zone};
use crate::space::rotation::spun;
use crate::state::{Path, Zones};
use geom::Vec3;
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};

/// Which zone a particle is in.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Direction {
    Out(u32),
    In(u32),
}

/// A particle in a zone: x(t) = x₀ + v₀ τ + ½ a τ², τ = t − t₀. A member of a clump turns about its centre with the spin that it began with.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ZoneParticle {
    pub at: u32,
    pub since: f64,
    /// Its state then; of a member of a clump, with the velocity of the centre.
    pub start: Particle,
    /// Id of what passes: its own, or that of the first member of its clump.
    pub passing_id: u32,
    /// What must be past the plane, at that time: the centre, or that of the whole clump [m].
    pub centre: Vec3,
    /// And how far before it the point lies that is tested [m].
    pub lead: f64,
    /// Principal axes of the clump to space at that time.
    pub turn: Option<[f64; 4]>,
    /// How a sphere had turned by then that may be bonded; orientation of the clump that comes in.
    pub turned: Option<UnitQuaternion<f64>>,
    pub direction: Direction,
}

/// Shift [m], velocity [m/s] and acceleration [m/s²] of a zone particle at one instant.
#[derive(Clone, Copy, Default)]
pub struct Kinematics {
    pub shift: Vec3,
    pub velocity: Vec3,
    pub acceleration: Vec3,
    pub spin: Vec3,
}

impl Kinematics {
    /// After `tau` [s] from a velocity, with a spin that stays. Before its time it comes along a straight line, listed but hidden.
    pub fn after(tau: f64, start: &Particle, acceleration: Vec3) -> Kinematics {
        let Particle { velocity, spin, .. } = *start;
        if tau < 0.0 {
            return Kinematics { shift: velocity * tau, velocity, acceleration: Vec3::zeros(), spin };
        }
        let shift = velocity * tau + acceleration * (0.5 * tau * tau);
        Kinematics { shift, velocity: velocity + acceleration * tau, acceleration, spin }
    }

    /// Of a point that was this far from the centre [m] before the clump turned for `tau` [s].
    pub(crate) fn about(self, arm: &Vec3, tau: f64) -> Kinematics {
        if self.spin == Vec3::zeros() || tau < 0.0 {
            return self;
        }
        self.around(arm, &(spun(&(self.spin * tau)) * arm))
    }

    /// Of a point that was at `arm` from the centre [m], and is at `r`.
    pub(crate) fn around(self, arm: &Vec3, r: &Vec3) -> Kinematics {
        let spin = self.spin;
        let (around, inwards) = (spin.cross(r), spin.cross(&spin.cross(r)));
        Kinematics {
            shift: self.shift + (r - arm),
            velocity: self.velocity + around,
            acceleration: self.acceleration + inwards,
            spin,
        }
    }
}

impl ZoneParticle {
    /// At `time` [s].
    pub fn flow(&self, time: f64, zones: &Zones, setup: &Setup) -> Kinematics {
        self.own(self.centre_flow(time, zones, setup), time, zones)
    }

    /// The path that it follows.
    pub(crate) fn path<'a>(&self, zones: &'a Zones) -> Option<&'a Path> {
        if let Direction::In(_) = self.direction { zones.paths.get(&self.passing_id) } else { None }
    }

    /// Its own flow, where that of the centre is known.
    pub(crate) fn own(&self, centre: Kinematics, time: f64, zones: &Zones) -> Kinematics {
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
    pub(crate) fn turned_since(&self, time: f64, flow: &Kinematics, zones: &Zones) -> UnitQuaternion<f64> {
        match self.path(zones) {
            Some(path) => path.turned(time) * self.turned.unwrap_or_default().inverse(),
            None => spun(&(flow.spin * (time - self.since).max(0.0))),
        }
    }

    /// Of its centre, at `time` [s].
    pub(crate) fn centre_flow(&self, time: f64, zones: &Zones, setup: &Setup) -> Kinematics {
        if let Some(path) = self.path(zones) {
            let flow = path.flow(time, &self.centre, &setup.gravity);
            // What is rigid moves as it turns.
            return if self.turn.is_some() { Kinematics { spin: path.rate(time), ..flow } } else { flow };
        }
        let a = self.zone(zones).acceleration(&setup.gravity);
        Kinematics::after(time - self.since, &self.start, a)
    }

    /// How it has turned by `time` [s], in the flow of then.
    pub fn has_turned(&self, time: f64, flow: &Kinematics, zones: &Zones) -> UnitQuaternion<f64> {
        if let Some(path) = self.path(zones) {
            return path.turned(time);
        }
        spun(&(flow.spin * (time - self.since))) * self.turned.unwrap_or_default()
    }

    pub fn zone<'a>(&self, zones: &'a Zones) -> &'a Zone {
        match self.direction {
            Direction::Out(o) => &zones.outlets[o as usize],
            Direction::In(i) => &zones.inlets[i as usize],
        }
    }
}
