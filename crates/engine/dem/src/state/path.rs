//! Recorded paths: what a stage upstream writes of particles that come near its storage plane, and how a zone particle follows it.
//!
//! ```text
//! x(s) = (2s³ − 3s² + 1) x₀ + (s³ − 2s² + s) h v₀ + (3s² − 2s³) x₁ + (s³ − s²) h v₁        s = (t − t₀)/h, h = t₁ − t₀
//! ```
//!
//! Cubic Hermite interpolation: positions and velocities of the samples are met, and free flight between them is exact.

use crate::setup::{Entry, Sample};
use crate::space::rotation::spun;
use crate::state::Kinematics;
use geom::Vec3;
use nalgebra::UnitQuaternion;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;

/// Samples begin this much farther from the plane than the zone is long, so that the first of them is before the zone.
pub const EARLY: f64 = 1.25;

/// Vector of the turn that leads from one orientation to another [rad], the short way.
fn between(from: &UnitQuaternion<f64>, to: &UnitQuaternion<f64>) -> Vec3 {
    let q = to * from.inverse();
    let (w, v) = if q.w < 0.0 { (-q.w, -q.imag()) } else { (q.w, q.imag()) };
    let sine = v.norm();
    if sine > 0.0 { v * (2.0 * libm::atan2(sine, w) / sine) } else { v }
}

/// How a path ends, or has ended for a particle that follows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum PathEnd {
    /// It is not known yet.
    Open,
    /// At the calculation plane.
    Free,
    /// It leads back upstream.
    Gone,
}

/// A path, from the sample that is in force on.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Path {
    pub(crate) samples: VecDeque<Sample>,
    pub(crate) end: PathEnd,
}

impl Path {
    pub fn new(entry: &Entry) -> Path {
        Path { samples: VecDeque::from([Sample::of(entry)]), end: PathEnd::Open }
    }

    /// Drops samples that are past; how the path has ended for the particle that follows it.
    pub fn follow(&mut self, now: f64) -> PathEnd {
        while self.samples.get(1).is_some_and(|s| s.time <= now) {
            self.samples.pop_front();
        }
        let goes_on = self.samples.back().is_some_and(|last| last.time > now);
        if goes_on { PathEnd::Open } else { self.end }
    }

    /// How a particle that follows it has turned by `now` [s]: evenly between two samples.
    pub fn turned(&self, now: f64) -> UnitQuaternion<f64> {
        let Some(a) = self.samples.front() else { return UnitQuaternion::identity() };
        let first = a.turn.unwrap_or_default();
        let tau = (now - a.time).max(0.0);
        match self.samples.get(1) {
            None => spun(&(a.spin * tau)) * first,
            Some(b) => {
                spun(&(between(&first, &b.turn.unwrap_or_default()) * (tau / (b.time - a.time)))) * first
            }
        }
    }

    /// Angular velocity at which it turns then [rad/s].
    pub fn rate(&self, now: f64) -> Vec3 {
        let Some(a) = self.samples.front() else { return Vec3::zeros() };
        match self.samples.get(1).filter(|_| now > a.time) {
            None => a.spin,
            Some(b) => between(&a.turn.unwrap_or_default(), &b.turn.unwrap_or_default()) / (b.time - a.time),
        }
    }

    /// State at `now` [s], shifts counted from `origin`; before its first sample it waits there, listed but hidden. From its
    /// release within a step to the end of that step it falls freely.
    pub fn flow(&self, now: f64, origin: &Vec3, gravity: &Vec3) -> Kinematics {
        let Some(a) = self.samples.front() else { return Kinematics::default() };
        let from = a.position - origin;
        let Some(b) = self.samples.get(1).filter(|_| now > a.time) else {
            let pull = if self.end == PathEnd::Free { *gravity } else { Vec3::zeros() };
            let tau = (now - a.time).max(0.0);
            let (shift, velocity) =
                (from + a.velocity * tau + pull * (0.5 * tau * tau), a.velocity + pull * tau);
            return Kinematics { shift, velocity, acceleration: pull, spin: a.spin };
        };
        let h = b.time - a.time;
        let s = (now - a.time) / h;
        let (way, v0, v1) = (b.position - a.position, a.velocity, b.velocity);
        let shift = from
            + way * (s * s * (3.0 - 2.0 * s))
            + (v0 * (s * (s - 1.0) * (s - 1.0)) + v1 * (s * s * (s - 1.0))) * h;
        let velocity =
            way * (6.0 * s * (1.0 - s) / h) + v0 * ((3.0 * s - 1.0) * (s - 1.0)) + v1 * (s * (3.0 * s - 2.0));
        let acceleration = (way * ((6.0 - 12.0 * s) / h) + v0 * (6.0 * s - 4.0) + v1 * (6.0 * s - 2.0)) / h;
        Kinematics { shift, velocity, acceleration, spin: a.spin + (b.spin - a.spin) * s }
    }
}
