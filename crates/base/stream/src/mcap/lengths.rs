//! Lengths that a record claims for its texts, checked against the record itself before memory is allocated.

use super::chunk::ChunkError;
use ::mcap::records::op;

/// Refuses a record with a text that is longer than what is left of the record.
pub(super) fn check(opcode: u8, body: &[u8]) -> Result<(), ChunkError> {
    let mut rest = body;
    let whole = match opcode {
        op::SCHEMA => skip(&mut rest, 2).and(texts(&mut rest, 3)),
        op::CHANNEL => skip(&mut rest, 4).and(texts(&mut rest, 2)).and(map(&mut rest)),
        op::METADATA => texts(&mut rest, 1).and(map(&mut rest)),
        op::CHUNK => skip(&mut rest, 28).and(texts(&mut rest, 1)),
        _ => Some(()),
    };
    whole.ok_or(ChunkError::Text)
}

fn skip(rest: &mut &[u8], count: usize) -> Option<()> {
    *rest = rest.get(count..)?;
    Some(())
}

/// Texts, or bytes, behind their lengths.
fn texts(rest: &mut &[u8], count: usize) -> Option<()> {
    (0..count).try_for_each(|_| {
        let (length, behind) = rest.split_first_chunk::<4>()?;
        *rest = behind;
        skip(rest, u32::from_le_bytes(*length) as usize)
    })
}

/// Pairs of texts, behind the length of them all.
fn map(rest: &mut &[u8]) -> Option<()> {
    let start = *rest;
    texts(rest, 1)?;
    let mut pairs = start.get(4..start.len() - rest.len())?;
    while !pairs.is_empty() {
        texts(&mut pairs, 2)?;
    }
    Some(())
}
