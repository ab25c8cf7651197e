//! A smooth height over a plane, fitted to the surroundings of a hole.
//!
//! ```text
//! w(u, v) = c₀ + c₁u + c₂v + c₃u² + c₄uv + c₅v²  +  Σ aᵢ φ(|(u,v) − (uᵢ,vᵢ)|) + b₀ + b₁u + b₂v,   φ(r) = r² ln r
//! ```
//!
//! The quadratic takes the curvature; the thin plate (least bending; Duchon 1977) takes the rest, smoothed by
//! λ on the diagonal so that it does not follow the noise of the scan.

use geom::Vec3;
use nalgebra::{DMatrix, DVector, Matrix3, SymmetricEigen};

/// Axes of a patch: u and v in its plane, n normal to it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Frame {
    pub origin: Vec3,
    pub u: Vec3,
    pub v: Vec3,
    pub n: Vec3,
}

impl Frame {
    /// The plane through `origin` whose normal is nearest to all `normals`, of either sign; u follows the
    /// coordinate axis that lies flattest in it. None when the normals disagree too much for one patch.
    pub fn new(origin: Vec3, normals: &[Vec3]) -> Option<Frame> {
        let sum: Matrix3<f64> = normals.iter().map(|n| n * n.transpose()).sum();
        let eigen = SymmetricEigen::new(sum);
        let n: Vec3 = eigen.eigenvectors.column(eigen.eigenvalues.imax()).normalize();
        let agreement = normals.iter().map(|m| m.dot(&n).abs()).sum::<f64>() / normals.len() as f64;
        let axis = Vec3::ith(n.iamin(), 1.0);
        let u = (axis - n * n.dot(&axis)).normalize();
        (agreement >= 0.5).then(|| Frame { origin, u, v: n.cross(&u), n })
    }

    pub fn local(&self, p: &Vec3) -> Vec3 {
        let d = p - self.origin;
        Vec3::new(d.dot(&self.u), d.dot(&self.v), d.dot(&self.n))
    }

    pub fn world(&self, p: &Vec3) -> Vec3 {
        self.origin + self.u * p.x + self.v * p.y + self.n * p.z
    }
}

/// The sheet of least bending through scattered heights.
#[derive(Debug, Clone)]
pub(crate) struct ThinPlate {
    centres: Vec<(f64, f64)>,
    /// One a centre, then b₀, b₁, b₂.
    weights: DVector<f64>,
    scale: f64,
}

impl ThinPlate {
    /// Through positions (u, v, height) about `scale` [m] apart, smoothed by `smoothing` [–]; flat zero when they
    /// do not determine one.
    pub fn fit(positions: &[Vec3], scale: f64, smoothing: f64) -> ThinPlate {
        let centres: Vec<(f64, f64)> = positions.iter().map(|p| (p.x / scale, p.y / scale)).collect();
        let n = centres.len();
        let mut a = DMatrix::zeros(n + 3, n + 3);
        for (i, p) in centres.iter().enumerate() {
            for (j, q) in centres.iter().enumerate() {
                a[(i, j)] = kernel(*p, *q);
            }
            a[(i, i)] = smoothing;
            for (k, value) in [1.0, p.0, p.1].into_iter().enumerate() {
                a[(i, n + k)] = value;
                a[(n + k, i)] = value;
            }
        }
        let mut heights: Vec<f64> = positions.iter().map(|p| p.z).collect();
        heights.extend([0.0; 3]);
        let solved = a.lu().solve(&DVector::from_vec(heights)).filter(|w| w.iter().all(|x| x.is_finite()));
        match solved {
            Some(weights) if n >= 3 => ThinPlate { centres, weights, scale },
            _ => ThinPlate { centres: Vec::new(), weights: DVector::zeros(3), scale },
        }
    }

    pub fn height(&self, u: f64, v: f64) -> f64 {
        let (u, v, n) = (u / self.scale, v / self.scale, self.centres.len());
        let bent: f64 =
            self.centres.iter().zip(self.weights.iter()).map(|(c, w)| w * kernel(*c, (u, v))).sum();
        bent + self.weights[n] + self.weights[n + 1] * u + self.weights[n + 2] * v
    }
}

fn kernel(p: (f64, f64), q: (f64, f64)) -> f64 {
    let r2 = (p.0 - q.0) * (p.0 - q.0) + (p.1 - q.1) * (p.1 - q.1);
    if r2 > 0.0 { 0.5 * r2 * libm::log(r2) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use geom::Quadratic;

    fn ring(height: impl Fn(f64, f64) -> f64) -> Vec<Vec3> {
        let turn = |i: i32| f64::from(i) * 0.17;
        (0..150)
            .map(|i| {
                let r = 1.0 + 0.2 * f64::from(i % 4);
                let (u, v) = (r * turn(i).cos(), r * turn(i).sin());
                Vec3::new(u, v, height(u, v))
            })
            .collect()
    }

    #[test]
    fn the_plate_spans_a_hole_in_a_cylinder() {
        // Radius 4 around a hole of radius 1: the quadratic alone leaves its fourth order.
        let truth = |u: f64, _: f64| 4.0 - (16.0 - u * u).sqrt();
        let positions = ring(truth);
        let fit = Quadratic::fit(&positions).unwrap();
        let left: Vec<Vec3> =
            positions.iter().map(|p| Vec3::new(p.x, p.y, p.z - fit.height(p.x, p.y))).collect();
        let plate = ThinPlate::fit(&left, 0.2, 1.0);
        for (u, v) in [(0.0, 0.0), (0.5, 0.3), (-0.8, 0.1), (0.0, 0.9)] {
            let error = fit.height(u, v) + plate.height(u, v) - truth(u, v);
            assert!(error.abs() < 0.002, "{error}");
        }
    }

    #[test]
    fn too_little_is_no_fit() {
        let nothing = ThinPlate::fit(&[Vec3::x(); 2], 1.0, 1.0);
        assert_eq!(nothing.height(3.0, 4.0), 0.0);
        assert!(Frame::new(Vec3::zeros(), &[Vec3::x(), Vec3::x(), -Vec3::x()]).is_some());
    }
}
