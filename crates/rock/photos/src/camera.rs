//! Cameras: where a point of space is on a photograph.
//!
//! ```text
//! X_c = R X + t,  u = X_c/Z_c,  v = Y_c/Z_c                              camera looks along +z, x to the right, y down
//! r² = u² + v²,   u' = u (1 + k₁ r² + k₂ r⁴) + 2 p₁ u v + p₂ (r² + 2 u²)
//!                 v' = v (1 + k₁ r² + k₂ r⁴) + p₁ (r² + 2 v²) + 2 p₂ u v
//! x = fx u' + s v' + cx,  y = fy v' + cy
//! P = K [R | t] = any 3 × 4 matrix of rank 3, parted by RQ                Hartley & Zisserman (2004), Multiple View Geometry, 6.2
//! ```
//!
//! Distortion as in COLMAP and OpenCV (Brown 1966, Photogramm. Eng. 32(3)).

use geom::Vec3;
use nalgebra::{Matrix3, Matrix3x4};
use serde::Serialize;

#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Camera {
    /// fx, fy, s [px].
    pub focal: [f64; 3],
    /// cx, cy [px].
    pub centre: [f64; 2],
    /// k₁, k₂, p₁, p₂ [–].
    pub distortion: [f64; 4],
    /// R: from the world to the camera [–].
    pub rotation: Matrix3<f64>,
    /// t [m].
    pub translation: Vec3,
}

impl Camera {
    /// From a 3 × 4 matrix; `None` when its left part has no inverse, or is not finite.
    pub fn from_matrix(p: &Matrix3x4<f64>) -> Option<Camera> {
        let m: Matrix3<f64> = p.fixed_columns::<3>(0).into_owned();
        let size = m.row(2).norm();
        if !(size > 0.0 && p.iter().all(|v| v.is_finite())) || m.try_inverse().is_none() {
            return None;
        }
        // det(K R) > 0: the scale of P is free, so is its sign.
        let p = p / (size * m.determinant().signum());
        let m: Matrix3<f64> = p.fixed_columns::<3>(0).into_owned();
        // RQ by rows from below; K has a positive diagonal.
        let [a, b, c] = [0, 1, 2].map(|k| m.row(k).transpose());
        let r3 = c;
        let (cy, cx) = (b.dot(&r3), a.dot(&r3));
        let across = b - r3 * cy;
        let fy = across.norm();
        let r2 = across / fy;
        let s = a.dot(&r2);
        let along = a - r2 * s - r3 * cx;
        let fx = along.norm();
        let rotation = Matrix3::from_columns(&[along / fx, r2, r3]).transpose();
        let q: Vec3 = p.column(3).into_owned();
        let z = q.z;
        let y = (q.y - cy * z) / fy;
        let x = (q.x - s * y - cx * z) / fx;
        let translation = Vec3::new(x, y, z);
        Some(Camera { focal: [fx, fy, s], centre: [cx, cy], distortion: [0.0; 4], rotation, translation })
    }

    /// A camera at `eye` that looks at `target`; `up` is upwards on the photograph.
    pub fn looking(eye: Vec3, target: Vec3, up: Vec3, focal: f64, centre: [f64; 2]) -> Camera {
        let forward = (target - eye).normalize();
        let right = forward.cross(&up).normalize();
        let rotation = Matrix3::from_columns(&[right, forward.cross(&right), forward]).transpose();
        let focal = [focal, focal, 0.0];
        Camera { focal, centre, distortion: [0.0; 4], rotation, translation: -(rotation * eye) }
    }

    /// Where the camera is [m].
    pub fn eye(&self) -> Vec3 {
        -(self.rotation.transpose() * self.translation)
    }

    /// Mean focal length [px].
    pub fn mean_focal(&self) -> f64 {
        (self.focal[0] * self.focal[1]).sqrt()
    }

    /// Place on the photograph [px] and depth [m]; the depth is not above 0 behind the camera.
    pub fn project(&self, p: &Vec3) -> ([f64; 2], f64) {
        let c = self.rotation * p + self.translation;
        let (u, v) = (c.x / c.z, c.y / c.z);
        let (u, v) = if self.distortion == [0.0; 4] { (u, v) } else { self.distorted(u, v) };
        let [fx, fy, s] = self.focal;
        ([fx * u + s * v + self.centre[0], fy * v + self.centre[1]], c.z)
    }

    fn distorted(&self, u: f64, v: f64) -> (f64, f64) {
        let [k1, k2, p1, p2] = self.distortion;
        let (rr, uv) = (u * u + v * v, u * v);
        let radial = 1.0 + rr * (k1 + rr * k2);
        (
            u * radial + 2.0 * p1 * uv + p2 * (rr + 2.0 * u * u),
            v * radial + p1 * (rr + 2.0 * v * v) + 2.0 * p2 * uv,
        )
    }

    /// Direction from the eye through a pixel [–].
    pub fn ray(&self, [x, y]: [f64; 2]) -> Vec3 {
        let [fx, fy, s] = self.focal;
        let v0 = (y - self.centre[1]) / fy;
        let u0 = (x - self.centre[0] - s * v0) / fx;
        // Fixed point of the distortion.
        let (mut u, mut v) = (u0, v0);
        if self.distortion != [0.0; 4] {
            for _ in 0..20 {
                let (a, b) = self.distorted(u, v);
                (u, v) = (u + u0 - a, v + v0 - b);
            }
        }
        (self.rotation.transpose() * Vec3::new(u, v, 1.0)).normalize()
    }

    /// The camera when the world is moved by x ↦ Q x + q before.
    pub fn after(&self, turn: &Matrix3<f64>, shift: &Vec3) -> Camera {
        Camera {
            rotation: self.rotation * turn,
            translation: self.rotation * shift + self.translation,
            ..*self
        }
    }

    /// The camera for photographs whose sides have `factor` times as many pixels.
    pub fn resized(&self, factor: f64) -> Camera {
        // Centres of pixels are whole numbers.
        let centre = self.centre.map(|c| (c + 0.5) * factor - 0.5);
        Camera { focal: self.focal.map(|f| f * factor), centre, ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn some() -> Camera {
        let mut camera = Camera::looking(
            Vec3::new(0.5, -0.2, 0.3),
            Vec3::new(0.01, 0.0, 0.02),
            Vec3::z(),
            900.0,
            [320.0, 240.0],
        );
        camera.focal = [900.0, 880.0, 3.0];
        camera
    }

    #[test]
    fn a_matrix_of_any_scale_and_sign_is_parted_again() {
        let camera = some();
        let k = Matrix3::new(900.0, 3.0, 320.0, 0.0, 880.0, 240.0, 0.0, 0.0, 1.0);
        let rt = Matrix3x4::from_columns(&[
            camera.rotation.column(0).into_owned(),
            camera.rotation.column(1).into_owned(),
            camera.rotation.column(2).into_owned(),
            camera.translation,
        ]);
        for scale in [1.0, -7.5, 1e-4] {
            let found = Camera::from_matrix(&(k * rt * scale)).unwrap();
            let p = Vec3::new(0.03, 0.02, -0.05);
            let ([x, y], z) = found.project(&p);
            let ([u, v], w) = camera.project(&p);
            assert!((x - u).abs() + (y - v).abs() < 1e-8 && (z - w).abs() < 1e-9, "{scale}");
            assert!((found.focal[2] - 3.0).abs() < 1e-7);
        }
        assert_eq!(Camera::from_matrix(&Matrix3x4::zeros()), None);
    }

    #[test]
    fn a_ray_through_a_pixel_meets_the_point_that_is_seen_there() {
        let camera = Camera { distortion: [-0.1, 0.02, 0.001, -0.002], ..some() };
        let p = Vec3::new(0.06, 0.05, -0.04);
        let (pixel, depth) = camera.project(&p);
        let ray = camera.ray(pixel);
        let to = p - camera.eye();
        assert!(ray.cross(&to).norm() < 1e-9 && ray.dot(&to) > 0.0 && depth > 0.0);
    }

    #[test]
    fn up_is_up() {
        let camera = some();
        let at = |p: Vec3| camera.project(&p).0;
        assert!(at(Vec3::new(0.0, 0.0, 0.1))[1] < at(Vec3::zeros())[1]);
        // Seen from +x, +y is to the right.
        assert!(at(Vec3::new(0.0, 0.1, 0.0))[0] > at(Vec3::zeros())[0]);
    }
}
