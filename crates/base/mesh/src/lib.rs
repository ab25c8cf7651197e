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

mod obj;
mod ply;
mod polygon;
mod stl;
mod triangles;

pub use ply::{axes as ply_axes, write_ply};

use geom::Shape;
use geom::mesh::{MeshError, TriMesh};
use geom::shape::ShapeError;
use std::path::{Path, PathBuf};
use stream::ply::PlyError;
use thiserror::Error;

/// Why bytes are no mesh.
#[derive(Debug, Error)]
#[allow(missing_docs)]
pub enum MeshFileError {
    #[error("nothing to read: the input is empty; did the previous tool fail?")]
    Empty,
    #[error(
        "no mesh begins with {start}: give PLY, STL, OBJ, or text with nine numbers per line (the corners of a triangle)"
    )]
    Unknown { start: String },
    #[error(
        "this is STEP: it holds exact surfaces, not triangles; export STL from the CAD system, or convert it: \
         FreeCAD (Part workbench, export as STL) or gmsh -2 -format stl PART.step -o PART.stl; such STL is in mm, so give its unit"
    )]
    Step,
    #[error("not a mesh")]
    Ply(#[source] PlyError),
    #[error("PLY: element 'vertex' has no property '{0}': a mesh needs x, y and z")]
    NoPosition(&'static str),
    #[error("the file has no element 'face' with a list 'vertex_indices': it is a cloud, not a mesh")]
    NoFaces,
    #[error("face {face}: {what}")]
    Face { face: usize, what: String },
    #[error(
        "STL: the file promises {promised} triangles and holds {held}: it is cut off, write or copy it again"
    )]
    CutOff { promised: u64, held: u64 },
    #[error("STL: {0}: export it again")]
    Stl(String),
    #[error("OBJ: {0}: export it again")]
    Obj(String),
    #[error("triangles: line {line}: {what}: '{text}'")]
    Line { line: usize, what: &'static str, text: String },
    #[error("{0}: repair the mesh")]
    Mesh(#[from] MeshError),
}

/// One format.
struct Format {
    name: &'static str,
    /// Whether these are its first bytes.
    matches: fn(&[u8]) -> bool,
    read: fn(&[u8]) -> Result<Contents, MeshFileError>,
}

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

/// Lines of text, lossy, with their numbers from 1; line ends may be LF, CRLF or CR. A byte order mark belongs to none of them.
fn lines(bytes: &[u8]) -> impl Iterator<Item = (usize, std::borrow::Cow<'_, str>)> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    (1..).zip(bytes.split(move |&b| b == end)).map(|(n, line)| (n, String::from_utf8_lossy(line)))
}
