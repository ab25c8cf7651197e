//! PLY: the elements `vertex` and `face`.

use crate::{Contents, MeshFileError, polygon};
use geom::{Vec3, mesh::TriMesh};
use std::io::Write;
use stream::ply::{self, Element, Encoding, ListColumn, NumberType, Ply, PlyError};
use stream::{Table, Values};

pub(crate) fn matches(bytes: &[u8]) -> bool {
    bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r")
}

pub(crate) fn read(bytes: &[u8]) -> Result<Contents, MeshFileError> {
    let ply = ply::parse(bytes).map_err(MeshFileError::Ply)?;
    let vertices = vertices(&ply)?;
    let is_corners = |l: &&ListColumn| l.name == "vertex_indices" || l.name == "vertex_index";
    let corners = ply.element("face").and_then(|f| f.lists.iter().find(is_corners));
    let corners = corners.ok_or(MeshFileError::NoFaces)?;
    let (mut faces, mut numbers) = (Vec::with_capacity(corners.ends.len()), Vec::new());
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
        numbers.clear();
        for i in row {
            numbers.push(corner(i)?);
        }
        polygon::cut(&numbers, &vertices, &mut faces).map_err(|what| MeshFileError::Face { face, what })?;
    }
    Ok(Contents { short: is_short(&ply), ..TriMesh::new(vertices, faces)?.into() })
}

/// The names of x, y and z: capitals only where no property has a small letter.
pub fn axes(is_there: impl Fn(&str) -> bool) -> [&'static str; 3] {
    let (small, capital) = (["x", "y", "z"], ["X", "Y", "Z"]);
    if !small.iter().any(|axis| is_there(axis)) && capital.iter().all(|axis| is_there(axis)) {
        capital
    } else {
        small
    }
}

fn vertices(ply: &Ply) -> Result<Vec<Vec3>, MeshFileError> {
    let Some(vertex) = ply.element("vertex") else { return Err(MeshFileError::NoPosition("x")) };
    let column = |name| vertex.table.get(name).ok_or(MeshFileError::NoPosition(name));
    let [x, y, z] = axes(|name| vertex.table.get(name).is_some());
    let (x, y, z) = (column(x)?, column(y)?, column(z)?);
    Ok((0..vertex.table.rows()).map(|i| Vec3::new(x.get(i), y.get(i), z.get(i))).collect())
}

/// Whether coordinates are 4-byte numbers.
fn is_short(ply: &Ply) -> bool {
    let x = ply.element("vertex").and_then(|v| ["x", "X"].iter().find_map(|name| v.table.get(name)));
    matches!(x, Some(Values::F32(_)))
}

/// Writes a mesh as PLY, with double coordinates.
///
/// # Errors
/// A write that fails.
pub fn write_ply(
    to: &mut impl Write,
    mesh: &TriMesh,
    comments: &[String],
    encoding: Encoding,
) -> Result<(), PlyError> {
    let mut table = Table::with_rows(mesh.vertices.len());
    for (a, name) in ["x", "y", "z"].into_iter().enumerate() {
        let values = Values::F64(mesh.vertices.iter().map(|p| p[a]).collect());
        let element = "vertex".to_owned();
        table.push(name, values).map_err(|source| PlyError::Table { element, source })?;
    }
    let indices = ListColumn {
        name: "vertex_indices".into(),
        position: 0,
        count_kind: NumberType::U8,
        ends: (1..=mesh.faces.len()).map(|f| 3 * f).collect(),
        values: Values::I32(mesh.faces.iter().flatten().map(|&v| v as i32).collect()),
    };
    let vertex = Element { name: "vertex".into(), table, lists: Vec::new() };
    let face =
        Element { name: "face".into(), table: Table::with_rows(mesh.faces.len()), lists: vec![indices] };
    let ply = Ply { elements: vec![vertex, face], comments: comments.to_vec(), ..Ply::default() };
    ply::write(to, &ply, encoding)
}
