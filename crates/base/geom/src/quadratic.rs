//! A height over a plane as a quadratic, fitted to positions.
//!
//! ```text
//! w(u, v) = c₀ + c₁u + c₂v + c₃u² + c₄uv + c₅v²
//! ```

use crate::Vec3;
use nalgebra::{Matrix2, Matrix6, Vector6};

/// w as a quadratic of u and v.
#[derive(Debug, Clone, Copy)]
pub struct Quadratic {
    coefficients: Vector6<f64>,
    scale: f64,
    /// Root mean square of what it leaves [m].
    pub rms: f64,
}

impl Quadratic {
    /// Least squares through local positions; none for too few, or positions on one line.
    pub fn fit(positions: &[Vec3]) -> Option<Quadratic> {
        if positions.len() < 8 {
            return None;
        }
        let scale = positions.iter().map(|p| p.x.abs().max(p.y.abs())).fold(0.0, f64::max);
        let (mut a, mut b) = (Matrix6::zeros(), Vector6::zeros());
        for p in positions {
            let row = terms(p.x / scale, p.y / scale);
            a += row * row.transpose();
            b += row * p.z;
        }
        // A trace of ridge: positions on a conic leave one term free.
        a += Matrix6::identity() * (1e-9 * positions.len() as f64);
        let coefficients = a.cholesky()?.solve(&b);
        let mut fit = Quadratic { coefficients, scale, rms: 0.0 };
        let left = positions.iter().map(|p| (p.z - fit.height(p.x, p.y)).powi(2)).sum::<f64>();
        fit.rms = (left / positions.len() as f64).sqrt();
        fit.rms.is_finite().then_some(fit)
    }

    /// w at a position [m].
    pub fn height(&self, u: f64, v: f64) -> f64 {
        self.coefficients.dot(&terms(u / self.scale, v / self.scale))
    }

    /// c₀ to c₅, and the length [m] that u and v are divided by.
    pub fn parts(&self) -> ([f64; 6], f64) {
        (self.coefficients.into(), self.scale)
    }

    /// The larger of the two principal curvatures where u = v = 0, without its sign [1/m].
    pub fn bend(&self) -> f64 {
        let [_, zx, zy, xx, xy, yy]: [f64; 6] = self.coefficients.into();
        let (zx, zy, square) = (zx / self.scale, zy / self.scale, self.scale * self.scale);
        let first = Matrix2::new(1.0 + zx * zx, zx * zy, zx * zy, 1.0 + zy * zy);
        let second = Matrix2::new(2.0 * xx, xy, xy, 2.0 * yy) / (square * first.determinant().sqrt());
        // The determinant of the first form is at least 1.
        let Some(inverse) = first.try_inverse() else { return 0.0 };
        let shape = inverse * second;
        let (mean, gauss) = (0.5 * shape.trace(), shape.determinant());
        mean.abs() + (mean * mean - gauss).max(0.0).sqrt()
    }

    /// Area of the surface over an area of the plane [–].
    pub fn stretch(&self, u: f64, v: f64) -> f64 {
        let (c, u, v) = (&self.coefficients, u / self.scale, v / self.scale);
        let along_u = (c[1] + 2.0 * c[3] * u + c[4] * v) / self.scale;
        let along_v = (c[2] + c[4] * u + 2.0 * c[5] * v) / self.scale;
        (1.0 + along_u * along_u + along_v * along_v).sqrt()
    }
}

fn terms(u: f64, v: f64) -> Vector6<f64> {
    Vector6::new(1.0, u, v, u * u, u * v, v * v)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(height: impl Fn(f64, f64) -> f64) -> Vec<Vec3> {
        let turn = |i: i32| f64::from(i) * 0.17;
        let position = |i: i32| {
            let r = 1.0 + 0.2 * f64::from(i % 4);
            let (u, v) = (r * turn(i).cos(), r * turn(i).sin());
            Vec3::new(u, v, height(u, v))
        };
        (0..150).map(position).collect()
    }

    #[test]
    fn a_quadratic_is_found_again() {
        let truth = |u: f64, v: f64| 1.0 + 0.1 * u - 0.2 * v + 0.3 * u * u - 0.1 * u * v + 0.05 * v * v;
        let fit = Quadratic::fit(&ring(truth)).unwrap();
        assert!(fit.rms < 1e-6 && (fit.height(0.1, 0.2) - truth(0.1, 0.2)).abs() < 1e-6);
        let slope = (1.0f64 + 0.1 * 0.1 + 0.2 * 0.2).sqrt();
        assert!((fit.stretch(0.0, 0.0) - slope).abs() < 1e-6);
    }

    #[test]
    fn a_cylinder_and_a_ball_bend_as_their_radius_says_also_seen_from_aside() {
        let (radius, tilt) = (40.0f64, 0.1f64);
        for ball in [0.0, 1.0] {
            let height = |u: f64, v: f64| tilt * u + (radius * radius - v * v - ball * u * u).sqrt() - radius;
            let fit = Quadratic::fit(&ring(height)).unwrap();
            // Tilting a paraboloid by shearing changes its curvature along u by 1 + tilt² in a power; of a cylinder along u it does so across only.
            let bend = fit.bend() * radius;
            assert!((bend - 1.0).abs() < 0.02, "{bend}");
        }
        assert!(Quadratic::fit(&ring(|u, v| 0.3 * u - 0.1 * v)).unwrap().bend() < 1e-9);
    }

    #[test]
    fn too_few_positions_have_none() {
        assert!(Quadratic::fit(&[Vec3::zeros(); 5]).is_none());
    }
}
