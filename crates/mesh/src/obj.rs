//! Wavefront OBJ: the lines `v` and `f`; normals, textures and materials are ignored.

use crate::{MeshFileError, lines};
use geom::{Vec3, mesh::TriMesh};
use std::io::Cursor;

/// Lines among which the first vertex stands.
const FIRST_LINES: usize = 200;

pub(crate) fn matches(bytes: &[u8]) -> bool {
    let vertex = |(_, line): (usize, std::borrow::Cow<str>)| {
        let mut words = line.split_whitespace();
        words.next() == Some("v") && words.take(3).filter(|w| w.parse::<f64>().is_ok()).count() == 3
    };
    lines(bytes).take(FIRST_LINES).any(vertex)
}

pub(crate) fn read(bytes: &[u8]) -> Result<TriMesh, MeshFileError> {
    let options = tobj::LoadOptions { triangulate: true, single_index: false, ..Default::default() };
    let no_materials = |_: &std::path::Path| Ok(Default::default());
    let (models, _) = tobj::load_obj_buf(&mut Cursor::new(bytes), &options, no_materials)
        .map_err(|e| MeshFileError::Obj(e.to_string()))?;
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for model in models {
        let first = vertices.len() as u32;
        let (places, _) = model.mesh.positions.as_chunks::<3>();
        vertices.extend(places.iter().map(|&p| Vec3::from(p)));
        let (corners, _) = model.mesh.indices.as_chunks::<3>();
        faces.extend(corners.iter().map(|&face| face.map(|v| v.saturating_add(first))));
    }
    Ok(TriMesh::new(vertices, faces)?)
}
