//! Where a moving wall is at a given time.

use crate::setup::Motion;
use geom::Vec3;
use nalgebra::{Matrix3, Rotation3, Unit};

/// A wall's place and velocity at one instant.
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
    /// Whether the wall moves at all.
    pub fn moves(&self) -> bool {
        self.velocity != Vec3::zeros()
            || self.turn != Vec3::zeros()
            || self.vibrates()
            || self.servo.is_some()
    }

    fn vibrates(&self) -> bool {
        self.amplitude != Vec3::zeros() && self.frequency != 0.0
    }

    /// Place and velocity at `time` [s], without the servo.
    pub fn pose(&self, time: f64) -> Pose {
        let runs = (self.from..self.until).contains(&time);
        let time = time.max(self.from).min(self.until) - self.from;
        let angle = self.turn.norm() * time;
        let rotation = match Unit::try_new(self.turn, 0.0) {
            Some(axis) => turned(&axis, angle),
            None => Matrix3::identity(),
        };
        let (mut shift, mut velocity) = (self.velocity * time, self.velocity);
        if self.vibrates() {
            let omega = 2.0 * std::f64::consts::PI * self.frequency;
            shift += self.amplitude * libm::sin(omega * time);
            velocity += self.amplitude * (omega * libm::cos(omega * time));
        }
        let rate = if runs { 1.0 } else { 0.0 };
        Pose { rotation, through: self.through, shift, velocity: velocity * rate, turn: self.turn * rate }
    }

    /// Upper bound of the speed [m/s], without the servo, of points no farther than `span` [m] from `through`.
    pub fn fastest(&self, span: f64) -> f64 {
        let vibration = 2.0 * std::f64::consts::PI * self.frequency.abs() * self.amplitude.norm();
        self.velocity.norm()
            + vibration
            + if self.turn == Vec3::zeros() { 0.0 } else { self.turn.norm() * span }
    }
}

/// Rodrigues' formula with sine and cosine that are the same on every platform.
fn turned(axis: &Unit<Vec3>, angle: f64) -> Matrix3<f64> {
    let (s, c) = (libm::sin(angle), libm::cos(angle));
    let k = axis.cross_matrix();
    Rotation3::from_matrix_unchecked(Matrix3::identity() + k * s + k * k * (1.0 - c)).into_inner()
}

impl Pose {
    /// The same, shifted by `by` [m] and faster by `speed` [m/s].
    pub fn shifted(self, by: Vec3, speed: Vec3) -> Pose {
        Pose { shift: self.shift + by, velocity: self.velocity + speed, ..self }
    }

    /// How far the wall has been shifted [m], its turn apart.
    pub fn shift(&self) -> Vec3 {
        self.shift
    }

    /// Where a point of the wall is that was at `home` [m] at t = 0.
    pub fn place(&self, home: &Vec3) -> Vec3 {
        self.through + self.rotation * (home - self.through) + self.shift
    }

    /// Where a point that is at `place` [m] now would have been at t = 0.
    pub fn home(&self, place: &Vec3) -> Vec3 {
        self.through + self.rotation.transpose() * (place - self.shift - self.through)
    }

    /// Velocity [m/s] of the point of the wall that is at `place` [m] now.
    pub fn velocity(&self, place: &Vec3) -> Vec3 {
        self.velocity + self.turn.cross(&(place - self.shift - self.through))
    }

    /// A direction of the wall, turned.
    pub fn direction(&self, home: &Vec3) -> Vec3 {
        self.rotation * home
    }
}
