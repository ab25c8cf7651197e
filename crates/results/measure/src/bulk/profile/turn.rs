//! A grid that is turned about an axis of the scene, such as one along an inclined surface.

use geom::Vec3;

/// The axes of a grid: those of the scene, turned about one of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// 0, 1 or 2 for x, y or z.
    pub axis: usize,
    /// Anticlockwise, seen from the end of the axis [°].
    pub degrees: f64,
}

impl Turn {
    /// Components of a vector along the axes of the grid.
    pub fn components(&self, v: &Vec3) -> Vec3 {
        let (sin, cos) = (libm::sin(self.degrees.to_radians()), libm::cos(self.degrees.to_radians()));
        let (a, b) = ((self.axis + 1) % 3, (self.axis + 2) % 3);
        let mut along = *v;
        along[a] = cos * v[a] + sin * v[b];
        along[b] = cos * v[b] - sin * v[a];
        along
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_points_along_a_turned_axis_has_one_component() {
        for axis in 0..3 {
            let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
            let turned = Vec3::ith(a, libm::cos(0.3)) + Vec3::ith(b, libm::sin(0.3));
            let found = Turn { axis, degrees: 0.3_f64.to_degrees() }.components(&turned);
            assert!((found - Vec3::ith(a, 1.0)).norm() < 1e-15, "{axis}: {found:?}");
        }
    }
}
