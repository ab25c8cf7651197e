//! Volume, centre and inertia of a body of density 1.
//!
//! ```text
//! V = ∫ dV,   V c = ∫ x dV,   S = ∫ (x − c)(x − c)ᵀ dV,   J = tr(S) 1 − S
//! ```
//!
//! A closed mesh: exactly, as the sum over its faces of tetrahedra with one common corner,
//! ∫ x xᵀ = det/120 ((a + b + c)(a + b + c)ᵀ + a aᵀ + b bᵀ + c cᵀ): the divergence theorem, after Mirtich (1996), J. Graphics
//! Tools 1(2), doi:10.1080/10867651.1996.10487458. Spheres: as a sum, each by itself (where they overlap, twice), or as their
//! union ([`Moments::of_union`]).

use crate::mesh::{MeshError, TriMesh};
use crate::{Vec3, sphere};
use nalgebra::Matrix3;
use std::collections::HashMap;

/// Integrals of a body of density 1 kg/m³.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moments {
    /// V [m³].
    pub volume: f64,
    /// c, the centre of mass [m].
    pub centre: Vec3,
    /// J about the centre of mass [m⁵].
    pub inertia: Matrix3<f64>,
}

/// V, ∫ x dV, ∫ x xᵀ dV.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Integrals {
    pub volume: f64,
    pub first: Vec3,
    pub second: Matrix3<f64>,
}

impl Integrals {
    pub(crate) fn zero() -> Integrals {
        Integrals { volume: 0.0, first: Vec3::zeros(), second: Matrix3::zeros() }
    }

    /// About the centre; integrals were taken with `origin` [m] as zero.
    pub(crate) fn moments(self, origin: Vec3) -> Moments {
        let centre = self.first / self.volume;
        let s = self.second - centre * centre.transpose() * self.volume;
        Moments { volume: self.volume, centre: centre + origin, inertia: Matrix3::identity() * s.trace() - s }
    }
}

/// What makes a surface no body.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum BodyError {
    /// Open, or without faces.
    #[error("{0}")]
    Mesh(#[from] MeshError),
    /// Neighbouring faces that look to different sides.
    #[error("at {0} edges one face points inwards and the other outwards: orient all faces the same way")]
    Orientation(usize),
    /// Nothing inside.
    #[error("the volume is {0:.3e} m³: the surface encloses no space")]
    NoVolume(f64),
    /// Spheres that do not hang together.
    #[error("the spheres form {0} parts that do not overlap: move or enlarge them until they form one body")]
    Parts(usize),
}

impl Moments {
    /// Of the inside of a closed mesh, exactly; faces may look outwards or inwards, all alike.
    ///
    /// # Errors
    /// A mesh that is open, not oriented, or encloses nothing.
    pub fn of_mesh(mesh: &TriMesh) -> Result<Moments, BodyError> {
        let mesh = mesh.welded();
        if mesh.faces.is_empty() {
            return Err(MeshError::Empty.into());
        }
        match mesh.open_edges() {
            0 => {}
            open => return Err(MeshError::Open { open }.into()),
        }
        match crooked_edges(&mesh) {
            0 => {}
            crooked => return Err(BodyError::Orientation(crooked)),
        }
        let origin = mesh.vertices.iter().sum::<Vec3>() / mesh.vertices.len() as f64;
        let mut sum = Integrals::zero();
        for [a, b, c] in mesh.triangles().map(|t| t.map(|v| v - origin)) {
            let (det, all) = (a.dot(&b.cross(&c)), a + b + c);
            sum.volume += det / 6.0;
            sum.first += all * (det / 24.0);
            let squares = a * a.transpose() + b * b.transpose() + c * c.transpose();
            sum.second += (all * all.transpose() + squares) * (det / 120.0);
        }
        let (lo, hi) = crate::grid::bounds(&mesh.vertices);
        // Less than rounding of a body of this extent is a flat one.
        if !(sum.volume.abs() > 1e-12 * (hi - lo).norm().powi(3)) {
            return Err(BodyError::NoVolume(sum.volume));
        }
        if sum.volume < 0.0 {
            sum = Integrals { volume: -sum.volume, first: -sum.first, second: -sum.second };
        }
        Ok(sum.moments(origin))
    }

    /// Of spheres (centre, radius [m]), each by itself: where they overlap, mass counts twice.
    pub fn of_sum(spheres: &[(Vec3, f64)]) -> Moments {
        let origin = spheres.first().map_or_else(Vec3::zeros, |s| s.0);
        let mut sum = Integrals::zero();
        for &(centre, r) in spheres {
            let (volume, c) = (sphere::volume(r), centre - origin);
            sum.volume += volume;
            sum.first += c * volume;
            sum.second += (c * c.transpose() + Matrix3::identity() * (r * r / 5.0)) * volume;
        }
        sum.moments(origin)
    }

    /// Of the union of spheres (centre, radius [m]), to about 10⁻⁹ of each value, 10⁻⁸ of more than 64 spheres (see `union.rs`).
    ///
    /// # Errors
    /// Spheres that do not overlap into one body.
    pub fn of_union(spheres: &[(Vec3, f64)]) -> Result<Moments, BodyError> {
        match crate::union::parts(spheres) {
            1 => Ok(crate::union::moments(spheres)),
            parts => Err(BodyError::Parts(parts)),
        }
    }
}

/// Edges that two faces run along in the same direction.
fn crooked_edges(mesh: &TriMesh) -> usize {
    let mut seen: HashMap<(u32, u32), u32> = HashMap::new();
    for &[a, b, c] in &mesh.faces {
        for edge in [(a, b), (b, c), (c, a)] {
            *seen.entry(edge).or_default() += 1;
        }
    }
    seen.values().filter(|&&n| n > 1).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::cuboid;

    #[test]
    fn a_box_anywhere() {
        let (at, size) = (Vec3::new(30.0, -20.0, 5.0), Vec3::new(1.0, 2.0, 3.0));
        let m = Moments::of_mesh(&cuboid(at, at + size)).unwrap();
        assert!((m.volume - 6.0).abs() < 1e-12 && (m.centre - at - size / 2.0).norm() < 1e-13);
        let expected = Matrix3::from_diagonal(&Vec3::new(13.0, 10.0, 5.0)) * 0.5;
        assert!((m.inertia - expected).norm() < 1e-12, "{}", m.inertia);
    }

    /// V = a³/6√2 and J = V a²/20 of a regular tetrahedron of edge a, whichever way its faces look.
    #[test]
    fn a_tetrahedron() {
        let corner = |x: f64, y: f64, z: f64| Vec3::new(x, y, z) + Vec3::new(7.0, 1.0, -2.0);
        let vertices = vec![
            corner(1.0, 1.0, 1.0),
            corner(1.0, -1.0, -1.0),
            corner(-1.0, 1.0, -1.0),
            corner(-1.0, -1.0, 1.0),
        ];
        let faces = [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
        for flip in [false, true] {
            let faces = faces.iter().map(|&[a, b, c]| if flip { [a, c, b] } else { [a, b, c] }).collect();
            let m = Moments::of_mesh(&TriMesh { vertices: vertices.clone(), faces }).unwrap();
            assert!((m.volume - 8f64 / 3.0).abs() < 1e-13, "{}", m.volume);
            assert!((m.inertia - Matrix3::identity() * (8.0 / 3.0 * 8.0 / 20.0)).norm() < 1e-13);
            assert!((m.centre - Vec3::new(7.0, 1.0, -2.0)).norm() < 1e-13);
        }
    }

    #[test]
    fn what_is_no_body_is_refused() {
        let mut mesh = cuboid(Vec3::zeros(), Vec3::repeat(1.0));
        let [a, b, c] = mesh.faces[0];
        mesh.faces[0] = [a, c, b];
        assert_eq!(Moments::of_mesh(&mesh), Err(BodyError::Orientation(3)));
        mesh.faces.remove(0);
        assert_eq!(Moments::of_mesh(&mesh), Err(MeshError::Open { open: 3 }.into()));
        let flat = cuboid(Vec3::zeros(), Vec3::new(1.0, 1.0, 0.0));
        assert!(matches!(Moments::of_mesh(&flat), Err(BodyError::NoVolume(_)) | Err(BodyError::Mesh(_))));
        let apart = [(Vec3::zeros(), 1.0), (Vec3::new(2.5, 0.0, 0.0), 1.0)];
        assert_eq!(Moments::of_union(&apart), Err(BodyError::Parts(2)));
    }
}
