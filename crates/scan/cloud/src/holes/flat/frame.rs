//! The plane that the surroundings of a hole are laid on.

use geom::Vec3;
use nalgebra::{Matrix3, SymmetricEigen};

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_that_disagree_have_no_plane() {
        assert!(Frame::new(Vec3::zeros(), &[Vec3::x(), Vec3::x(), -Vec3::x()]).is_some());
        assert!(Frame::new(Vec3::zeros(), &[Vec3::x(), Vec3::y(), Vec3::z()]).is_none());
    }
}
