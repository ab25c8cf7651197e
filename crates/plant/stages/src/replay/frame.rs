//! A record seen from elsewhere: turned about an axis, then shifted.
//!
//! ```text
//! x ← p + R (x − p) + s      v ← R v      ω ← R ω      and so the springs of contacts, and the axes of clumps
//! ```

use crate::outlet::crossing::CrossingRow;
use dem::setup::ContactHistory;
use geom::{Plane, Vec3};
use nalgebra::{UnitQuaternion, UnitVector3};

/// A turn about an axis, then a shift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    turn: UnitQuaternion<f64>,
    /// A point of the axis [m].
    through: Vec3,
    /// [m].
    shift: Vec3,
}

impl Frame {
    /// A turn by `angle` [rad] about an axis (a point of it, and its direction), then a shift [m].
    pub fn new(axis: &Plane, angle: f64, shift: Vec3) -> Frame {
        let about = UnitVector3::new_normalize(axis.normal);
        Frame { turn: UnitQuaternion::from_axis_angle(&about, angle), through: axis.point, shift }
    }

    /// A point [m].
    pub fn point(&self, p: &Vec3) -> Vec3 {
        self.through + self.turn * (p - self.through) + self.shift
    }

    pub fn plane(&self, plane: &Plane) -> Plane {
        Plane { point: self.point(&plane.point), normal: self.turn * plane.normal }
    }

    pub fn row(&self, row: &mut CrossingRow) {
        let p = &mut row.particle;
        p.position = self.point(&p.position);
        (p.velocity, p.spin) = (self.turn * p.velocity, self.turn * p.spin);
        if let Some((clump, _)) = &mut row.clump {
            clump.orientation = self.turn * clump.orientation;
        }
        row.turn = row.turn.map(|turn| self.turn * turn);
    }

    pub fn history(&self, history: &ContactHistory) -> ContactHistory {
        history.seen(&self.turn)
    }
}
