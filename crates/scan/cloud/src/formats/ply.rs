//! PLY clouds and meshes, on top of `stream::ply`.

use super::error::ReadError;
use crate::points::Cloud;
use geom::Vec3;
use geom::mesh::TriMesh;
use std::io::{Read, Write};
use stream::ply::{self, Blocks, Element, Encoding, NumberType, Opened, Ply, PlyError, number_at};
use stream::{Fill, Table, Values};

pub(super) fn matches(bytes: &[u8]) -> bool {
    bytes.starts_with(b"ply") && matches!(bytes.get(3), Some(b'\n' | b'\r' | b' ') | None)
}

/// The element with positions. Properties that are lists stay behind.
pub(super) fn read(bytes: Vec<u8>) -> Result<Cloud, ReadError> {
    let ply = ply::parse(&bytes).map_err(ReadError::Ply)?;
    drop(bytes);
    let has_x = |e: &Element| e.table.get(axes(&e.table)[0]).is_some();
    let has_points = |e: &Element| axes(&e.table).iter().all(|axis| e.table.get(axis).is_some());
    let mut clouds = ply.elements.iter().filter(|e| has_points(e) && e.table.rows() > 0);
    if let (Some(one), Some(other)) = (clouds.next(), clouds.next()) {
        return Err(ReadError::TwoClouds { one: one.name.clone(), other: other.name.clone() });
    }
    let at = ply.elements.iter().position(|e| e.name == "vertex" && has_x(e));
    let at = at.or_else(|| ply.elements.iter().position(has_x)).ok_or(ReadError::NoPosition)?;
    let Ply { comments, mut elements, .. } = ply;
    let element = elements.swap_remove(at);
    from_element(element, comments)
}

/// Reads a cloud that is a plain binary PLY, row by row; else the bytes that were read come back, and what follows them.
pub(super) fn stream<R: Read>(opened: Opened<R>) -> Result<Result<Cloud, (Vec<u8>, R)>, ReadError> {
    match opened {
        Opened::Blocks(blocks) if positions(&blocks).is_some() => from_blocks(blocks).map(Ok),
        Opened::Blocks(blocks) => Ok(Err(blocks.into_parts())),
        Opened::Other(bytes, from) => Ok(Err((bytes, from))),
    }
}

/// The names of x, y and z in a table: capitals only where there is no small letter.
fn axes(table: &Table) -> [&'static str; 3] {
    mesh::ply_axes(|name| table.get(name).is_some())
}

/// Which properties are x, y and z; none when one is missing.
fn positions<R>(blocks: &Blocks<R>) -> Option<[usize; 3]> {
    let at = |axis: &str| blocks.properties.iter().position(|p| p.name == axis);
    let [x, y, z] = mesh::ply_axes(|axis| at(axis).is_some());
    Some([at(x)?, at(y)?, at(z)?])
}

/// Points and columns, block by block.
fn from_blocks<R: Read>(mut blocks: Blocks<R>) -> Result<Cloud, ReadError> {
    let Some(at) = positions(&blocks) else { return Err(ReadError::NoPosition) };
    let stride = blocks.stride;
    let axes = at.map(|k| (blocks.properties[k].kind, blocks.properties[k].offset));
    let others: Vec<usize> = (0..blocks.properties.len()).filter(|k| !at.contains(k)).collect();
    let mut columns: Vec<Values> = others.iter().map(|&k| blocks.properties[k].kind.empty()).collect();
    let places: Vec<usize> = others.iter().map(|&k| blocks.properties[k].offset).collect();
    let mut points = Vec::new();
    while let Some(rows) = blocks.next_rows().map_err(ReadError::Ply)? {
        extend(&mut points, rows, stride, axes);
        columns.iter_mut().zip(&places).for_each(|(c, &place)| c.extend_from_rows(rows, stride, place));
    }
    let mut attributes = Table::with_rows(points.len());
    for (k, values) in others.into_iter().zip(columns) {
        let table = |source| ReadError::Table { format: "PLY", source };
        attributes.push(&blocks.properties[k].name, values).map_err(table)?;
    }
    let double = axes.iter().any(|(kind, _)| *kind != NumberType::F32);
    let comments = std::mem::take(&mut blocks.comments);
    Ok(Cloud { points, attributes, double, position_column: at[0], comments, ..Cloud::default() })
}

/// Adds the points of whole rows of `stride` bytes; types and places of x, y and z.
fn extend(points: &mut Vec<Vec3>, rows: &[u8], stride: usize, axes: [(NumberType, usize); 3]) {
    let rows = rows.chunks_exact(stride);
    let [(_, x), (_, y), (_, z)] = axes;
    let long = |row: &[u8], at: usize| number_at(&row[at..], NumberType::F64);
    let short = |row: &[u8], at: usize| number_at(&row[at..], NumberType::F32);
    match axes.map(|(kind, _)| kind) {
        [NumberType::F32, NumberType::F32, NumberType::F32] => {
            points.extend(rows.map(|row| Vec3::new(short(row, x), short(row, y), short(row, z))));
        }
        [NumberType::F64, NumberType::F64, NumberType::F64] => {
            points.extend(rows.map(|row| Vec3::new(long(row, x), long(row, y), long(row, z))));
        }
        _ => points.extend(rows.map(|row| Vec3::from(axes.map(|(kind, at)| number_at(&row[at..], kind))))),
    }
}

fn from_element(element: Element, mut comments: Vec<String>) -> Result<Cloud, ReadError> {
    let Element { name, table: mut attributes, lists } = element;
    let [x, y, z] = axes(&attributes);
    let position_column = attributes.columns().iter().position(|c| c.name == x).unwrap_or(0);
    let take = |attributes: &mut Table, axis: &'static str| {
        let missing = || ReadError::HalfPosition { element: name.clone(), missing: axis };
        attributes.remove(axis).ok_or_else(missing)
    };
    let x = take(&mut attributes, x)?;
    let y = take(&mut attributes, y)?;
    let z = take(&mut attributes, z)?;
    let double = [&x, &y, &z].iter().any(|v| !matches!(v, Values::F32(_)));
    comments.extend(lists.iter().map(|l| format!("the list property {} was left out", l.name)));
    Ok(Cloud { points: zip(&x, &y, &z), attributes, double, position_column, comments, ..Cloud::default() })
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
    if encoding != Encoding::BinaryLittleEndian {
        return ply::write(to, &to_ply(cloud), encoding);
    }
    let place = cloud.position_column.min(cloud.attributes.columns().len());
    let axes = [0, 1, 2].map(|axis| Axis { cloud, axis });
    let positions = ["x", "y", "z"].into_iter().zip(axes.iter().map(|axis| axis as &dyn Fill));
    let attributes = cloud.attributes.columns().iter().map(|c| (&*c.name, &c.values as &dyn Fill));
    let mut columns: Vec<(&str, &dyn Fill)> = attributes.collect();
    columns.splice(place..place, positions);
    ply::write_columns(to, &cloud.comments, ("vertex", cloud.points.len()), &columns)
}

/// One coordinate of all points, as a column.
struct Axis<'a> {
    cloud: &'a Cloud,
    axis: usize,
}

impl Fill for Axis<'_> {
    fn kind(&self) -> NumberType {
        if self.cloud.double { NumberType::F64 } else { NumberType::F32 }
    }

    fn fill(&self, first: usize, rows: &mut [u8], (stride, offset): (usize, usize)) {
        let rows = rows.chunks_exact_mut(stride).map(|row| &mut row[offset..]);
        let values = self.cloud.points[first..].iter().map(|p| p[self.axis]);
        match self.cloud.double {
            true => rows.zip(values).for_each(|(row, v)| row[..8].copy_from_slice(&v.to_le_bytes())),
            false => {
                rows.zip(values).for_each(|(row, v)| row[..4].copy_from_slice(&(v as f32).to_le_bytes()))
            }
        }
    }
}

/// Writes a mesh as PLY, coordinates as `double`.
///
/// # Errors
/// A stream that takes no more.
pub fn write_mesh(to: &mut impl Write, mesh: &TriMesh, encoding: Encoding) -> Result<(), PlyError> {
    mesh::write_ply(to, mesh, &[], encoding)
}

/// Reads a mesh: PLY, STL, OBJ or a list of triangles, detected by content.
///
/// # Errors
/// Content that is not a mesh, with the face.
pub fn read_mesh(from: &mut impl Read) -> Result<TriMesh, ReadError> {
    let mut bytes = Vec::new();
    stream::whole::rest(from, &mut bytes).map_err(ReadError::Io)?;
    Ok(mesh::from_bytes(&bytes)?)
}
