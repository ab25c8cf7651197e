//! What is to be placed in a drawing, and where a sphere may be.

use geom::Vec3;

/// Most candidates.
pub(crate) const MOST: f64 = 2e7;

/// What is to be placed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drawing {
    /// Radius of the spheres [m].
    pub radius: f64,
    /// Depth of the dents between neighbours ζ [m].
    pub roughness: f64,
    /// A position in the flow [m]: the surface faces it.
    pub flow_at: Option<Vec3>,
    /// Centres stand on the surface itself, not a radius inside.
    pub centred: bool,
}

/// A position on the surface and where its sphere is.
#[derive(Clone, Copy)]
pub(crate) struct Candidate {
    /// On the surface [m].
    pub at: Vec3,
    /// Unit normal on the flow side.
    pub normal: Vec3,
    /// Centre of the sphere [m].
    pub centre: Vec3,
    /// Whether the sphere stands out somewhere.
    pub thin: bool,
}
