//! Triangle meshes from files, detected by their content, never by the file name.
//!
//! ```text
//! PLY            ASCII and binary; faces with more than three corners are cut into triangles
//! STL            ASCII and binary, all solids of a file; vertices at equal places are made one
//! OBJ            `v` and `f` lines, faces cut as in PLY; groups and objects become one mesh
//! triangles      text, nine numbers a line: three corners [m]; a first line of words is passed over
//! ```
//!
//! Lengths are taken as metres: none of these formats says its unit. The caller scales.

mod contents;
mod error;
mod obj;
mod ply;
mod polygon;
mod stl;
mod triangles;

pub use contents::Contents;
pub use error::MeshFileError;
pub use ply::{axes as ply_axes, write_ply};

use geom::Shape;
use geom::mesh::TriMesh;
use geom::shape::ShapeError;
use std::path::{Path, PathBuf};

struct Format {
    name: &'static str,
    /// Whether these are its first bytes.
    matches: fn(&[u8]) -> bool,
    read: fn(&[u8]) -> Result<Contents, MeshFileError>,
}

/// Every format that a mesh is read from; what has no mark of its own comes last.
const FORMATS: [Format; 4] = [
    Format { name: "PLY", matches: ply::matches, read: ply::read },
    Format { name: "STL", matches: stl::matches, read: stl::read },
    Format { name: "OBJ", matches: obj::matches, read: obj::read },
    Format { name: "triangles", matches: triangles::matches, read: triangles::read },
];

/// Reads a mesh that is in memory; lengths come as they are in the file [m].
///
/// # Errors
/// Content that is not a mesh, or is truncated, with its place; a mesh without a face.
pub fn from_bytes(bytes: &[u8]) -> Result<TriMesh, MeshFileError> {
    Ok(contents(bytes)?.surface()?.0)
}

/// Reads what a file in memory holds, also if it is vertices without a face.
///
/// # Errors
/// As [`from_bytes`].
pub fn contents(bytes: &[u8]) -> Result<Contents, MeshFileError> {
    if bytes.is_empty() {
        return Err(MeshFileError::Empty);
    }
    if is_step(bytes) {
        return Err(MeshFileError::Step);
    }
    let Some(format) = FORMATS.iter().find(|f| (f.matches)(bytes)) else {
        let start: String =
            bytes.iter().take(12).flat_map(|b| std::ascii::escape_default(*b)).map(char::from).collect();
        return Err(MeshFileError::Unknown { start: format!("'{start}'") });
    };
    (format.read)(bytes)
}

/// Whether these bytes begin a file of STEP, whose surfaces are not triangles.
pub fn is_step(bytes: &[u8]) -> bool {
    bytes.trim_ascii_start().starts_with(b"ISO-10303-21")
}

/// The name of the format of a mesh, STL or OBJ, that `bytes` begin with. PLY may be a cloud, and text with nine numbers too.
pub fn is_drawing(bytes: &[u8]) -> Option<&'static str> {
    let drawings = FORMATS.iter().filter(|f| matches!(f.name, "STL" | "OBJ"));
    drawings.into_iter().find(|f| (f.matches)(bytes)).map(|f| f.name)
}

/// Reads the file of a shape `mesh:FILE`, with the whole reason in one line.
///
/// # Errors
/// As [`from_bytes`]; a file that cannot be read.
pub fn load(file: &str) -> Result<TriMesh, String> {
    let bytes = stream::whole::file(Path::new(file)).map_err(|e| format!("cannot read the mesh: {e}"))?;
    from_bytes(&bytes).map_err(|e| {
        let cause = std::error::Error::source(&e).map(|c| format!(": {c}")).unwrap_or_default();
        format!("{file}: {e}{cause}")
    })
}

/// Reads a SHAPE of the command line, `mesh:FILE` included.
///
/// # Errors
/// As [`Shape::parse`].
pub fn shape(text: &str) -> Result<Shape, ShapeError> {
    Shape::parse(text, &load)
}

/// Files that shapes name, relative to a folder.
pub struct Files<'a>(pub &'a Path);

impl geom::shape::ShapeFiles for Files<'_> {
    fn path(&self, file: &str) -> PathBuf {
        self.0.join(file)
    }

    fn mesh(&self, file: &str) -> Result<TriMesh, String> {
        load(&self.path(file).display().to_string())
    }
}
