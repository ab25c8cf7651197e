//! Drawings as clouds: the corners of the triangles of STL and OBJ, each once; the vertices of an OBJ without faces.

use super::error::ReadError;
use crate::points::Cloud;
use crate::points::ReadWarning;
use stream::Table;

/// Packed files and streams of other kinds, whose first bytes are no head of a drawing.
const OTHERS: [&[u8]; 4] = [b"\x1f\x8b", b"\x28\xb5\x2f\xfd", b"PK\x03\x04", b"\x89MCAP"];

pub(super) fn matches(bytes: &[u8]) -> bool {
    !OTHERS.iter().any(|other| bytes.starts_with(other)) && mesh::is_drawing(bytes).is_some()
}

pub(super) fn read(bytes: Vec<u8>) -> Result<Cloud, ReadError> {
    let contents = mesh::contents(&bytes)?;
    let lost = contents.lost_digits();
    let mesh::Contents { mesh, notes, .. } = contents;
    // Without faces each vertex is a point.
    let mesh = if mesh.faces.is_empty() { mesh } else { mesh.welded() };
    if mesh.vertices.is_empty() {
        return Err(mesh::MeshFileError::from(geom::mesh::MeshError::Empty).into());
    }
    let attributes = Table::with_rows(mesh.vertices.len());
    let comments = match mesh.faces.len() {
        0 => vec!["the vertices of a drawing without faces".to_owned()],
        faces => vec![format!("the corners of {faces} triangles")],
    };
    let mut cloud = Cloud { points: mesh.vertices, attributes, double: true, comments, ..Cloud::default() };
    notes.into_iter().for_each(|what| cloud.leave_out(what));
    // They are written in 8 bytes, which what moves or scales them needs, and their digits are lost all the same.
    cloud.warnings.extend(lost.map(ReadWarning::Digits));
    Ok(cloud)
}
