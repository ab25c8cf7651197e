//! Direction of least spread: the normal of a sheet of points.

use crate::Vec3;
use nalgebra::Matrix3;

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
