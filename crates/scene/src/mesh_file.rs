//! Triangles from a file.

use crate::error::SceneError;
use geom::{Vec3, mesh::TriMesh};
use std::path::Path;

/// Reads a mesh (PLY; polygons are cut into triangles).
///
/// # Errors
/// A file of another kind, faces without vertices.
pub fn read(path: &Path) -> Result<TriMesh, SceneError> {
    let name = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|source| SceneError::Read { name: name.clone(), source })?;
    if !bytes.starts_with(b"ply") {
        let why = if bytes.starts_with(b"solid")
            || path.extension().is_some_and(|e| e.eq_ignore_ascii_case("stl"))
        {
            "not available yet: meshes in STL"
        } else {
            "is no PLY file"
        };
        return Err(SceneError::file(&name, why, "convert it to PLY"));
    }
    let wrong = |e: stream::ply::PlyError| SceneError::Content {
        name: name.clone(),
        wanted: "a mesh",
        source: e.into(),
    };
    let ply = stream::ply::parse(&bytes).map_err(wrong)?;
    triangles(&name, &ply)
}

fn triangles(name: &str, ply: &stream::ply::Ply) -> Result<TriMesh, SceneError> {
    let missing = |what: &str| SceneError::file(name, format!("has no {what}"), "give a mesh, not a cloud");
    let vertex = ply.element("vertex").ok_or_else(|| missing("vertices"))?;
    let face = ply.element("face").filter(|f| f.table.rows() > 0 || !f.lists.is_empty());
    let face = face.ok_or_else(|| missing("faces"))?;
    let list = face.lists.iter().find(|l| l.name.starts_with("vertex_ind"));
    let list = list.ok_or_else(|| missing("list 'vertex_indices'"))?;
    let columns = crate::columns::Columns { name, table: &vertex.table };
    let vertices: Vec<Vec3> = columns.vectors(["x", "y", "z"])?;
    let mut faces = Vec::new();
    for row in 0..list.ends.len() {
        let corners: Vec<u32> = list.row(row).map(|i| list.values.get(i) as u32).collect();
        for k in 1..corners.len().saturating_sub(1) {
            faces.push([corners[0], corners[k], corners[k + 1]]);
        }
    }
    if faces.is_empty() {
        return Err(missing("faces"));
    }
    let mesh = TriMesh::new(vertices, faces);
    mesh.map_err(|e| SceneError::file(name, e.to_string(), "repair the mesh"))
}
