//! What a file of a mesh holds, and its lines.

use crate::MeshFileError;
use geom::mesh::{MeshError, TriMesh};

/// What a file of a mesh holds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Contents {
    /// Its surface; lengths as they are in the file [m]. It may have vertices and no face.
    pub mesh: TriMesh,
    /// What was left out, one sentence each.
    pub notes: Vec<String>,
    /// Whether coordinates stand in 4-byte numbers in the file.
    pub short: bool,
}

impl Contents {
    /// What 4-byte numbers have lost far from the origin, and what helps.
    pub fn lost_digits(&self) -> Option<String> {
        let lost = self.short.then(|| geom::digits::lost(&self.mesh.vertices)).flatten()?;
        Some(format!(
            "{lost}: export the drawing with all digits (OBJ, ASCII STL, PLY with double), or with its origin near the equipment"
        ))
    }

    /// Its surface, and what the user is to know of the file.
    ///
    /// # Errors
    /// Vertices without a face.
    pub fn surface(self) -> Result<(TriMesh, Vec<String>), MeshFileError> {
        if self.mesh.faces.is_empty() {
            return Err(MeshError::Empty.into());
        }
        let warnings = self.notes.iter().cloned().chain(self.lost_digits()).collect();
        Ok((self.mesh, warnings))
    }
}

impl From<TriMesh> for Contents {
    fn from(mesh: TriMesh) -> Contents {
        Contents { mesh, ..Contents::default() }
    }
}

/// Lines of text, lossy, with their numbers from 1; line ends may be LF, CRLF or CR. A byte order mark belongs to none of them.
pub fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, std::borrow::Cow<'_, str>)> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    (1..).zip(bytes.split(move |&b| b == end)).map(|(n, line)| (n, String::from_utf8_lossy(line)))
}
