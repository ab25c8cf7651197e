//! Volume and moment of inertia of a solid sphere.

pub use primitives::volume;

/// Moment of inertia over m r² [–].
pub const INERTIA: f64 = 0.4;
/// m r² over the moment of inertia [–].
pub const INVERSE_INERTIA: f64 = 2.5;
