//! How a particle in a zone moves.

use crate::setup::{Setup, Zone};
use crate::space::rotation::spun;
use crate::state::{Direction, Kinematics, Path, ZoneParticle, Zones};
use nalgebra::UnitQuaternion;

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
