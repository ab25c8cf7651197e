//! Walls that are surfaces: planes and triangle meshes, which may move.

use crate::motion::{Motion, vector};
use geom::{Plane, mesh::TriMesh};
use serde_json::Value;

/// A wall that is a plane or a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// Name, as shown.
    pub name: String,
    /// Where it is at t = 0.
    pub shape: SurfaceShape,
    /// How it moves.
    pub motion: Motion,
}

/// The shape of a wall.
#[derive(Debug, Clone, PartialEq)]
pub enum SurfaceShape {
    /// Unbounded; a part of it around everything else is shown.
    Plane(Plane),
    /// Triangles, seen from both sides.
    Mesh(TriMesh),
}

impl SurfaceShape {
    /// The shape that a run writes of a wall: none for wall spheres.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn of(json: &Value) -> Result<Option<SurfaceShape>, String> {
        if let Some(plane) = json.get("plane") {
            let part = |name: &str| vector(&plane[name]).ok_or(format!("plane: {name}: not three numbers"));
            let plane = Plane::new(part("point")?, part("normal")?).map_err(|e| e.to_string())?;
            return Ok(Some(SurfaceShape::Plane(plane)));
        }
        let Some(mesh) = json.get("mesh") else { return Ok(None) };
        let rows = |name: &str| mesh[name].as_array().ok_or(format!("mesh: {name}: not a list"));
        let vertices = rows("vertices")?.iter().map(vector).collect::<Option<Vec<_>>>();
        let faces = rows("faces")?.iter().map(corners).collect::<Option<Vec<_>>>();
        let vertices = vertices.ok_or("mesh: a vertex is not three numbers")?;
        let faces = faces.ok_or("mesh: a face is not three vertex numbers")?;
        TriMesh::new(vertices, faces).map(|m| Some(SurfaceShape::Mesh(m))).map_err(|e| format!("mesh: {e}"))
    }
}

fn corners(json: &Value) -> Option<[u32; 3]> {
    let numbers: Vec<u32> = json.as_array()?.iter().filter_map(|v| u32::try_from(v.as_u64()?).ok()).collect();
    numbers.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_shape_is_read_or_refused_by_what_is_wrong() {
        let mesh = |face: [u32; 3]| {
            SurfaceShape::of(
                &json!({"mesh": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "faces": [face]}}),
            )
        };
        assert!(matches!(mesh([0, 1, 2]), Ok(Some(SurfaceShape::Mesh(_)))));
        assert!(mesh([0, 1, 3]).is_err_and(|e| e.contains("vertex 3")));
        assert!(matches!(SurfaceShape::of(&json!({"spheres": 12})), Ok(None)));
        let flat = json!({"plane": {"point": [0, 0, 0], "normal": [0, 0]}});
        assert!(SurfaceShape::of(&flat).is_err_and(|e| e.contains("normal")));
    }
}
