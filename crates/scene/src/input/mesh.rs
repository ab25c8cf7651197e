//! Triangles from a file.

use crate::error::SceneError;
use geom::mesh::TriMesh;
use std::path::Path;

/// Reads a mesh (PLY, STL, OBJ; polygons are cut into triangles).
///
/// # Errors
/// A file of another kind, faces without vertices.
pub fn read_mesh(path: &Path) -> Result<TriMesh, SceneError> {
    let bytes = std::fs::read(path).map_err(|e| SceneError::read(path, e))?;
    mesh::from_bytes(&bytes).map_err(|e| SceneError::content(&path.display().to_string(), "a mesh", e))
}
