//! Triangles from a file.

use crate::error::SceneError;
use geom::mesh::TriMesh;
use std::path::Path;

/// Reads a mesh (PLY, STL, OBJ; polygons are cut into triangles).
///
/// # Errors
/// A file of another kind, faces without vertices.
pub fn read(path: &Path) -> Result<TriMesh, SceneError> {
    let name = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|source| SceneError::Read { name: name.clone(), source })?;
    mesh::from_bytes(&bytes).map_err(|e| SceneError::Content { name, wanted: "a mesh", source: e.into() })
}
