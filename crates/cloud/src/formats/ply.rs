//! PLY clouds and meshes, on top of `stream::ply`.

use super::ReadError;
use crate::Cloud;
use geom::Vec3;
use geom::mesh::TriMesh;
use std::io::{Read, Write};
use stream::ply::{self, Element, Encoding, Kind, ListColumn, Ply, PlyError};
use stream::{Table, Values};

pub(super) fn matches(bytes: &[u8]) -> bool {
    bytes.starts_with(b"ply") && matches!(bytes.get(3), Some(b'\n' | b'\r' | b' ') | None)
}

/// The element with positions; `vertex` when there are several. Properties that are lists stay behind.
pub(super) fn read(bytes: Vec<u8>) -> Result<Cloud, ReadError> {
    let ply = ply::parse(&bytes).map_err(ReadError::Ply)?;
    drop(bytes);
    let has_x = |e: &Element| e.table.get("x").is_some();
    let at = ply.elements.iter().position(|e| e.name == "vertex" && has_x(e));
    let at = at.or_else(|| ply.elements.iter().position(has_x)).ok_or(ReadError::NoPosition)?;
    let Ply { comments, mut elements, .. } = ply;
    let element = elements.swap_remove(at);
    from_element(element, comments)
}

fn from_element(element: Element, mut comments: Vec<String>) -> Result<Cloud, ReadError> {
    let Element { name, table: mut attributes, lists } = element;
    let position_column = attributes.columns().iter().position(|c| c.name == "x").unwrap_or(0);
    let take = |attributes: &mut Table, axis: &'static str| {
        let missing = || ReadError::HalfPosition { element: name.clone(), missing: axis };
        attributes.remove(axis).ok_or_else(missing)
    };
    let x = take(&mut attributes, "x")?;
    let y = take(&mut attributes, "y")?;
    let z = take(&mut attributes, "z")?;
    let double = [&x, &y, &z].iter().any(|v| !matches!(v, Values::F32(_)));
    comments.extend(lists.iter().map(|l| format!("the list property {} was left out", l.name)));
    Ok(Cloud { points: zip(&x, &y, &z), attributes, double, position_column, comments })
}

/// Three columns as points.
fn zip(x: &Values, y: &Values, z: &Values) -> Vec<Vec3> {
    if let (Values::F32(x), Values::F32(y), Values::F32(z)) = (x, y, z) {
        return x
            .iter()
            .zip(y)
            .zip(z)
            .map(|((&x, &y), &z)| Vec3::new(x.into(), y.into(), z.into()))
            .collect();
    }
    (0..x.len()).map(|i| Vec3::new(x.get(i), y.get(i), z.get(i))).collect()
}

/// The cloud as a PLY with one element, `vertex`; columns in the order they came in.
pub fn to_ply(cloud: &Cloud) -> Ply {
    let mut table = Table::with_rows(cloud.points.len());
    let place = cloud.position_column.min(cloud.attributes.columns().len());
    let (before, after) = cloud.attributes.columns().split_at(place);
    let coordinates = [0, 1, 2].map(|a| {
        if cloud.double {
            Values::F64(cloud.points.iter().map(|p| p[a]).collect())
        } else {
            Values::F32(cloud.points.iter().map(|p| p[a] as f32).collect())
        }
    });
    let mut push = |name: &str, values: Values| {
        // Attributes have as many rows as there are points and no second x: `push` cannot refuse.
        let pushed = table.push(name, values);
        debug_assert!(pushed.is_ok(), "{pushed:?}");
    };
    before.iter().for_each(|c| push(&c.name, c.values.clone()));
    for (name, values) in ["x", "y", "z"].into_iter().zip(coordinates) {
        push(name, values);
    }
    after.iter().for_each(|c| push(&c.name, c.values.clone()));
    let vertex = Element { name: "vertex".into(), table, lists: Vec::new() };
    Ply { comments: cloud.comments.clone(), obj_info: Vec::new(), elements: vec![vertex] }
}

/// Writes the cloud as PLY.
///
/// # Errors
/// A stream that takes no more.
pub fn write_ply(to: &mut impl Write, cloud: &Cloud, encoding: Encoding) -> Result<(), PlyError> {
    ply::write(to, &to_ply(cloud), encoding)
}

/// Writes a mesh as PLY, coordinates as `double`.
///
/// # Errors
/// A stream that takes no more.
pub fn write_mesh(to: &mut impl Write, mesh: &TriMesh, encoding: Encoding) -> Result<(), PlyError> {
    let mut table = Table::with_rows(mesh.vertices.len());
    for (a, name) in ["x", "y", "z"].into_iter().enumerate() {
        let values = Values::F64(mesh.vertices.iter().map(|p| p[a]).collect());
        let element = "vertex".to_owned();
        table.push(name, values).map_err(|source| PlyError::Table { element, source })?;
    }
    let indices = ListColumn {
        name: "vertex_indices".into(),
        position: 0,
        count_kind: Kind::U8,
        ends: (1..=mesh.faces.len()).map(|f| 3 * f).collect(),
        values: Values::I32(mesh.faces.iter().flatten().map(|&v| v as i32).collect()),
    };
    let vertex = Element { name: "vertex".into(), table, lists: Vec::new() };
    let face =
        Element { name: "face".into(), table: Table::with_rows(mesh.faces.len()), lists: vec![indices] };
    let ply = Ply { elements: vec![vertex, face], ..Ply::default() };
    ply::write(to, &ply, encoding)
}

/// Reads a mesh: PLY, STL, OBJ or a list of triangles, told apart by content.
///
/// # Errors
/// Content that is no mesh, with the face.
pub fn read_mesh(from: &mut impl Read) -> Result<TriMesh, ReadError> {
    let mut bytes = Vec::new();
    from.read_to_end(&mut bytes).map_err(ReadError::Io)?;
    Ok(mesh::from_bytes(&bytes)?)
}
