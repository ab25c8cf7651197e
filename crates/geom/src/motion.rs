//! Rigid motion of a wall: a turn about a fixed axis, then a shift and a vibration.
//!
//! ```text
//! x(t) = c + R(Ω τ)(x₀ − c) + v τ + a sin(2π f τ) d      τ = min(max(t, from), until) − from
//! ```

use crate::Vec3;
use nalgebra::{Matrix3, Rotation3, Unit};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// Rigid motion as a function of time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// v [m/s].
    pub velocity: Vec3,
    /// Ω, axis times rate [rad/s].
    pub turn: Vec3,
    /// c, a point of the axis [m].
    pub through: Vec3,
    /// a d, amplitude and direction of the vibration [m].
    pub amplitude: Vec3,
    /// f [Hz].
    pub frequency: f64,
    /// Start of the motion [s].
    pub from: f64,
    /// End of the motion, where the wall stays [s]; ∞: never.
    pub until: f64,
}

impl Default for Motion {
    fn default() -> Motion {
        Motion::still()
    }
}

/// Position, orientation and velocity at one instant.
#[derive(Debug, Clone, Copy)]
pub struct Pose {
    rotation: Matrix3<f64>,
    through: Vec3,
    shift: Vec3,
    velocity: Vec3,
    /// Ω [rad/s].
    pub turn: Vec3,
}

impl Motion {
    /// At rest.
    pub const fn still() -> Motion {
        let zero = Vec3::new(0.0, 0.0, 0.0);
        let (frequency, from, until) = (0.0, 0.0, f64::INFINITY);
        Motion { velocity: zero, turn: zero, through: zero, amplitude: zero, frequency, from, until }
    }

    /// Whether anything moves.
    pub fn moves(&self) -> bool {
        self.velocity != Vec3::zeros() || self.turn != Vec3::zeros() || self.vibrates()
    }

    fn vibrates(&self) -> bool {
        self.amplitude != Vec3::zeros() && self.frequency != 0.0
    }

    /// Frequency of the vibration [Hz]; 0: none.
    pub fn vibration(&self) -> f64 {
        if self.vibrates() { self.frequency.abs() } else { 0.0 }
    }

    /// Whether `time` [s] is between its start and its end.
    pub fn runs(&self, time: f64) -> bool {
        (self.from..self.until).contains(&time)
    }

    /// Pose at `time` [s].
    pub fn pose(&self, time: f64) -> Pose {
        let runs = self.runs(time);
        let time = time.max(self.from).min(self.until) - self.from;
        let angle = self.turn.norm() * time;
        let rotation = match Unit::try_new(self.turn, 0.0) {
            Some(axis) => rotation(&axis, angle),
            None => Matrix3::identity(),
        };
        let (mut shift, mut velocity) = (self.velocity * time, self.velocity);
        if self.vibrates() {
            let omega = 2.0 * PI * self.frequency;
            shift += self.amplitude * libm::sin(omega * time);
            velocity += self.amplitude * (omega * libm::cos(omega * time));
        }
        let rate = if runs { 1.0 } else { 0.0 };
        Pose { rotation, through: self.through, shift, velocity: velocity * rate, turn: self.turn * rate }
    }

    /// Upper bound of the speed [m/s] of points no farther than `span` [m] from `through`.
    pub fn fastest(&self, span: f64) -> f64 {
        let vibration = 2.0 * PI * self.frequency.abs() * self.amplitude.norm();
        let turning = if self.turn == Vec3::zeros() { 0.0 } else { self.turn.norm() * span };
        self.velocity.norm() + vibration + turning
    }
}

/// Rodrigues' formula with sine and cosine that are the same on every platform.
fn rotation(axis: &Unit<Vec3>, angle: f64) -> Matrix3<f64> {
    let (s, c) = (libm::sin(angle), libm::cos(angle));
    let k = axis.cross_matrix();
    Rotation3::from_matrix_unchecked(Matrix3::identity() + k * s + k * k * (1.0 - c)).into_inner()
}

impl Pose {
    /// This pose shifted by `by` [m] and faster by `speed` [m/s].
    pub fn shifted(self, by: Vec3, speed: Vec3) -> Pose {
        Pose { shift: self.shift + by, velocity: self.velocity + speed, ..self }
    }

    /// The shift alone, without the turn [m].
    pub fn shift(&self) -> Vec3 {
        self.shift
    }

    /// Position [m] of the point of the wall that was at `home` [m] at t = 0.
    #[inline]
    pub fn position(&self, home: &Vec3) -> Vec3 {
        self.through + self.rotation * (home - self.through) + self.shift
    }

    /// Position at t = 0 [m] of the point of the wall that is at `place` [m] now.
    #[inline]
    pub fn home(&self, place: &Vec3) -> Vec3 {
        self.through + self.rotation.transpose() * (place - self.shift - self.through)
    }

    /// Velocity [m/s] of the point of the wall that is at `place` [m] now.
    #[inline]
    pub fn velocity(&self, place: &Vec3) -> Vec3 {
        self.velocity + self.turn.cross(&(place - self.shift - self.through))
    }

    /// A direction of the wall, turned.
    #[inline]
    pub fn direction(&self, home: &Vec3) -> Vec3 {
        self.rotation * home
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drum() -> Motion {
        Motion {
            velocity: Vec3::new(0.0, 0.0, 1.0),
            turn: Vec3::new(0.0, 0.0, 0.5 * PI),
            through: Vec3::new(1.0, 0.0, 0.0),
            amplitude: Vec3::new(0.0, 0.0, 0.25),
            frequency: 0.25,
            ..Motion::default()
        }
    }

    #[test]
    fn a_quarter_turn_a_shift_and_the_crest_of_a_vibration() {
        let place = drum().pose(1.0).position(&Vec3::new(2.0, 0.0, 0.0));
        assert!((place - Vec3::new(1.0, 1.0, 1.25)).norm() < 1e-12, "{place}");
    }

    #[test]
    fn home_is_the_inverse_of_place() {
        let (pose, home) = (drum().pose(0.37), Vec3::new(0.3, -0.7, 2.0));
        assert!((pose.home(&pose.position(&home)) - home).norm() < 1e-12);
        assert!(drum().moves() && !Motion::default().moves());
    }
}
