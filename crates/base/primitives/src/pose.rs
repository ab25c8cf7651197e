//! Position, orientation and velocity at one instant.

use crate::Vec3;
use nalgebra::{Matrix3, Rotation3, Unit};
use serde::{Deserialize, Serialize};

/// Position, orientation and velocity at one instant.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct Pose {
    rotation: Matrix3<f64>,
    through: Vec3,
    shift: Vec3,
    velocity: Vec3,
    /// Ω [rad/s].
    pub turn: Vec3,
}

/// How a surface moves on its wall, as that of a belt does: the wall stays where it is.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SurfaceMotion {
    /// Velocity of all of it [m/s], in the orientation at t = 0.
    pub velocity: Vec3,
    /// Axis times rate of a turn [rad/s], in the orientation at t = 0.
    pub turn: Vec3,
    /// A point of the axis at t = 0 [m].
    pub through: Vec3,
}

impl SurfaceMotion {
    /// A surface at rest on its wall.
    pub const fn still() -> SurfaceMotion {
        let zero = Vec3::new(0.0, 0.0, 0.0);
        SurfaceMotion { velocity: zero, turn: zero, through: zero }
    }

    /// Whether anything moves.
    pub fn moves(&self) -> bool {
        self.velocity != Vec3::zeros() || self.turn != Vec3::zeros()
    }

    /// Upper bound of the speed [m/s] of points no farther than `span` [m] from `through`.
    pub fn fastest(&self, span: f64) -> f64 {
        let turning = if self.turn == Vec3::zeros() { 0.0 } else { self.turn.norm() * span };
        self.velocity.norm() + turning
    }
}

impl Default for SurfaceMotion {
    fn default() -> SurfaceMotion {
        SurfaceMotion::still()
    }
}

/// Rodrigues' formula with sine and cosine that are the same on every platform.
fn rotation(axis: &Unit<Vec3>, angle: f64) -> Matrix3<f64> {
    let (s, c) = (libm::sin(angle), libm::cos(angle));
    let k = axis.cross_matrix();
    Rotation3::from_matrix_unchecked(Matrix3::identity() + k * s + k * k * (1.0 - c)).into_inner()
}

impl Pose {
    /// Turned by `angle` [rad] about an axis of any length through a point, at rest; not turned where the axis has none.
    pub fn turned(axis: &Vec3, angle: f64, through: Vec3) -> Pose {
        let rotation = match Unit::try_new(*axis, 0.0) {
            Some(axis) => rotation(&axis, angle),
            None => Matrix3::identity(),
        };
        let zero = Vec3::zeros();
        Pose { rotation, through, shift: zero, velocity: zero, turn: zero }
    }

    /// This pose, which is not turned and does not turn, with its shift told of the point `through` [m].
    pub fn about(self, through: Vec3) -> Pose {
        Pose { through, ..self }
    }

    /// This pose turned further about an axis through the same point, and turning faster by `spin` [rad/s].
    pub fn turned_by(self, axis: &Vec3, angle: f64, spin: Vec3) -> Pose {
        match Unit::try_new(*axis, 0.0) {
            Some(axis) => {
                let more = rotation(&axis, angle);
                Pose { rotation: more * self.rotation, turn: more * self.turn + spin, ..self }
            }
            None => self,
        }
    }

    /// What `outer` makes of this pose: the place and the velocity of a point that both move, this one first.
    ///
    /// With P = c + s, where the axis of this motion is: x = B(A(x₀)), ẋ = v_B(x) + R_B v_A.
    pub fn then(self, outer: &Pose) -> Pose {
        let carried = outer.position(&(self.through + self.shift));
        Pose {
            rotation: outer.rotation * self.rotation,
            through: self.through,
            shift: carried - self.through,
            velocity: outer.rotation * self.velocity + outer.velocity(&carried),
            turn: outer.rotation * self.turn + outer.turn,
        }
    }

    /// How the surface of a wall in this pose moves on it, apart from the wall: a velocity at each place.
    pub fn surface(&self, surface: &SurfaceMotion) -> Pose {
        let turn = self.rotation * surface.turn;
        let along = self.rotation * surface.velocity;
        let to = self.through + self.shift - self.position(&surface.through);
        Pose { velocity: along + turn.cross(&to), turn, ..*self }
    }

    /// This pose shifted by `by` [m] and faster by `speed` [m/s].
    pub fn shifted(self, by: Vec3, speed: Vec3) -> Pose {
        Pose { shift: self.shift + by, velocity: self.velocity + speed, ..self }
    }

    /// The way [m] from t = 0 of the point about which it moves: the shift without the turn.
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
