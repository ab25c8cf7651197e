//! PLY: the elements `vertex` and `face`.

use crate::MeshFileError;
use geom::{Vec3, mesh::TriMesh};
use stream::ply::{self, ListColumn, Ply};

pub(crate) fn matches(bytes: &[u8]) -> bool {
    bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r")
}

pub(crate) fn read(bytes: &[u8]) -> Result<TriMesh, MeshFileError> {
    let ply = ply::parse(bytes).map_err(MeshFileError::Ply)?;
    let vertices = vertices(&ply)?;
    let is_corners = |l: &&ListColumn| l.name == "vertex_indices" || l.name == "vertex_index";
    let corners = ply.element("face").and_then(|f| f.lists.iter().find(is_corners));
    let corners = corners.ok_or(MeshFileError::NoFaces)?;
    let mut faces = Vec::with_capacity(corners.ends.len());
    for face in 0..corners.ends.len() {
        let row = corners.row(face);
        if row.len() < 3 {
            let what = format!("{} corners; a face has at least 3", row.len());
            return Err(MeshFileError::Face { face, what });
        }
        let corner = |i: usize| {
            let v = corners.values.get(i);
            if v >= 0.0 && v < vertices.len() as f64 && v.fract() == 0.0 {
                return Ok(v as u32);
            }
            let what = format!("vertex {v} of {} is not there", vertices.len());
            Err(MeshFileError::Face { face, what })
        };
        let first = corner(row.start)?;
        for i in row.start + 1..row.end - 1 {
            faces.push([first, corner(i)?, corner(i + 1)?]);
        }
    }
    Ok(TriMesh::new(vertices, faces)?)
}

fn vertices(ply: &Ply) -> Result<Vec<Vec3>, MeshFileError> {
    let Some(vertex) = ply.element("vertex") else { return Err(MeshFileError::NoPosition("x")) };
    let column = |name| vertex.table.get(name).ok_or(MeshFileError::NoPosition(name));
    let (x, y, z) = (column("x")?, column("y")?, column("z")?);
    Ok((0..vertex.table.rows()).map(|i| Vec3::new(x.get(i), y.get(i), z.get(i))).collect())
}
