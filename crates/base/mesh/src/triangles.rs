//! Text with one triangle per line: nine numbers, the corners [m]. Benchmarks of particle codes use it for walls.

use crate::contents::lines;
use crate::{Contents, MeshFileError};
use geom::{Vec3, mesh::TriMesh};

pub(crate) fn matches(bytes: &[u8]) -> bool {
    // The first line may be of words.
    lines(bytes).filter(|(_, line)| !line.trim().is_empty()).take(2).any(|(_, line)| corners(&line).is_some())
}

pub(crate) fn read(bytes: &[u8]) -> Result<Contents, MeshFileError> {
    let mut vertices: Vec<Vec3> = Vec::new();
    for (line, text) in lines(bytes) {
        if text.trim().is_empty() || text.trim_start().starts_with('#') {
            continue;
        }
        match corners(&text) {
            Some(three) => vertices.extend(three),
            None if vertices.is_empty() && text.trim_start().starts_with(|c: char| c.is_alphabetic()) => {}
            None => {
                let text = text.trim().chars().take(60).collect();
                return Err(MeshFileError::Line { line, what: "nine numbers are a triangle, not", text });
            }
        }
    }
    let faces = (0..vertices.len() as u32 / 3).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
    Ok(TriMesh::new(vertices, faces)?.into())
}

/// The corners of a line of nine finite numbers and nothing else.
fn corners(line: &str) -> Option<[Vec3; 3]> {
    let words = line.split(|c: char| c.is_whitespace() || c == ',' || c == ';').filter(|w| !w.is_empty());
    let numbers: Vec<f64> = words.map(|w| w.parse().ok()).collect::<Option<_>>()?;
    let [a, b, c, d, e, f, g, h, i] = numbers.try_into().ok()?;
    Some([Vec3::new(a, b, c), Vec3::new(d, e, f), Vec3::new(g, h, i)])
}
