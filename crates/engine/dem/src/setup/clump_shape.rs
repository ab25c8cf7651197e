//! What a rigid clump is made of: spheres in its own frame, and the mass they carry.
//!
//! The frame of a shape has its origin at the centre of mass and its axes along the principal axes, the one that differs most
//! from the other two last (the third, as [`crate::space::rotation`] wants it). A clump is a shape × scale s: lengths × s, mass × s³,
//! moments of inertia × s⁵.

use geom::{Moments, Vec3};
use nalgebra::{Matrix3, Matrix6, Rotation3, UnitQuaternion};

/// Moments of inertia closer than this are the same [–]: what the quadrature of a union leaves.
const SAME: f64 = 1e-8;

/// A kind of rigid clump.
#[derive(Debug, Clone, PartialEq)]
pub struct ClumpShape {
    /// Name, for messages.
    pub name: String,
    /// Index of its material.
    pub material: u16,
    /// Spheres that touch others: centre in the frame of the shape, radius [m].
    pub spheres: Vec<(Vec3, f64)>,
    /// V [m³].
    pub volume: f64,
    /// Principal moments of inertia of density 1 [m⁵].
    pub inertia: [f64; 3],
    /// Turns the frame of the shape into the one that it was given in.
    pub frame: UnitQuaternion<f64>,
    /// Centre of mass in the frame that it was given in [m].
    pub centre: Vec3,
}

impl ClumpShape {
    /// Spheres (centre, radius [m]) that move as one body with the moments of density 1, both in one frame.
    pub fn new(name: &str, material: u16, spheres: &[(Vec3, f64)], moments: &Moments) -> ClumpShape {
        let (inertia, frame) = principal(&moments.inertia);
        let local = |&(c, r): &(Vec3, f64)| (frame.inverse_transform_vector(&(c - moments.centre)), r);
        ClumpShape {
            name: name.to_owned(),
            material,
            spheres: spheres.iter().map(local).collect(),
            volume: moments.volume,
            inertia,
            frame,
            centre: moments.centre,
        }
    }

    /// Position and radius [m] of the spheres of a clump: centre of mass [m], orientation, scale.
    pub fn spheres_at(
        &self,
        centre: Vec3,
        orientation: &UnitQuaternion<f64>,
        scale: f64,
    ) -> impl Iterator<Item = (Vec3, f64)> + '_ {
        let turn = orientation * self.frame;
        self.spheres.iter().map(move |(arm, radius)| (centre + turn * (arm * scale), radius * scale))
    }

    /// Radius of the sphere about the centre of mass that holds all of it [m].
    pub fn reach(&self) -> f64 {
        self.spheres.iter().map(|(c, r)| c.norm() + r).fold(0.0, f64::max)
    }

    /// Smallest and largest radius of its spheres [m].
    pub fn radii(&self) -> (f64, f64) {
        let radii = || self.spheres.iter().map(|s| s.1);
        (radii().fold(f64::INFINITY, f64::min), radii().fold(0.0, f64::max))
    }

    /// 1/m of a sphere that would give way as easily [1/kg] at scale 1 and density 1: to normal and to tangential forces.
    ///
    /// ```text
    /// N = c Σ_k ( 1        −[r_k]        )      T = 2 c Σ_k ( 1        −[r_k]               )
    ///           ( [r_k]    r_k² − r_k r_kᵀ )               ( [r_k]    r_k² − r_k r_kᵀ + R_k² )
    /// w_n = λ_max(M^−½ N M^−½)/4,   w_t = λ_max(M^−½ T M^−½)/20,   c = 4,   M = diag(m, m, m, I)
    /// ```
    ///
    /// N and T are the stiffnesses of the clump against contacts of stiffness 1 from all sides on all its n members, three c on each,
    /// as on a sphere of a close packing: across its axis a rod of spheres that touch has no fewer in a crystal. One sphere:
    /// w_n = w_t = 1/m, the bounds that [`crate::model::limit::critical_step`] divides by 4 and 20.
    pub fn yielding(&self) -> (f64, f64) {
        let c = 4.0;
        let root = |x: f64| 1.0 / x.sqrt();
        let m = root(self.volume);
        let i = Matrix3::from_diagonal(&Vec3::from(self.inertia.map(root)));
        let (mut normal, mut tangential) = (Matrix6::zeros(), Matrix6::zeros());
        for (r, radius) in &self.spheres {
            let cross = r.cross_matrix();
            let arms = cross * cross.transpose();
            let mut one = Matrix6::zeros();
            one.fixed_view_mut::<3, 3>(0, 0).copy_from(&(Matrix3::identity() * (m * m)));
            one.fixed_view_mut::<3, 3>(0, 3).copy_from(&(cross.transpose() * i * m));
            one.fixed_view_mut::<3, 3>(3, 0).copy_from(&(i * cross * m));
            one.fixed_view_mut::<3, 3>(3, 3).copy_from(&(i * arms * i));
            normal += one * c;
            let own = i * i * (radius * radius);
            let mut turning = one.fixed_view::<3, 3>(3, 3).into_owned();
            turning += own;
            one.fixed_view_mut::<3, 3>(3, 3).copy_from(&turning);
            tangential += one * (2.0 * c);
        }
        let largest = |m: Matrix6<f64>| m.symmetric_eigenvalues().max();
        (largest(normal) / 4.0, largest(tangential) / 20.0)
    }

    /// Mass [kg] of a clump of this shape.
    pub fn mass(&self, scale: f64, density: f64) -> f64 {
        self.volume * scale * scale * scale * density
    }
}

/// Principal moments, and the turn from their axes to the frame of the tensor.
fn principal(inertia: &Matrix3<f64>) -> ([f64; 3], UnitQuaternion<f64>) {
    let eigen = ((inertia + inertia.transpose()) * 0.5).symmetric_eigen();
    let value = |k: usize| eigen.eigenvalues[k];
    // The two that are most alike come first.
    let apart = |a: usize, b: usize| (1.0 / value(a) - 1.0 / value(b)).abs();
    let last = (0..3).min_by(|&p, &q| {
        let of = |k: usize| apart((k + 1) % 3, (k + 2) % 3);
        of(p).total_cmp(&of(q))
    });
    let last = last.unwrap_or(2);
    let order = [(last + 1) % 3, (last + 2) % 3, last];
    let axes = order.map(|k| eigen.eigenvectors.column(k).into_owned());
    let third = axes[0].cross(&axes[1]);
    let turn = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[axes[0], axes[1], third]));
    let mut moments = order.map(value);
    let same = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs();
    if same(moments[0], moments[1]) {
        let mean = 0.5 * (moments[0] + moments[1]);
        (moments[0], moments[1]) = (mean, mean);
        if same(mean, moments[2]) {
            moments[2] = mean;
        }
    }
    (moments, UnitQuaternion::from_rotation_matrix(&turn))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_sphere_yields_as_a_sphere_does() {
        let spheres = [(Vec3::new(1.0, 2.0, 3.0), 0.3)];
        let shape = ClumpShape::new("ball", 0, &spheres, &Moments::of_sum(&spheres));
        let (normal, tangential) = shape.yielding();
        assert!(
            (normal * shape.volume - 1.0).abs() < 1e-12 && (tangential * shape.volume - 1.0).abs() < 1e-12
        );
        assert!(shape.spheres[0].0.norm() < 1e-15 && (shape.reach() - 0.3).abs() < 1e-15);
    }

    /// The frame is that of the principal axes, and gives the spheres and the tensor back.
    #[test]
    fn the_frame_is_principal() {
        let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
        let spheres = [(at(0.0, 0.0, 0.0), 0.5), (at(0.7, 0.1, 0.2), 0.4), (at(0.3, 0.8, -0.1), 0.3)];
        let moments = Moments::of_sum(&spheres);
        let shape = ClumpShape::new("three", 0, &spheres, &moments);
        let turn = shape.frame.to_rotation_matrix();
        let back =
            turn.matrix() * Matrix3::from_diagonal(&Vec3::from(shape.inertia)) * turn.matrix().transpose();
        assert!((back - moments.inertia).norm() < 1e-14, "{back}");
        for ((local, _), (given, _)) in shape.spheres.iter().zip(&spheres) {
            assert!((shape.frame * local + shape.centre - given).norm() < 1e-14);
        }
        assert!(turn.matrix().determinant() > 0.0);
    }
}
