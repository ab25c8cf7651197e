//! Where a wall is put: `place`.

use super::table::table;
use dem::setup::WallShape;
use geom::mesh::TriMesh;
use geom::{Plane, Vec3};
use nalgebra::{Unit, UnitQuaternion};

table! {
    /// A step on the way of a wall from where it is drawn to where it is: a turn, then a shift.
    Place section {
        /// Turn about an axis.
        rotate: Option<Turned> = absent("none"), "", Any, "";
        /// Shift, after the turn.
        translate: Option<[f64; 3]> = absent("none"), "m", Finite, "[0, 0, 1]";
    }
}

table! {
    /// A turn about an axis.
    Turned inline {
        /// Direction of the axis, right-handed.
        about: [f64; 3] = required, "", Finite, "[0, 0, 1]";
        /// A point of the axis.
        through: [f64; 3] = absent("the origin"), "m", Finite, "[0, 0, 0]";
        /// Angle.
        angle: f64 = required, "rad", Finite, "\"35 deg\"";
    }
}

/// All steps of a wall, one after the other: x ↦ R x + s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    turn: UnitQuaternion<f64>,
    shift: Vec3,
}

impl Placement {
    /// Where it is drawn.
    pub fn still() -> Placement {
        Placement { turn: UnitQuaternion::identity(), shift: Vec3::zeros() }
    }

    /// Of steps; `None` where there is none.
    pub fn of(steps: &[Place]) -> Option<Placement> {
        let still = Placement::still();
        let then = |all: Placement, step: &Place| {
            let (turn, mut shift) = step.rotate.as_ref().map_or((still.turn, Vec3::zeros()), |r| {
                let turn =
                    UnitQuaternion::from_axis_angle(&Unit::new_normalize(Vec3::from(r.about)), r.angle);
                let through = Vec3::from(r.through);
                (turn, through - turn * through)
            });
            shift += Vec3::from(step.translate.unwrap_or_default());
            Placement { turn: turn * all.turn, shift: turn * all.shift + shift }
        };
        (!steps.is_empty()).then(|| steps.iter().fold(still, then))
    }

    /// Where a point is.
    pub fn point(&self, at: &Vec3) -> Vec3 {
        self.turn * at + self.shift
    }

    /// The matrix that takes points there, after lengths have been multiplied by `factor`: 16 numbers, row by row.
    pub fn rows(&self, factor: f64) -> [f64; 16] {
        let (turn, s) = (self.turn.to_rotation_matrix(), &self.shift);
        let m = turn.matrix() * factor;
        let row = |k: usize| [m[(k, 0)], m[(k, 1)], m[(k, 2)], s[k]];
        let mut all = [0.0; 16];
        (0..3).for_each(|k| all[4 * k..4 * k + 4].copy_from_slice(&row(k)));
        all[15] = 1.0;
        all
    }

    /// How a direction or a velocity is turned.
    pub fn vector(&self, along: &Vec3) -> Vec3 {
        self.turn * along
    }

    /// A plane.
    pub fn plane(&self, plane: &Plane) -> Plane {
        Plane { point: self.point(&plane.point), normal: self.vector(&plane.normal) }
    }

    /// A surface.
    pub fn shape(&self, shape: WallShape) -> WallShape {
        match shape {
            WallShape::Plane(plane) => WallShape::Plane(self.plane(&plane)),
            WallShape::Mesh(TriMesh { vertices, faces }) => {
                WallShape::Mesh(TriMesh { vertices: vertices.iter().map(|v| self.point(v)).collect(), faces })
            }
            WallShape::Spheres(spheres) => WallShape::Spheres(
                spheres.iter().map(|(centre, radius)| (self.point(centre), *radius)).collect(),
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn steps_act_one_after_the_other() {
        let turn = |angle: f64| Turned { about: [0.0, 0.0, 2.0], through: [1.0, 0.0, 0.0], angle };
        let steps = [
            Place { rotate: Some(turn(FRAC_PI_2)), translate: Some([0.0, 0.0, 3.0]) },
            Place { rotate: None, translate: Some([1.0, 0.0, 0.0]) },
        ];
        let place = Placement::of(&steps).expect("steps");
        assert!((place.point(&Vec3::new(2.0, 0.0, 0.0)) - Vec3::new(2.0, 1.0, 3.0)).norm() < 1e-15);
        assert!((place.vector(&Vec3::x()) - Vec3::y()).norm() < 1e-15);
        assert_eq!(Placement::of(&[]), None);
        let still = [Place { rotate: Some(turn(0.0)), translate: Some([0.0; 3]) }];
        let at = Vec3::new(0.1, 0.7, -0.3);
        assert_eq!(Placement::of(&still).expect("a step").point(&at), at);
    }
}
