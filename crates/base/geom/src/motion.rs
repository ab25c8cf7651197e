//! Rigid motion of a wall: a turn about an axis, then a shift and a vibration; several of these, one after the other.
//!
//! ```text
//! x(t) = c + R(α(p))(x₀ − c) + v p + a sin(2π f p) + s(p)     v(x) = ẋ, exactly, at every time
//! α(p) = Ω p + A sin(2π f_s p) + β(p)                          s, β: a table, linear between its rows
//! p(t): 0 until `from`, then t − from, and constant from `until` on; with a ramp its rate rises from 0 to 1, and falls before the end;
//!       with a period it does so again from `from` + k × period on, from where it has come; a table then begins again
//! ```
//!
//! A list of motions is their composition: each acts on what the ones before it have moved, so that the axis of a turn is carried by
//! the motions that follow. The shift of a list is the way of one point of the wall, [`Motion::reference`]. Every motion is the identity until it starts: there are no jumps.

mod bound;
mod path;

pub use path::{Path, PathError, PathRow};
pub use primitives::{Pose, SurfaceMotion};

use crate::Vec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Rigid motion as a function of time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Motion {
    /// v [m/s].
    pub velocity: Vec3,
    /// Ω, axis times rate [rad/s].
    pub turn: Vec3,
    /// c, a point of the axis [m].
    pub through: Vec3,
    /// a, amplitude and direction of the vibration [m].
    pub amplitude: Vec3,
    /// f [Hz].
    pub frequency: f64,
    /// Start of the motion [s].
    pub from: f64,
    /// End of the motion, where the wall stays [s]; ∞: never.
    pub until: f64,
    /// Time in which the motion starts, and in which it ends [s]; 0: at once.
    pub ramp: f64,
    /// Time after which it starts again, each time from where it has come [s]; ∞: never.
    pub period: f64,
    /// A, axis times amplitude of a swing [rad].
    pub swing: Vec3,
    /// f_s [Hz].
    pub swing_frequency: f64,
    /// s and β over p; absent: none.
    pub path: Option<Path>,
    /// Motions that act on what this one has moved; their own lists are empty.
    pub then: Vec<Motion>,
}

impl Default for Motion {
    fn default() -> Motion {
        Motion::still()
    }
}

impl Motion {
    /// At rest.
    pub const fn still() -> Motion {
        let zero = Vec3::new(0.0, 0.0, 0.0);
        Motion {
            velocity: zero,
            turn: zero,
            through: zero,
            amplitude: zero,
            frequency: 0.0,
            from: 0.0,
            until: f64::INFINITY,
            ramp: 0.0,
            period: f64::INFINITY,
            swing: zero,
            swing_frequency: 0.0,
            path: None,
            then: Vec::new(),
        }
    }

    /// The composition of motions, the first acting first; at rest when there is none.
    pub fn of(list: Vec<Motion>) -> Motion {
        let mut all = list.into_iter();
        let Some(first) = all.next() else { return Motion::still() };
        Motion { then: all.collect(), ..first }
    }

    /// This motion and those that act after it.
    pub fn parts(&self) -> impl Iterator<Item = &Motion> {
        std::iter::once(self).chain(&self.then)
    }

    /// Whether anything moves.
    pub fn moves(&self) -> bool {
        self.parts().any(Motion::acts)
    }

    fn acts(&self) -> bool {
        self.velocity != Vec3::zeros()
            || self.turn != Vec3::zeros()
            || self.vibrates()
            || self.swings()
            || self.path.as_ref().is_some_and(Path::moves)
    }

    fn vibrates(&self) -> bool {
        self.amplitude != Vec3::zeros() && self.frequency != 0.0
    }

    fn swings(&self) -> bool {
        self.swing != Vec3::zeros() && self.swing_frequency != 0.0
    }

    /// Frequency of the fastest vibration or swing [Hz], also of one that a table describes; 0: none.
    pub fn vibration(&self) -> f64 {
        let of = |m: &Motion| {
            let vibration = if m.vibrates() { m.frequency.abs() } else { 0.0 };
            let swing = if m.swings() { m.swing_frequency.abs() } else { 0.0 };
            vibration.max(swing).max(m.path.as_ref().map_or(0.0, Path::vibration))
        };
        self.parts().map(of).fold(0.0, f64::max)
    }

    /// The fastest of its steady turns [rad/s].
    pub fn fastest_turn(&self) -> f64 {
        self.parts().map(|m| m.turn.norm()).fold(0.0, f64::max)
    }

    /// Axes that it turns about, of any length but 0.
    pub fn axes(&self) -> Vec<Vec3> {
        let of = |m: &Motion| [m.turn, m.swing, m.path.as_ref().map_or(Vec3::zeros(), Path::axis)];
        self.parts().flat_map(of).filter(|axis| *axis != Vec3::zeros()).collect()
    }

    /// Whether this motion by itself turns at any time.
    fn turns(&self) -> bool {
        let turned = |path: &Path| path.axis() != Vec3::zeros();
        self.turn != Vec3::zeros() || self.swings() || self.path.as_ref().is_some_and(turned)
    }

    /// The point of the wall at t = 0 whose way is the shift [m]: the one that the axis of the first motion that turns goes through. Where nothing turns all
    /// points go the same way.
    pub fn reference(&self) -> Vec3 {
        self.parts().find(|m| m.turns()).unwrap_or(self).through
    }

    /// Whether `time` [s] is between the start and the end of any of its parts.
    pub fn runs(&self, time: f64) -> bool {
        self.parts().any(|m| m.acts() && m.runs_alone(time))
    }

    fn runs_alone(&self, time: f64) -> bool {
        let last = self.path.as_ref().filter(|_| !self.acts_beside_path()).map_or(f64::INFINITY, Path::last);
        let (_, time) = self.within(time);
        (self.from..self.until).contains(&time) && self.progress_once(time).0 < last
    }

    fn acts_beside_path(&self) -> bool {
        self.velocity != Vec3::zeros() || self.turn != Vec3::zeros() || self.vibrates() || self.swings()
    }

    /// How often it has run before the period that `time` [s] is in, and the time in its first period that `time` stands for [s].
    fn within(&self, time: f64) -> (f64, f64) {
        if self.period == f64::INFINITY || time < self.from {
            return (0.0, time);
        }
        let before = libm::floor((time - self.from) / self.period);
        (before, time - before * self.period)
    }

    /// p [s] of one period, and its rate [–].
    fn progress_once(&self, time: f64) -> (f64, f64) {
        let runs = (self.from..self.until).contains(&time);
        let u = time.max(self.from).min(self.until) - self.from;
        let rate = if runs { 1.0 } else { 0.0 };
        let r = self.ramp;
        if r == 0.0 {
            return (u, rate);
        }
        let left = self.until - self.from - u;
        if u < r {
            (0.5 * u * u / r, rate * u / r)
        } else if left < r {
            (self.until - self.from - r - 0.5 * left * left / r, rate * left / r)
        } else {
            (u - 0.5 * r, rate)
        }
    }

    /// Pose at `time` [s].
    pub fn pose(&self, time: f64) -> Pose {
        let first = self.pose_alone(time);
        let first = if self.turns() { first } else { first.about(self.reference()) };
        self.then.iter().fold(first, |pose, outer| pose.then(&outer.pose_alone(time)))
    }

    fn pose_alone(&self, time: f64) -> Pose {
        let (before, time) = self.within(time);
        let (once, rate) = self.progress_once(time);
        let whole = if before == 0.0 { 0.0 } else { self.progress_once(self.until).0 };
        let time = before * whole + once;
        let mut pose = Pose::turned(&self.turn, self.turn.norm() * time, self.through);
        pose.turn = self.turn * rate;
        if self.swings() {
            let omega = 2.0 * PI * self.swing_frequency;
            let angle = self.swing.norm() * libm::sin(omega * time);
            let spin = self.swing * (omega * libm::cos(omega * time) * rate);
            pose = pose.turned_by(&self.swing, angle, spin);
        }
        let (mut shift, mut velocity) = (self.velocity * time, self.velocity);
        if self.vibrates() {
            let omega = 2.0 * PI * self.frequency;
            shift += self.amplitude * libm::sin(omega * time);
            velocity += self.amplitude * (omega * libm::cos(omega * time));
        }
        if let Some(path) = &self.path {
            let (at, end) = (path.at(once), if before == 0.0 { None } else { Some(path.at(whole)) });
            let angle = end.as_ref().map_or(at.angle, |end| before * end.angle + at.angle);
            pose = pose.turned_by(&path.about, angle, path.about * (at.spin * rate));
            shift += end.map_or(at.shift, |end| end.shift * before + at.shift);
            velocity += at.velocity;
        }
        pose.shifted(shift, velocity * rate)
    }
}

#[cfg(test)]
mod tests;
