//! Why bytes are no mesh.

use geom::mesh::MeshError;
use stream::ply::PlyError;
use thiserror::Error;

/// Why bytes are no mesh.
#[derive(Debug, Error)]
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
