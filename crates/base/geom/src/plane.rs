//! An oriented plane, written `px,py,pz,nx,ny,nz`.

use crate::Vec3;
use crate::numbers::{NumbersError, numbers};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A plane through a point; the side that the normal points to is positive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Plane {
    /// A point of the plane [m].
    pub point: Vec3,
    /// Unit normal [–]; for a cut through a flow, its direction.
    pub normal: Vec3,
}

/// Why a text is not a plane.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum PlaneError {
    /// The six numbers could not be read.
    #[error("plane 'px,py,pz,nx,ny,nz': {0}")]
    Numbers(#[source] NumbersError),
    /// The normal has no direction.
    #[error("plane normal {0},{1},{2} has no length: give a direction, such as 0,0,1")]
    NoDirection(f64, f64, f64),
}

impl Plane {
    /// The plane through `point` [m] with the direction of `normal`, of any length.
    ///
    /// # Errors
    /// A normal of no length, or one that is not finite.
    pub fn new(point: Vec3, normal: Vec3) -> Result<Plane, PlaneError> {
        // Scaled first: the square of a tiny or a huge length would be 0 or infinite.
        let scale = normal.amax();
        if !(scale > 0.0 && scale.is_finite()) {
            return Err(PlaneError::NoDirection(normal.x, normal.y, normal.z));
        }
        Ok(Plane { point, normal: (normal / scale).normalize() })
    }

    /// Distance from the plane [m], positive on the side of the normal.
    #[inline]
    pub fn signed_distance(&self, p: &Vec3) -> f64 {
        (p - self.point).dot(&self.normal)
    }

    /// The point of the plane nearest to `p` [m].
    pub fn project(&self, p: &Vec3) -> Vec3 {
        p - self.normal * self.signed_distance(p)
    }
}

impl fmt::Display for Plane {
    /// As the command line writes it; reading it back gives the same plane.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (p, n) = (self.point, self.normal);
        write!(f, "{},{},{},{},{},{}", p.x, p.y, p.z, n.x, n.y, n.z)
    }
}

impl FromStr for Plane {
    type Err = PlaneError;

    fn from_str(text: &str) -> Result<Plane, PlaneError> {
        let [px, py, pz, nx, ny, nz] = numbers::<6>(text, 0).map_err(PlaneError::Numbers)?;
        Plane::new(Vec3::new(px, py, pz), Vec3::new(nx, ny, nz))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distance_is_positive_on_the_side_of_the_normal_whatever_its_length() {
        let plane: Plane = "0,0,1,0,0,1e-200".parse().unwrap();
        assert_eq!(plane.signed_distance(&Vec3::new(5.0, 5.0, 3.0)), 2.0);
        assert_eq!(plane.project(&Vec3::new(5.0, 5.0, 3.0)), Vec3::new(5.0, 5.0, 1.0));
    }

    #[test]
    fn bad_planes_say_where() {
        assert!("0,0,0,0,0,0".parse::<Plane>().is_err());
        let message = "0,0,x,0,0,1".parse::<Plane>().unwrap_err().to_string();
        assert!(message.contains("'x'") && message.contains("character 5"), "{message}");
        assert!("1,2,3".parse::<Plane>().unwrap_err().to_string().contains("6 numbers"));
    }
}
