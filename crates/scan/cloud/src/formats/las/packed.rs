//! Checks the claims of a LAS or LAZ file against its length before its reader allocates memory, and gives the reader a large stack.
//!
//! ```text
//! header   byte 25: minor version;  96: where points begin;  104: format of points, a high bit where they are packed
//!          235: where the first extended record begins;  243: how many there are        (from version 1.4 on)
//! record   byte 20: length of what follows its head of 60 bytes
//! points   8 bytes: where the table of chunks is; what is not behind them stands in the last 8 bytes of the file; chunks
//! table    4 bytes version, 4 bytes number of chunks, then the length of each (and of how many points), packed
//! chunk    of formats 6 to 10: a point as it is, 4 bytes number of points, 4 bytes length of each layer, the layers
//! ```
//!
//! The reader calls itself again whenever the time of a point belongs to another of four sequences, as often as the file says so
//! ("look again" takes 2·10⁻⁴ bits once nothing else occurs), until the stack is full and the program ends. Valid files say so once
//! in a row. Where points are packed one by one, [`Shallow`] ends it. Layers are read elsewhere: there a layer of times
//! with a run of bytes 255 is refused, which would repeat it without end, and which no valid packed layer contains.
//!
//! ASPRS LAS 1.4 R15 (2019); Isenburg (2013), LASzip, Photogramm. Eng. Remote Sens. 79(2), doi:10.14358/PERS.79.2.209.

use las::Header;
use laz::LazItemType;
use laz::laszip::{ChunkTable, ChunkTableEntry, LazVlr};
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Head of an extended record [B].
const RECORD: usize = 60;
/// Room for the stack of a thread that unpacks [B]; what is not used takes none.
pub(crate) const STACK: usize = 1 << 28;
/// A stack deeper than this is not that of a whole file [B].
const DEEP: usize = 1 << 24;
/// Bytes 255 in a row that no layer of times has.
const RUN: usize = 16;
/// Which layer of a point holds its time, counted from 0.
const TIMES: usize = 8;

/// The bytes of a file, shared by the threads that read it.
#[derive(Clone)]
pub(crate) struct Bytes(pub Arc<Vec<u8>>);

impl AsRef<[u8]> for Bytes {
    fn as_ref(&self) -> &[u8] {
        &self.0
    }
}

/// A source that is not read on from a stack that has become [`DEEP`], and that tells how far it has been read.
pub(crate) struct Shallow {
    from: Cursor<Bytes>,
    base: usize,
    place: Arc<AtomicU64>,
}

impl Shallow {
    /// To be made in the thread that reads.
    pub(crate) fn new(bytes: Bytes) -> Shallow {
        Shallow { from: Cursor::new(bytes), base: here(), place: Arc::default() }
    }

    /// Where it is read next, in bytes of the file, also while a reader owns it.
    pub(crate) fn place(&self) -> Arc<AtomicU64> {
        self.place.clone()
    }

    fn at(&self) {
        self.place.store(self.from.position(), Ordering::Relaxed);
    }
}

/// Where the stack is now.
#[inline(never)]
fn here() -> usize {
    let mark = 0u8;
    std::hint::black_box(&raw const mark) as usize
}

impl Read for Shallow {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        if here().abs_diff(self.base) > DEEP {
            return Err(io::Error::other("the time of a point does not belong to any sequence"));
        }
        let read = self.from.read(into);
        self.at();
        read
    }
}

impl Seek for Shallow {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let place = self.from.seek(to);
        self.at();
        place
    }
}

/// A number of `size` bytes, least first.
fn number(bytes: &[u8], at: usize, size: usize) -> Option<u64> {
    let bytes = bytes.get(at..at.checked_add(size)?)?;
    Some(bytes.iter().rev().fold(0, |n, &byte| (n << 8) | u64::from(byte)))
}

/// Where the table of chunks is.
fn table_at(bytes: &[u8]) -> Option<u64> {
    let points = number(bytes, 96, 4)?;
    let behind = |at: &u64| *at as i64 > points as i64;
    let table = number(bytes, points as usize, 8).filter(behind);
    table.or_else(|| number(bytes, bytes.len().checked_sub(8)?, 8).filter(behind))
}

/// Refuses an extended record that is longer than the file, and a table of more chunks than the file has bytes.
///
/// # Errors
/// What is claimed.
pub(crate) fn before_the_header(bytes: &[u8]) -> Result<(), String> {
    let length = bytes.len();
    let record = || {
        let minor = number(bytes, 25, 1)?;
        let (start, count) = (number(bytes, 235, 8)? as usize, number(bytes, 243, 4)?);
        let claimed = number(bytes, start.checked_add(20)?, 8).filter(|_| minor >= 4 && count > 0)?;
        Some((claimed, length.saturating_sub(start.saturating_add(RECORD)) as u64))
    };
    if let Some((claimed, there)) = record()
        && claimed > there
    {
        return Err(format!("an extended record of {claimed} bytes is promised where {there} are left"));
    }
    let chunks = || {
        let packed = number(bytes, 104, 1)? & 0xc0 != 0;
        number(bytes, (table_at(bytes)? as usize).checked_add(4)?, 4).filter(|_| packed)
    };
    match chunks() {
        Some(chunks) if chunks > length as u64 => {
            Err(format!("{chunks} chunks of points are promised in {length} bytes"))
        }
        _ => Ok(()),
    }
}

/// Whole records of `size` [B] that fill a file of points that are not packed from its first one up to what follows them; 0 if they do not fill it.
pub(crate) fn records(bytes: &[u8], size: u64) -> u64 {
    let start = number(bytes, 96, 4).unwrap_or(u64::MAX);
    // Packets of waves from version 1.3 on, extended records from 1.4 on.
    let minor = number(bytes, 25, 1).unwrap_or(0);
    let behind = [(227, 3), (235, 4)].map(|(at, from)| number(bytes, at, 8).filter(|_| minor >= from));
    let end = behind.into_iter().flatten().filter(|&at| at >= start).fold(bytes.len() as u64, u64::min);
    let length = end.saturating_sub(start);
    if length.is_multiple_of(size.max(1)) { length / size.max(1) } else { 0 }
}

/// Where a chunk begins, by the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Chunk {
    /// Its first point.
    pub(crate) first: u64,
    /// Its first byte in the file.
    pub(crate) at: u64,
}

/// Refuses packed points whose items do not make a point, and layers that are longer than the file. Gives the chunks, where they may be
/// where the table has them; else only the first: then points can only be read one after the other. Chunks of points packed one by one
/// do not tell their lengths: whether one ends where the next begins is seen when it has been read.
///
/// # Errors
/// What is claimed.
pub(crate) fn before_the_points(bytes: &[u8], header: &Header) -> Result<Vec<Chunk>, String> {
    let format = header.point_format();
    if !format.is_compressed {
        return Ok(vec![Chunk::default()]);
    }
    let vlr = header.laz_vlr().map_err(|e| e.to_string())?;
    let size: u64 = vlr.items().iter().map(|item| u64::from(item.size())).sum();
    if size != u64::from(format.len()) {
        return Err(format!(
            "packed points of {size} bytes are promised as points of {} bytes",
            format.len()
        ));
    }
    let start = number(bytes, 96, 4).unwrap_or(u64::MAX);
    let mut source = Cursor::new(bytes);
    source.set_position(start);
    let table = ChunkTable::read_from(&mut source, &vlr).ok();
    let table = table.as_ref().map_or(&[][..], |t| t.as_ref());
    // The last chunk has a point at least.
    let before_last = table.iter().rev().skip(1).fold(0u64, |sum, c| sum.saturating_add(c.point_count));
    if table.len() > 1 && before_last >= header.number_of_points() {
        let (promised, chunks) = (header.number_of_points(), table.len());
        return Err(format!(
            "the header promises {promised} points, and the {chunks} chunks of the file hold more than {before_last}: correct the header \
             (LAStools: lasinfo -i FILE -repair_counters) or export it again"
        ));
    }
    let total = table.iter().fold(0u64, |sum, c| sum.saturating_add(c.byte_count));
    // Chunks of points packed one by one do not tell their length: those of the table must end where it begins.
    let mut whole = start.checked_add(8).and_then(|first| first.checked_add(total)) == table_at(bytes);
    if vlr.items().first().is_some_and(|item| item.version() > 2) {
        whole = layers_follow(bytes, start, header.number_of_points(), &vlr, table)?;
    }
    let (mut next, mut chunks) = (Chunk { first: 0, at: start.saturating_add(8) }, Vec::new());
    for chunk in table {
        if next.first >= header.number_of_points() {
            break;
        }
        // The reader looks for a point as if all chunks before had as many as its own.
        whole &= next.first.checked_rem(chunk.point_count) == Some(0);
        chunks.push(next);
        next = Chunk {
            first: next.first.saturating_add(chunk.point_count),
            at: next.at.saturating_add(chunk.byte_count),
        };
    }
    Ok(if whole && !chunks.is_empty() { chunks } else { vec![Chunk::default()] })
}

/// Whether chunks of layers have the lengths that the table gives them. Chunks follow each other, whatever the table says.
fn layers_follow(
    bytes: &[u8],
    start: u64,
    points: u64,
    vlr: &LazVlr,
    table: &[ChunkTableEntry],
) -> Result<bool, String> {
    let head = Head {
        size: vlr.items().iter().map(|item| usize::from(item.size())).sum(),
        items: vlr.items().iter().map(|item| item.item_type()).collect(),
    };
    let fixed = (!vlr.uses_variable_size_chunks()).then(|| u64::from(vlr.chunk_size()));
    let (mut at, mut left, mut k, mut whole) = (start as usize + 8, points, 0, true);
    while left > 0
        && let Some(length) = head.length(bytes, at, k)?
    {
        let entry = table.get(k);
        whole &= entry.is_some_and(|c| c.byte_count == length as u64);
        // One that counts no point never ends.
        let counted = fixed.or(entry.map(|c| c.point_count)).filter(|&n| n > 0);
        left = left.saturating_sub(counted.unwrap_or(u64::MAX));
        (at, k) = (at + length, k + 1);
    }
    Ok(whole)
}

/// What stands at the head of a chunk of layers.
struct Head {
    /// Of a point [B].
    size: usize,
    items: Vec<LazItemType>,
}

impl Head {
    /// Length [B] of chunk `k` at a place, its layers included; none where the file ends before them.
    fn length(&self, bytes: &[u8], at: usize, k: usize) -> Result<Option<usize>, String> {
        let layers: usize = self.items.iter().map(|&item| layers_of(item)).sum();
        let head = self.size + 4 + 4 * layers;
        let Some(lengths) = bytes.get(at + self.size + 4..at + head) else { return Ok(None) };
        let lengths: Vec<u64> = (0..layers).filter_map(|layer| number(lengths, 4 * layer, 4)).collect();
        let (claimed, there) = (lengths.iter().sum::<u64>(), (bytes.len() - at - head) as u64);
        if claimed > there {
            return Err(format!(
                "layers of {claimed} bytes are promised in chunk {k}, where {there} are left"
            ));
        }
        // All lengths are within the file now.
        if let Some(item) = self.items.iter().position(|i| *i == LazItemType::Point14) {
            let before = self.items[..item].iter().map(|&i| layers_of(i)).sum::<usize>() + TIMES;
            let from = at + head + lengths.iter().take(before).sum::<u64>() as usize;
            let times =
                bytes.get(from..from + lengths.get(before).map_or(0, |&l| l as usize)).unwrap_or_default();
            if times.windows(RUN).any(|run| run.iter().all(|&byte| byte == 255)) {
                return Err(format!("the times of chunk {k} are overwritten"));
            }
        }
        Ok(Some(head + claimed as usize))
    }
}

fn layers_of(item: LazItemType) -> usize {
    match item {
        LazItemType::Point14 => 9,
        LazItemType::RGBNIR14 => 2,
        LazItemType::Byte14(count) => usize::from(count),
        _ => 1,
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// The file with the lengths of its chunks in another order in its table.
    pub(crate) fn with_lengths(bytes: &[u8], order: [usize; 3]) -> Vec<u8> {
        let vlr = Header::new(Cursor::new(bytes)).unwrap().laz_vlr().unwrap();
        let mut source = Cursor::new(bytes);
        source.set_position(number(bytes, 96, 4).unwrap());
        let table = ChunkTable::read_from(&mut source, &vlr).unwrap();
        let mut new = ChunkTable::with_capacity(order.len());
        order.iter().for_each(|&k| new.push(table[k]));
        let mut out = bytes[..table_at(bytes).unwrap() as usize].to_vec();
        new.write_to(&mut out, &vlr).unwrap();
        out
    }

    /// Points of format 1, packed in chunks of 50 000.
    pub(crate) fn packed(points: u32) -> Vec<u8> {
        let mut builder = las::Builder::from((1, 2));
        builder.point_format = las::point::Format::new(1).unwrap();
        builder.point_format.is_compressed = true;
        let header = builder.into_header().unwrap();
        let mut writer = las::Writer::new(Cursor::new(Vec::new()), header).unwrap();
        for k in 0..points {
            let x = f64::from(k.wrapping_mul(2_654_435_769) >> 16);
            let point = las::Point { x, gps_time: Some(f64::from(k)), ..las::Point::default() };
            writer.write_point(point).unwrap();
        }
        writer.into_inner().unwrap().into_inner()
    }

    fn chunks(bytes: &[u8]) -> Vec<Chunk> {
        before_the_points(bytes, &Header::new(Cursor::new(bytes)).unwrap()).unwrap()
    }

    fn firsts(bytes: &[u8]) -> Vec<u64> {
        chunks(bytes).iter().map(|c| c.first).collect()
    }

    #[test]
    fn more_chunks_than_the_header_has_points_for_are_refused() {
        let mut bytes = packed(120_000);
        let promise =
            |bytes: &mut Vec<u8>, points: u32| bytes[107..111].copy_from_slice(&points.to_le_bytes());
        promise(&mut bytes, 100_001);
        assert_eq!(firsts(&bytes).len(), 3);
        for points in [0, 50_000, 100_000] {
            promise(&mut bytes, points);
            let told = before_the_points(&bytes, &Header::new(Cursor::new(&bytes)).unwrap()).unwrap_err();
            assert!(told.contains(&format!("promises {points} points")), "{told}");
            assert!(told.contains("more than 100000"), "{told}");
        }
    }

    #[test]
    fn chunks_that_do_not_end_at_their_table_are_read_one_after_the_other() {
        let mut bytes = packed(120_000);
        assert_eq!(firsts(&bytes), [0, 50_000, 100_000]);
        let table = table_at(&bytes).unwrap();
        bytes.splice(table as usize..table as usize, [0; 16]);
        let start = number(&bytes, 96, 4).unwrap() as usize;
        bytes[start..start + 8].copy_from_slice(&(table + 16).to_le_bytes());
        assert_eq!(firsts(&bytes), [0]);
    }
}
