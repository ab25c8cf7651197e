//! A rod in the world: a cone with round ends, a disc, or a triangle.

use geom::Vec3;

#[derive(Debug, Clone, Copy)]
pub(crate) enum RodShape {
    /// A cone with round ends.
    Cone,
    /// A disc of the first radius.
    Disc,
    /// A triangle with this third corner [m], which is seen from the side only from which its corners run
    /// counterclockwise: a body hides the other.
    Face(Vec3),
}

/// A cone with round ends, a disc, or a triangle, in the world.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rod {
    /// Its ends [m]; of a disc the middle, and the middle moved along its normal; of a triangle two corners.
    pub ends: [Vec3; 2],
    /// Radius at each end [m].
    pub radii: [f64; 2],
    pub shape: RodShape,
    /// Parts 0 to 1.
    pub colour: [f32; 3],
}
