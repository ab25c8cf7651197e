//! Walls that are surfaces: planes and triangle meshes, which may move.

use geom::Motion;
use record::SurfaceShape;

/// A wall that is a plane or a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct WallSurface {
    /// Name, as shown.
    pub name: String,
    /// Its shape at t = 0.
    pub shape: SurfaceShape,
    /// How it moves.
    pub motion: Motion,
}
