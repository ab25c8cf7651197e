//! LAS and LAZ, by the `las` crate.

use super::crs::{projected, reference_system};
use super::extra::{self, ExtraColumn};
use super::packed::{self, Bytes, Chunk, STACK, Shallow};
use super::units;
use crate::formats::error::ReadError;
use crate::formats::foreign;
use crate::points::Cloud;
use crate::points::SYSTEM;
use geom::{Shown, Vec3};
use las::{Header, LazParallelism, PointData, Reader, ReaderOptions, Transform};
use std::borrow::Cow;
use std::io::Cursor;
use std::sync::Arc;
use std::sync::atomic::Ordering;
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

pub(crate) fn matches(bytes: &[u8]) -> bool {
    bytes.starts_with(b"LASF")
}

pub(crate) fn read(bytes: Vec<u8>) -> Result<Cloud, ReadError> {
    // Asked of this thread: another one may be in another pool.
    let threads = if (bytes.len() as u64) < SMALL { 1 } else { rayon::current_num_threads().max(1) };
    foreign::guarded("LAS/LAZ", move || decode(bytes, threads))
}

fn broken(what: impl ToString, point: u64) -> ReadError {
    ReadError::Broken { format: "LAS/LAZ", what: what.to_string(), point: Some(point) }
}

fn decode(bytes: Vec<u8>, threads: usize) -> Result<Cloud, ReadError> {
    packed::before_the_header(&bytes).map_err(|e| broken(e, 0))?;
    let header = Header::new(Cursor::new(&bytes)).map_err(|e| broken(e, 0))?;
    sound(&header).and_then(|()| projected(&header)).map_err(|e| broken(e, 0))?;
    let chunks = packed::before_the_points(&bytes, &header).map_err(|e| broken(e, 0))?;
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
    if !format.is_compressed {
        let there = packed::records(&bytes, size);
        if there > promised {
            return Err(broken(
                format!(
                    "the header promises {promised} points, and there are {there}: correct the header (LAStools: lasinfo -i FILE \
                     -repair_counters) or export it again"
                ),
                promised,
            ));
        }
    }
    let (extra, unknown) = extra::columns(&header);
    let file = File { bytes: Bytes(Arc::new(bytes)), promised, size, extra };
    let all = match file.read(&shares(&chunks, promised, threads as u64))? {
        Some(all) => all,
        // Read one after the other there is no question where chunks begin.
        None => file.read(&[Chunk::default()])?.unwrap_or_default(),
    };
    let mut attributes = Table::with_rows(all.points.len());
    for (name, values) in all.columns {
        // A name that the format has already, as "intensity", stays that of the format.
        let name = if attributes.get(&name).is_some() { format!("extra_{name}").into() } else { name };
        attributes.push(&name, values).map_err(|source| ReadError::Table { format: "LAS/LAZ", source })?;
    }
    let system = reference_system(&header);
    let comments: Vec<String> = system.into_iter().map(|name| format!("{SYSTEM} {name}")).collect();
    let mut cloud = Cloud { points: all.points, attributes, double: true, comments, ..Cloud::default() };
    if unknown > 0 {
        cloud.leave_out(format!("{unknown} extra bytes of each point were left out: nothing describes them"));
    }
    if format.has_waveform {
        cloud.leave_out("the packets of waves were left out".to_owned());
    }
    cloud.warnings.extend(units::warning(&header));
    Ok(cloud)
}

/// Steps of coordinates that may be meant [m].
const SCALES: std::ops::Range<f64> = 1e-15..1e15;

/// Refuses scales that would bring all points to one coordinate, and numbers that are none.
fn sound(header: &Header) -> Result<(), String> {
    let (transforms, bounds) = (header.transforms(), header.bounds());
    let axes = [
        ("x", transforms.x, bounds.min.x, bounds.max.x),
        ("y", transforms.y, bounds.min.y, bounds.max.y),
        ("z", transforms.z, bounds.min.z, bounds.max.z),
    ];
    for (axis, Transform { scale, offset }, low, high) in axes {
        if !(SCALES.contains(&scale) && offset.abs() <= geom::LARGEST) {
            let (scale, offset) = (Shown(scale), Shown(offset));
            return Err(format!("the header gives {axis} a scale of {scale} and an offset of {offset} m"));
        }
        if header.number_of_points() > 0 && !(low.is_finite() && high.is_finite()) {
            return Err(format!("the bounding box in the header goes from {axis} = {low} m to {high} m"));
        }
    }
    Ok(())
}

/// Where the shares of so many threads begin: at chunks.
fn shares(chunks: &[Chunk], promised: u64, threads: u64) -> Vec<Chunk> {
    let near = |share: u64| chunks.partition_point(|c| c.first < promised / threads * share);
    let mut starts: Vec<Chunk> = (0..threads).filter_map(|t| chunks.get(near(t)).copied()).collect();
    starts.dedup();
    starts
}

/// A file that is read.
struct File {
    bytes: Bytes,
    /// Points of the whole file.
    promised: u64,
    /// Of a point [B].
    size: u64,
    extra: Vec<ExtraColumn>,
}

impl File {
    /// Reads every share in a separate thread. None if a share did not end at the byte at which the next one began, which the table of
    /// chunks has wrong then: what was read from there, and what became of it, says nothing.
    fn read(&self, starts: &[Chunk]) -> Result<Option<Rows>, ReadError> {
        let at_once = CHUNK.min(ROOM / self.size / starts.len().max(1) as u64).max(1);
        let ends = starts.iter().skip(1).map(|c| c.first).chain([self.promised]);
        let parts: Vec<PointRange> = starts
            .iter()
            .zip(ends)
            .map(|(start, to)| PointRange { file: self, from: start.first, to, at_once })
            .collect();
        let read: Vec<_> = std::thread::scope(|scope| {
            let spawn = |part| foreign::spawn(scope, STACK, move || PointRange::read(part));
            let running: Vec<_> = parts.iter().map(spawn).collect();
            running.into_iter().map(|thread| thread.map(ScopedJoinHandle::join)).collect()
        });
        let mut all = Rows::default();
        for (k, part) in read.into_iter().enumerate() {
            let part = part.map_err(ReadError::Io)?;
            let (rows, end) = part.unwrap_or_else(|panic| std::panic::resume_unwind(panic))?;
            all.append(rows);
            if starts.get(k + 1).is_some_and(|next| next.at != end) {
                return Ok(None);
            }
        }
        Ok(Some(all))
    }
}

/// Points that one thread reads.
struct PointRange<'a> {
    file: &'a File,
    from: u64,
    to: u64,
    at_once: u64,
}

/// A name and its numbers.
type NamedColumn = (Cow<'static, str>, Values);

/// Points and their attributes.
#[derive(Default)]
struct Rows {
    points: Vec<Vec3>,
    columns: Vec<NamedColumn>,
}

impl Rows {
    fn append(&mut self, rows: Rows) {
        self.points.extend(rows.points);
        append(&mut self.columns, rows.columns);
    }
}

impl PointRange<'_> {
    /// Its points, and the byte behind them.
    fn read(&self) -> Result<(Rows, u64), ReadError> {
        let options = ReaderOptions::default().with_laz_parallelism(LazParallelism::No);
        let source = Shallow::new(self.file.bytes.clone());
        let place = source.place();
        let mut reader = Reader::with_options(source, options).map_err(|e| broken(e, 0))?;
        if self.from > 0 {
            reader.seek(self.from).map_err(|e| broken(e, self.from))?;
        }
        let mut rows = Rows::default();
        loop {
            let at = self.from + rows.points.len() as u64;
            if at >= self.to {
                return Ok((rows, place.load(Ordering::Relaxed)));
            }
            let chunk = reader.read_points(self.at_once.min(self.to - at)).map_err(|e| broken(e, at))?;
            if chunk.is_empty() {
                let promised = self.file.promised;
                let what =
                    format!("the header promises {promised} points, the file ends before: it is cut off");
                return Err(broken(what, at));
            }
            let points =
                chunk.x().zip(chunk.y()).zip(chunk.z()).map(|((x, y), z)| Vec3::new(x, y, z)).collect();
            rows.append(Rows { points, columns: columns_of(&chunk, &self.file.extra) });
        }
    }
}

/// The attributes that this point format has.
fn columns_of(chunk: &PointData, extra: &[ExtraColumn]) -> Vec<NamedColumn> {
    let mut columns = vec![
        ("intensity", wide(chunk.intensity())),
        ("return_number", Values::U8(chunk.return_number().collect())),
        ("number_of_returns", Values::U8(chunk.number_of_returns().collect())),
        ("classification", Values::U8(chunk.classification().collect())),
        ("scan_flags", Values::U8(scan_flags(chunk).collect())),
        ("scan_angle", Values::F32(chunk.scan_angle_degrees().collect())),
        ("user_data", Values::U8(chunk.user_data().collect())),
        ("point_source_id", wide(chunk.point_source_id())),
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
        columns.push(("nir", wide(nir)));
    }
    let extra =
        extra.iter().map(|c| (c.name.clone().into(), c.values(chunk.raw_bytes(), chunk.record_len())));
    columns.into_iter().map(|(name, values)| (name.into(), values)).chain(extra).collect()
}

/// The flags of each point, as the formats 6 and above have them in a byte: 1 synthetic, 2 key point, 4 withheld, 8 overlap, 16 and 32 the channel of
/// the scanner, 64 the direction of the mirror, 128 the edge of a line (LAS 1.4 R15, tables 8 and 16).
fn scan_flags(chunk: &PointData) -> impl Iterator<Item = u8> + '_ {
    let (is_extended, length) = (chunk.format().is_extended, chunk.record_len().max(1));
    let flags = move |record: &[u8]| match record.get(14..16) {
        Some(&[_, flags]) if is_extended => flags,
        Some(&[returns, class]) => returns & 0b1100_0000 | class >> 5,
        _ => 0,
    };
    chunk.raw_bytes().chunks_exact(length).map(flags)
}

/// Numbers of 16 bits as 32: some readers of PLY skip `ushort`.
fn wide(numbers: impl Iterator<Item = u16>) -> Values {
    Values::U32(numbers.map(u32::from).collect())
}

/// Adds the rows of one chunk; every chunk of a file has the same columns.
fn append(all: &mut Vec<NamedColumn>, chunk: Vec<NamedColumn>) {
    if all.is_empty() {
        *all = chunk;
        return;
    }
    for ((_, column), (_, rows)) in all.iter_mut().zip(chunk) {
        match (column, rows) {
            (Values::U8(a), Values::U8(b)) => a.extend(b),
            (Values::I8(a), Values::I8(b)) => a.extend(b),
            (Values::I16(a), Values::I16(b)) => a.extend(b),
            (Values::I32(a), Values::I32(b)) => a.extend(b),
            (Values::U16(a), Values::U16(b)) => a.extend(b),
            (Values::U32(a), Values::U32(b)) => a.extend(b),
            (Values::F32(a), Values::F32(b)) => a.extend(b),
            (Values::F64(a), Values::F64(b)) => a.extend(b),
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::packed::tests::packed;
    use super::*;

    /// Points of three chunks, by as many threads.
    fn in_three(bytes: Vec<u8>) -> (File, Vec<Chunk>) {
        let header = Header::new(Cursor::new(&bytes)).unwrap();
        let chunks = packed::before_the_points(&bytes, &header).unwrap();
        let (promised, size) = (header.number_of_points(), u64::from(header.point_format().len()));
        let starts = shares(&chunks, promised, 3);
        (File { bytes: Bytes(Arc::new(bytes)), promised, size, extra: Vec::new() }, starts)
    }

    #[test]
    fn chunks_that_begin_elsewhere_than_the_table_says_are_read_one_after_the_other() {
        let bytes = packed(120_000);
        let (file, starts) = in_three(bytes.clone());
        assert_eq!(starts.iter().map(|c| c.first).collect::<Vec<_>>(), [0, 50_000, 100_000]);
        let whole = file.read(&starts).unwrap().expect("a sound table is believed").points;
        // The lengths of the first and the last chunk, exchanged: all end where the table begins all the same.
        let swapped = packed::tests::with_lengths(&bytes, [2, 1, 0]);
        assert_ne!(swapped, bytes);
        let (file, starts) = in_three(swapped.clone());
        assert_eq!(starts.len(), 3, "nothing is seen before points are read");
        assert!(file.read(&starts).unwrap().is_none(), "data from wrong offsets is refused");
        let mut large = swapped;
        large.resize(large.len().max(SMALL as usize), 0);
        assert!(decode(large, 3).unwrap().points == whole);
    }
}
