//! STL, ASCII and binary (many binary files begin with the word "solid" too).

use crate::MeshFileError;
use geom::{Vec3, mesh::TriMesh};
use std::io::Cursor;

/// Bytes before the first triangle of a binary file, and of each triangle.
const HEAD: usize = 84;
const TRIANGLE: usize = 50;

pub(crate) fn matches(bytes: &[u8]) -> bool {
    is_ascii(bytes)
        || promised(bytes).is_some_and(|n| is_whole(bytes, n) || n > 0 && begins_with_a_triangle(bytes))
}

/// Whether a head with room for text is followed by a triangle: finite corners, and a normal of length 1 or 0.
fn begins_with_a_triangle(bytes: &[u8]) -> bool {
    let Some(triangle) = bytes.get(HEAD..HEAD + TRIANGLE) else { return bytes[..HEAD].contains(&0) };
    let (numbers, _) = triangle.as_chunks::<4>();
    let numbers: Vec<f64> = numbers[..12].iter().map(|b| f64::from(f32::from_le_bytes(*b))).collect();
    let normal = numbers[..3].iter().map(|n| n * n).sum::<f64>().sqrt();
    let plain = |n: &f64| *n == 0.0 || (1e-12..1e9).contains(&n.abs());
    bytes[..HEAD].contains(&0)
        && numbers.iter().any(|n| *n != 0.0)
        && numbers.iter().all(plain)
        && (normal < 1e-6 || (0.9..1.1).contains(&normal))
}

/// The word, and a facet or the end of the solid soon after it.
fn is_ascii(bytes: &[u8]) -> bool {
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(1024)]).to_ascii_lowercase();
    start.trim_start().starts_with("solid") && (start.contains("facet") || start.contains("endsolid"))
}

/// Triangles that the head of a binary file promises.
fn promised(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEAD - 4..HEAD)?;
    Some(count.iter().rev().fold(0, |sum, &b| sum << 8 | u64::from(b)))
}

fn is_whole(bytes: &[u8], promised: u64) -> bool {
    (bytes.len() - HEAD) as u64 == promised * TRIANGLE as u64
}

pub(crate) fn read(bytes: &[u8]) -> Result<TriMesh, MeshFileError> {
    if !is_ascii(bytes)
        && let Some(promised) = promised(bytes).filter(|&n| !is_whole(bytes, n))
    {
        let held = ((bytes.len() - HEAD) / TRIANGLE) as u64;
        return Err(MeshFileError::CutOff { promised, held });
    }
    let stl = stl_io::read_stl(&mut Cursor::new(bytes)).map_err(|e| MeshFileError::Stl(e.to_string()))?;
    if is_ascii(bytes) && !String::from_utf8_lossy(bytes).to_ascii_lowercase().contains("endsolid") {
        return Err(MeshFileError::Stl("the line 'endsolid' is missing: the file is cut off".to_owned()));
    }
    let vertices = stl.vertices.iter().map(|v| Vec3::from(v.0.map(f64::from))).collect();
    let faces = stl.faces.iter().map(|f| f.vertices.map(|v| v as u32)).collect();
    Ok(TriMesh::new(vertices, faces)?)
}
