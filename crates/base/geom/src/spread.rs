//! Directions in which points spread; that of least spread is the normal of a sheet of points.

use crate::Vec3;
use nalgebra::{Matrix3, SymmetricEigen};

/// Steps of Newton's method: two equal eigenvalues are reached by halves.
const NEWTON: usize = 60;

/// Direction of least spread of the symmetric `spread` Σ d dᵀ; `None` when there is none, the points lying on a line.
///
/// The least eigenvalue is the first zero of the characteristic polynomial, which Newton's method reaches from below without
/// passing it; of a sheet it is near 0, and few steps do. The general solver takes ten times as long.
pub fn least_axis(spread: &Matrix3<f64>) -> Option<Vec3> {
    let scale = spread.amax();
    if scale.is_nan() || scale <= 0.0 {
        return None;
    }
    let a = spread / scale;
    let pair = |i: usize, j: usize| a[(i, i)] * a[(j, j)] - a[(i, j)] * a[(i, j)];
    let (trace, minors, determinant) = (a.trace(), pair(0, 1) + pair(1, 2) + pair(2, 0), a.determinant());
    let mut least = 0.0;
    for _ in 0..NEWTON {
        let value = determinant - least * (minors - least * (trace - least));
        let slope = minors - least * (2.0 * trace - 3.0 * least);
        let step = value / slope;
        if step.is_nan() || step <= 1e-15 {
            break;
        }
        least += step;
    }
    let m = a - Matrix3::identity() * least;
    let row = |k: usize| m.row(k).transpose();
    let crosses = [row(0).cross(&row(1)), row(1).cross(&row(2)), row(2).cross(&row(0))];
    let longest = crosses.into_iter().max_by(|x, y| x.norm_squared().total_cmp(&y.norm_squared()))?;
    (longest.norm() > 1e-10).then(|| longest.normalize())
}

/// The three directions in which points spread around their middle.
pub struct PrincipalAxes {
    /// Mean of the points [m].
    pub middle: Vec3,
    /// Unit vectors at right angles to each other, in no order.
    pub axes: [Vec3; 3],
    /// Sum of the squares of the distances from the middle along each of them [m²].
    pub spreads: [f64; 3],
    /// Which of them has the least spread: the normal of the plane of least squares.
    pub flat: usize,
}

impl PrincipalAxes {
    /// Of points [m]; without any, the axes of coordinates.
    pub fn of<'a>(points: impl Iterator<Item = &'a Vec3> + Clone) -> PrincipalAxes {
        let middle = points.clone().sum::<Vec3>() / points.clone().count().max(1) as f64;
        let spread: Matrix3<f64> = points.map(|p| (p - middle) * (p - middle).transpose()).sum();
        let eigen = SymmetricEigen::new(spread);
        PrincipalAxes {
            middle,
            axes: [0, 1, 2].map(|k| eigen.eigenvectors.column(k).into_owned()),
            spreads: eigen.eigenvalues.into(),
            flat: eigen.eigenvalues.imin(),
        }
    }

    /// Normal of the plane of least squares, of either sign.
    pub fn normal(&self) -> Vec3 {
        self.axes[self.flat]
    }

    /// The two axes in that plane.
    pub fn in_plane(&self) -> [Vec3; 2] {
        [1, 2].map(|k| self.axes[(self.flat + k) % 3])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_a_tilted_plane_spread_in_it_and_not_along_its_normal() {
        let [u, v] = [Vec3::new(2.0, 1.0, 0.0), Vec3::new(-1.0, 2.0, 5.0)].map(|a| a.normalize());
        let at = |k: i32| Vec3::repeat(3.0) + u * f64::from(k % 7) + v * f64::from(k / 7);
        let points: Vec<Vec3> = (0..49).map(at).collect();
        let axes = PrincipalAxes::of(points.iter());
        assert!((axes.normal().dot(&u.cross(&v)).abs() - 1.0).abs() < 1e-12);
        assert!((axes.middle - at(24)).norm() < 1e-12 && axes.spreads[axes.flat].abs() < 1e-10);
        assert!(axes.in_plane().iter().all(|a| a.dot(&axes.normal()).abs() < 1e-12));
    }
}
