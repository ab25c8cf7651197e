//! LAS and LAZ, by the `las` crate.

use super::{ReadError, catch, laz};
use crate::Cloud;
use geom::Vec3;
use las::{Header, LazParallelism, PointData, Reader, ReaderOptions};
use std::io::Cursor;
use stream::{Table, Values};

/// Points decoded at once; a header that claims more than there are then costs no memory.
const CHUNK: u64 = 1 << 20;
/// Room for them at most [B]: a header may also claim large points.
const ROOM: u64 = 1 << 26;
/// Files below this [B] are unpacked by one thread.
const SMALL: u64 = 1 << 22;
/// Packed points of a byte of the file at most; scans have less than one.
const DENSEST: u64 = 1000;

pub(super) fn matches(bytes: &[u8]) -> bool {
    bytes.starts_with(b"LASF")
}

pub(super) fn read(bytes: Vec<u8>) -> Result<Cloud, ReadError> {
    catch("LAS/LAZ", move || decode(bytes))
}

fn broken(what: impl ToString, point: u64) -> ReadError {
    ReadError::Broken { format: "LAS/LAZ", what: what.to_string(), point: Some(point) }
}

fn decode(bytes: Vec<u8>) -> Result<Cloud, ReadError> {
    laz::before_the_header(&bytes).map_err(|e| broken(e, 0))?;
    let header = Header::new(Cursor::new(&bytes)).map_err(|e| broken(e, 0))?;
    let whole = laz::before_the_points(&bytes, &header).map_err(|e| broken(e, 0))?;
    let length = bytes.len() as u64;
    let parallel = if whole && length >= SMALL { LazParallelism::Yes } else { LazParallelism::No };
    let options = ReaderOptions::default().with_laz_parallelism(parallel);
    let mut reader = Reader::with_options(Cursor::new(bytes), options).map_err(|e| broken(e, 0))?;
    let (promised, format) = (reader.header().number_of_points(), reader.header().point_format());
    let size = u64::from(format.len()).max(1);
    let most = if format.is_compressed { DENSEST.saturating_mul(length) } else { length / size };
    if promised > most {
        return Err(broken(
            format!("the header promises {promised} points in {length} bytes: it is cut off"),
            0,
        ));
    }
    let at_once = CHUNK.min(ROOM / size);
    let mut points: Vec<Vec3> = Vec::new();
    let mut columns: Vec<(&'static str, Values)> = Vec::new();
    while (points.len() as u64) < promised {
        let at = points.len() as u64;
        let chunk = reader.read_points(at_once.min(promised - at)).map_err(|e| broken(e, at))?;
        if chunk.is_empty() {
            let what = format!("the header promises {promised} points, the file ends before: it is cut off");
            return Err(broken(what, at));
        }
        points.extend(chunk.x().zip(chunk.y()).zip(chunk.z()).map(|((x, y), z)| Vec3::new(x, y, z)));
        append(&mut columns, columns_of(&chunk));
    }
    let mut attributes = Table::with_rows(points.len());
    for (name, values) in columns {
        attributes.push(name, values).map_err(|source| ReadError::Table { format: "LAS/LAZ", source })?;
    }
    Ok(Cloud { points, attributes, double: true, ..Cloud::default() })
}

/// The attributes that this point format has.
fn columns_of(chunk: &PointData) -> Vec<(&'static str, Values)> {
    let mut columns = vec![
        ("intensity", Values::U16(chunk.intensity().collect())),
        ("return_number", Values::U8(chunk.return_number().collect())),
        ("number_of_returns", Values::U8(chunk.number_of_returns().collect())),
        ("classification", Values::U8(chunk.classification().collect())),
        ("scan_angle", Values::F32(chunk.scan_angle_degrees().collect())),
        ("user_data", Values::U8(chunk.user_data().collect())),
        ("point_source_id", Values::U16(chunk.point_source_id().collect())),
    ];
    if let Some(time) = chunk.gps_time() {
        columns.push(("gps_time", Values::F64(time.collect())));
    }
    if let Some(rgb) = chunk.rgb() {
        let rgb: Vec<(u16, u16, u16)> = rgb.collect();
        columns.push(("red", Values::U16(rgb.iter().map(|c| c.0).collect())));
        columns.push(("green", Values::U16(rgb.iter().map(|c| c.1).collect())));
        columns.push(("blue", Values::U16(rgb.iter().map(|c| c.2).collect())));
    }
    if let Some(nir) = chunk.nir() {
        columns.push(("nir", Values::U16(nir.collect())));
    }
    columns
}

/// Adds the rows of one chunk; every chunk of a file has the same columns.
fn append(all: &mut Vec<(&'static str, Values)>, chunk: Vec<(&'static str, Values)>) {
    if all.is_empty() {
        *all = chunk;
        return;
    }
    for ((_, column), (_, rows)) in all.iter_mut().zip(chunk) {
        match (column, rows) {
            (Values::U8(a), Values::U8(b)) => a.extend(b),
            (Values::U16(a), Values::U16(b)) => a.extend(b),
            (Values::F32(a), Values::F32(b)) => a.extend(b),
            (Values::F64(a), Values::F64(b)) => a.extend(b),
            _ => {}
        }
    }
}
