//! Chunks: unpacked and checked as a whole before any of their records is used.

use ::mcap::records::ChunkHeader;
use std::{
    borrow::Cow,
    io::{self, Read},
};

/// Why a chunk is not believed.
#[derive(Debug)]
pub(super) enum ChunkError {
    Crc,
    Length,
    Records,
    Compression,
    Unpack,
    Memory,
    Large,
    Text,
}

/// A chunk that unpacks to more than this [B] must also unpack to less than [`RATIO`] times its packed size: a few bytes can
/// claim to hold any number of zeros. No chunk of measured numbers of that size is packed as tightly: grains at rest, in double
/// precision, are packed to a third.
const FREE: u64 = 64 << 20;
/// See [`FREE`].
const RATIO: u64 = 64;

impl ChunkError {
    pub fn text(&self) -> &'static str {
        match self {
            ChunkError::Crc => "the CRC of a chunk does not match: bytes were changed",
            ChunkError::Length => "a chunk is not as long as its header says",
            ChunkError::Records => "a record reaches over the end of its chunk",
            ChunkError::Compression => "a chunk has an unknown compression (known: none, zstd, lz4)",
            ChunkError::Unpack => "a chunk cannot be unpacked: bytes were changed",
            ChunkError::Memory => "a chunk cannot be unpacked: out of memory",
            ChunkError::Large => "a chunk claims to unpack to more than 64 MiB and 64 times its own size",
            ChunkError::Text => "a text reaches over the end of its record",
        }
    }
}

/// The records of a chunk, unpacked. Memory follows the packed bytes, not the size that the header claims.
pub(super) fn unpack<'a>(header: &ChunkHeader, data: &'a [u8]) -> Result<Cow<'a, [u8]>, ChunkError> {
    if header.uncompressed_size > FREE && header.uncompressed_size / RATIO > data.len() as u64 {
        return Err(ChunkError::Large);
    }
    let records = match header.compression.as_str() {
        "" => Cow::Borrowed(data),
        "zstd" => Cow::Owned(read(zstd::stream::read::Decoder::new(data), header)?),
        "lz4" => Cow::Owned(read(lz4::Decoder::new(data), header)?),
        _ => return Err(ChunkError::Compression),
    };
    if records.len() as u64 != header.uncompressed_size {
        return Err(ChunkError::Length);
    }
    // A CRC of 0 means that the writer took none.
    if header.uncompressed_crc != 0 && crc32fast::hash(&records) != header.uncompressed_crc {
        return Err(ChunkError::Crc);
    }
    Ok(records)
}

fn read(decoder: io::Result<impl Read>, header: &ChunkHeader) -> Result<Vec<u8>, ChunkError> {
    let mut records = Vec::new();
    let decoder = decoder.map_err(|e| refused(&e))?;
    let limit = header.uncompressed_size.saturating_add(1);
    decoder.take(limit).read_to_end(&mut records).map_err(|e| refused(&e))?;
    Ok(records)
}

/// Why a decoder gives nothing. Those in C tell of too little memory by their words alone.
fn refused(error: &io::Error) -> ChunkError {
    let words = error.to_string().to_ascii_lowercase();
    let memory = error.kind() == io::ErrorKind::OutOfMemory
        || words.contains("alloc")
        || words.contains("not enough memory");
    if memory { ChunkError::Memory } else { ChunkError::Unpack }
}

/// Cuts the next record off: its opcode and its body.
pub(super) fn next_record<'a>(records: &mut &'a [u8]) -> Result<(u8, &'a [u8]), ChunkError> {
    let (head, rest) = records.split_first_chunk::<9>().ok_or(ChunkError::Records)?;
    let [opcode, length @ ..] = *head;
    let length = usize::try_from(u64::from_le_bytes(length)).map_err(|_| ChunkError::Records)?;
    let (body, rest) = rest.split_at_checked(length).ok_or(ChunkError::Records)?;
    *records = rest;
    Ok((opcode, body))
}
