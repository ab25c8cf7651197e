//! Where the messages of a file are, from record to record, without reading them.

use super::chunk::{self, ChunkError};
use super::{END_OF_STREAM, lengths};
use ::mcap::{
    MAGIC, parse_record,
    records::{Record, op},
};
use std::collections::{HashMap, HashSet};
use std::io::{self, BufReader, Read, Seek, SeekFrom};

/// Opcode and length of a record [B].
pub(super) const HEAD: usize = 9;
/// Channel, number and time of a message [B].
const MESSAGE: usize = 14;
/// Time and place of a message in the index of a chunk [B].
const INDEXED: usize = 16;

/// Where a message is: in the order of the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Place {
    /// Of the message or of its chunk, in the file [B].
    pub record: u64,
    /// In the unpacked chunk [B]; none of a message that stands by itself.
    pub within: Option<u64>,
}

/// A message.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    pub time_ns: u64,
    pub place: Place,
    channel: u16,
}

/// What a file holds.
#[derive(Debug, Default)]
pub(super) struct Walk {
    /// Whether messages of a channel go back in time, or follow what ends the stream.
    pub is_mixed: bool,
    /// Place of the header [B].
    pub header: u64,
    /// Records of schemas and channels.
    pub declared: Vec<u8>,
    /// Places of metadata, and whether they end a stream.
    pub metadata: Vec<(Place, bool)>,
    /// All messages, if they are wanted.
    pub entries: Vec<Entry>,
    by_index: bool,
    known: HashSet<(u8, u16)>,
    last_ns: HashMap<u16, u64>,
    /// Messages of the open chunk, and its place.
    open: Vec<Entry>,
    chunk: Option<u64>,
    is_indexed: bool,
}

/// Length of a record [B], by its first bytes.
pub(super) fn length(head: &[u8]) -> u64 {
    let eight = head.get(1..HEAD).and_then(|bytes| bytes.try_into().ok());
    eight.map_or(0, u64::from_le_bytes)
}

/// The records of a chunk.
pub(super) fn unpack(body: &[u8]) -> Result<Vec<u8>, ChunkError> {
    lengths::check(op::CHUNK, body)?;
    match parse_record(op::CHUNK, body) {
        Ok(Record::Chunk { header, data }) => Ok(chunk::unpack(&header, &data)?.into_owned()),
        _ => Err(ChunkError::Records),
    }
}

/// Walks through a whole file; `None` if it is not one, or has no end.
pub(super) fn walk(from: &mut (impl Read + Seek), keep: bool) -> io::Result<Option<Walk>> {
    let found = pass(from, keep, true)?;
    let is_known = |walk: &Walk| walk.last_ns.keys().all(|id| walk.known.contains(&(op::CHANNEL, *id)));
    let ends = |walk: &Walk| walk.metadata.iter().any(|(_, ends)| *ends);
    if found.as_ref().is_none_or(|walk| is_known(walk) && ends(walk)) {
        return Ok(found);
    }
    // Without a summary, channels are declared in the chunks alone; some programs put metadata there, too.
    from.seek(SeekFrom::Start(0))?;
    Ok(pass(from, keep, false)?.filter(is_known))
}

/// Walks through a file; `by_index`: chunks with an index are not unpacked.
fn pass(from: &mut (impl Read + Seek), keep: bool, by_index: bool) -> io::Result<Option<Walk>> {
    let mut first = [0; MAGIC.len()];
    if from.read_exact(&mut first).is_err() || first != MAGIC {
        return Ok(None);
    }
    let end = from.seek(SeekFrom::End(-(MAGIC.len() as i64)))?;
    from.read_exact(&mut first)?;
    if first != MAGIC {
        return Ok(None);
    }
    let mut at = from.seek(SeekFrom::Start(MAGIC.len() as u64))?;
    let mut from = BufReader::new(from);
    let mut walk = Walk { by_index, ..Walk::default() };
    while at < end {
        let mut head = [0; HEAD];
        from.read_exact(&mut head)?;
        let (opcode, long) = (head[0], length(&head));
        let next = long.checked_add(at + HEAD as u64).filter(|next| *next <= end);
        let Some(next) = next else { return Ok(None) };
        if !matches!(opcode, op::MESSAGE_INDEX) && !walk.close(&mut from, at + HEAD as u64, keep)? {
            return Ok(None);
        }
        let wanted = match opcode {
            op::MESSAGE => long.min(MESSAGE as u64),
            op::SCHEMA | op::CHANNEL | op::MESSAGE_INDEX => long,
            op::METADATA => long.min(4 + END_OF_STREAM.len() as u64),
            _ => 0,
        };
        let mut body = Vec::new();
        from.by_ref().take(wanted).read_to_end(&mut body)?;
        if !walk.record(opcode, at, &head, &body) {
            return Ok(None);
        }
        let left = i64::try_from(long - wanted).map_err(io::Error::other)?;
        from.seek_relative(left)?;
        at = next;
    }
    let all = walk.close(&mut from, at, keep)?;
    Ok(all.then_some(walk))
}

impl Walk {
    /// Takes notice of a record; false if it does not have the form of its kind.
    fn record(&mut self, opcode: u8, at: u64, head: &[u8], body: &[u8]) -> bool {
        let short = |at: usize| body.get(at..at + 2).and_then(|b| b.try_into().ok()).map(u16::from_le_bytes);
        let long = |at: usize| body.get(at..at + 8).and_then(|b| b.try_into().ok()).map(u64::from_le_bytes);
        match opcode {
            op::HEADER => self.header = at,
            op::SCHEMA | op::CHANNEL => {
                let Some(id) = short(0) else { return false };
                // They are declared again behind the data.
                if self.known.insert((opcode, id)) {
                    self.declared.extend([head, body].concat());
                }
            }
            op::METADATA => {
                let name =
                    [&(END_OF_STREAM.len() as u32).to_le_bytes()[..], END_OF_STREAM.as_bytes()].concat();
                self.metadata.push((Place { record: at, within: None }, body.starts_with(&name)));
            }
            op::MESSAGE => {
                let (Some(channel), Some(time_ns)) = (short(0), long(6)) else { return false };
                self.open.push(Entry { time_ns, channel, place: Place { record: at, within: None } });
            }
            op::CHUNK => (self.chunk, self.is_indexed) = (Some(at), false),
            op::MESSAGE_INDEX if !self.by_index => {}
            op::MESSAGE_INDEX => {
                let (Some(channel), Some(record)) = (short(0), self.chunk) else { return false };
                self.is_indexed = true;
                for pair in body.get(6..).unwrap_or_default().chunks_exact(INDEXED) {
                    let [time_ns, within] =
                        [0, 8].map(|at| pair[at..at + 8].try_into().map_or(0, u64::from_le_bytes));
                    self.open.push(Entry { time_ns, channel, place: Place { record, within: Some(within) } });
                }
            }
            _ => {}
        }
        true
    }

    /// Ends a chunk, or a message outside of chunks; the file is at `at` again afterwards. False for a chunk that cannot be unpacked.
    fn close<R: Read + Seek>(&mut self, from: &mut BufReader<R>, at: u64, keep: bool) -> io::Result<bool> {
        if let Some(record) = self.chunk.take().filter(|_| !self.is_indexed) {
            from.seek(SeekFrom::Start(record))?;
            let mut head = [0; HEAD];
            from.read_exact(&mut head)?;
            let mut body = Vec::new();
            from.by_ref().take(length(&head)).read_to_end(&mut body)?;
            from.seek(SeekFrom::Start(at))?;
            let Ok(records) = unpack(&body) else { return Ok(false) };
            if !self.within(record, &records) {
                return Ok(false);
            }
        }
        self.open.sort_by_key(|entry| entry.place);
        let ended = self.metadata.iter().filter(|(_, ends)| *ends).map(|(place, _)| *place).min();
        for entry in &self.open {
            let last = self.last_ns.entry(entry.channel).or_insert(0);
            self.is_mixed |= entry.time_ns < *last || ended.is_some_and(|end| end < entry.place);
            *last = entry.time_ns.max(*last);
        }
        if keep {
            self.entries.append(&mut self.open);
        }
        self.open.clear();
        Ok(true)
    }

    /// Takes notice of the records of an unpacked chunk.
    fn within(&mut self, chunk: u64, records: &[u8]) -> bool {
        let mut rest = records;
        while !rest.is_empty() {
            let at = (records.len() - rest.len()) as u64;
            let before = rest;
            let Ok((opcode, body)) = chunk::next_record(&mut rest) else { return false };
            match opcode {
                op::SCHEMA | op::CHANNEL | op::MESSAGE | op::METADATA => {
                    if !self.record(opcode, chunk, &before[..HEAD], body) {
                        return false;
                    }
                    let place = match opcode {
                        op::MESSAGE => self.open.last_mut().map(|entry| &mut entry.place),
                        op::METADATA => self.metadata.last_mut().map(|(place, _)| place),
                        _ => None,
                    };
                    place.into_iter().for_each(|place| place.within = Some(at));
                }
                _ => {}
            }
        }
        true
    }
}
