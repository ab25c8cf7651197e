//! What a LAS or LAZ file claims to hold, held against its length before its reader makes room for it.
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
//! ASPRS LAS 1.4 R15 (2019); Isenburg (2013), LASzip, Photogramm. Eng. Remote Sens. 79(2), doi:10.14358/PERS.79.2.209.

use las::Header;
use laz::LazItemType;
use laz::laszip::ChunkTable;
use std::io::Cursor;

/// Head of an extended record [B].
const RECORD: usize = 60;
/// Unpacked points of a chunk at most [B] for threads, which hold whole ones.
const WHOLE: u64 = 1 << 28;

/// A number of `size` bytes, least first.
fn number(bytes: &[u8], at: usize, size: usize) -> Option<u64> {
    let bytes = bytes.get(at..at.checked_add(size)?)?;
    Some(bytes.iter().rev().fold(0, |n, &byte| (n << 8) | u64::from(byte)))
}

/// Refuses an extended record that is longer than the file, and a table of more chunks than the file has bytes.
///
/// # Errors
/// What is claimed.
pub(super) fn before_the_header(bytes: &[u8]) -> Result<(), String> {
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
        return Err(format!("an extended record of {claimed} bytes is promised where there are {there}"));
    }
    let chunks = || {
        let packed = number(bytes, 104, 1)? & 0xc0 != 0;
        let points = number(bytes, 96, 4)?;
        let behind = |at: &u64| *at as i64 > points as i64;
        let table = number(bytes, points as usize, 8).filter(behind);
        let table = table.or_else(|| number(bytes, length.checked_sub(8)?, 8).filter(behind))?;
        number(bytes, (table as usize).checked_add(4)?, 4).filter(|_| packed)
    };
    match chunks() {
        Some(chunks) if chunks > length as u64 => {
            Err(format!("{chunks} chunks of points are promised in {length} bytes"))
        }
        _ => Ok(()),
    }
}

/// Refuses packed points whose items do not make a point, and layers that are longer than the file. Says whether threads may read
/// the chunks: each is where the table has it, and is not large.
///
/// # Errors
/// What is claimed.
pub(super) fn before_the_points(bytes: &[u8], header: &Header) -> Result<bool, String> {
    let format = header.point_format();
    if !format.is_compressed {
        return Ok(true);
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
    let counts = table.as_ref().map_or(&[][..], |t| t.as_ref());
    let fixed = (!vlr.uses_variable_size_chunks()).then(|| u64::from(vlr.chunk_size()));
    let layered = vlr.items().first().is_some_and(|item| item.version() > 2);
    let mut whole = !counts.is_empty() && counts.iter().all(|c| c.point_count.saturating_mul(size) <= WHOLE);
    let total = counts.iter().fold(0u64, |sum, c| sum.saturating_add(c.byte_count));
    whole &= total <= bytes.len() as u64;
    if !layered {
        return Ok(whole);
    }
    let layers: usize = vlr.items().iter().map(|item| layers(item.item_type())).sum();
    // Chunks follow each other, whatever the table says.
    let (mut at, mut left) = (start as usize + 8, header.number_of_points());
    for k in 0.. {
        let sizes = at + size as usize + 4;
        let Some(lengths) = bytes.get(sizes..sizes + 4 * layers).filter(|_| left > 0) else { break };
        let claimed: u64 = (0..layers).filter_map(|layer| number(lengths, 4 * layer, 4)).sum();
        let there = (bytes.len() - sizes - 4 * layers) as u64;
        if claimed > there {
            return Err(format!(
                "layers of {claimed} bytes are promised in chunk {k}, where there are {there}"
            ));
        }
        let end = sizes + 4 * layers + claimed as usize;
        whole &= counts.get(k).is_some_and(|c| c.byte_count == (end - at) as u64);
        // A chunk that counts no point never ends.
        let points = fixed.or(counts.get(k).map(|c| c.point_count)).filter(|&n| n > 0);
        (at, left) = (end, left.saturating_sub(points.unwrap_or(u64::MAX)));
    }
    Ok(whole)
}

/// Layers of an item.
fn layers(item: LazItemType) -> usize {
    match item {
        LazItemType::Point14 => 9,
        LazItemType::RGBNIR14 => 2,
        LazItemType::Byte14(count) => usize::from(count),
        _ => 1,
    }
}
