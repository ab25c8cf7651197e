//! LAS and LAZ, by the `las` crate.

use super::laz::{self, Bytes, STACK, Shallow};
use super::{ReadError, catch};
use crate::Cloud;
use geom::Vec3;
use las::{Header, LazParallelism, PointData, Reader, ReaderOptions};
use std::io::Cursor;
use std::sync::Arc;
use std::thread::ScopedJoinHandle;
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
    let firsts = laz::before_the_points(&bytes, &header).map_err(|e| broken(e, 0))?;
    let length = bytes.len() as u64;
    let (promised, format) = (header.number_of_points(), header.point_format());
    let size = u64::from(format.len()).max(1);
    let most = if format.is_compressed { DENSEST.saturating_mul(length) } else { length / size };
    if promised > most {
        return Err(broken(
            format!("the header promises {promised} points in {length} bytes: it is cut off"),
            0,
        ));
    }
    let threads = if length < SMALL { 1 } else { rayon::current_num_threads().max(1) };
    let bytes = Bytes(Arc::new(bytes));
    let parts: Vec<_> = shares(&firsts, promised, threads as u64)
        .windows(2)
        .map(|w| Part {
            from: w[0],
            to: w[1],
            promised,
            at_once: CHUNK.min(ROOM / size / threads as u64).max(1),
        })
        .collect();
    let read = |part: &Part| part.read(bytes.clone());
    let parts: Vec<Result<Rows, ReadError>> = std::thread::scope(|scope| {
        let spawn =
            |part| std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, move || read(part));
        let running: Vec<_> = parts.iter().map(spawn).collect();
        let outcome = |thread: std::io::Result<ScopedJoinHandle<_>>| match thread {
            Ok(thread) => thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
            Err(why) => Err(ReadError::Io(why)),
        };
        running.into_iter().map(outcome).collect()
    });
    let mut all = Rows::default();
    parts.into_iter().try_for_each(|part| part.map(|rows| all.append(rows)))?;
    let mut attributes = Table::with_rows(all.points.len());
    for (name, values) in all.columns {
        attributes.push(name, values).map_err(|source| ReadError::Table { format: "LAS/LAZ", source })?;
    }
    Ok(Cloud { points: all.points, attributes, double: true, ..Cloud::default() })
}

/// Bounds of the shares of so many threads, at chunks that begin with these points.
fn shares(firsts: &[u64], promised: u64, threads: u64) -> Vec<u64> {
    let near = |share: u64| firsts.partition_point(|&first| first < promised / threads * share);
    let mut bounds: Vec<u64> = (0..threads).filter_map(|t| firsts.get(near(t)).copied()).collect();
    bounds.push(promised);
    bounds.dedup();
    bounds
}

/// Points that one thread reads.
struct Part {
    from: u64,
    to: u64,
    /// Points of the whole file.
    promised: u64,
    at_once: u64,
}

/// Points and their attributes.
#[derive(Default)]
struct Rows {
    points: Vec<Vec3>,
    columns: Vec<(&'static str, Values)>,
}

impl Rows {
    fn append(&mut self, rows: Rows) {
        self.points.extend(rows.points);
        append(&mut self.columns, rows.columns);
    }
}

impl Part {
    fn read(&self, bytes: Bytes) -> Result<Rows, ReadError> {
        let options = ReaderOptions::default().with_laz_parallelism(LazParallelism::No);
        let mut reader = Reader::with_options(Shallow::new(bytes), options).map_err(|e| broken(e, 0))?;
        if self.from > 0 {
            reader.seek(self.from).map_err(|e| broken(e, self.from))?;
        }
        let mut rows = Rows::default();
        loop {
            let at = self.from + rows.points.len() as u64;
            if at >= self.to {
                return Ok(rows);
            }
            let chunk = reader.read_points(self.at_once.min(self.to - at)).map_err(|e| broken(e, at))?;
            if chunk.is_empty() {
                let promised = self.promised;
                let what =
                    format!("the header promises {promised} points, the file ends before: it is cut off");
                return Err(broken(what, at));
            }
            let points =
                chunk.x().zip(chunk.y()).zip(chunk.z()).map(|((x, y), z)| Vec3::new(x, y, z)).collect();
            rows.append(Rows { points, columns: columns_of(&chunk) });
        }
    }
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
