//! Files whose messages are not in the order of time, put in order as they are read.
//!
//! ```text
//! look     from record to record, over their contents: the index behind each chunk gives time and place of its messages; a chunk without one is unpacked
//! read     header, declarations and metadata; messages by time, those of one time in the order of the file; the metadata that end a stream
//! ```
//!
//! A file whose channels are in order, with its end behind them, is read as it is, and so is one that has no end yet, or is not MCAP: [`super::Reader`] says what is wrong with it. A pipe
//! cannot be looked at.

use super::walk::{Place, Walk};
use super::{chunk, walk};
use ::mcap::{MAGIC, records::op};
use std::collections::HashMap;
use std::io::{self, Read, Seek, SeekFrom};

/// Unpacked chunks that are kept [B]; one more is always.
const KEPT: usize = 512 << 20;
/// Ends of a stream without an index: the record that ends the data, without a checksum, and the footer.
const END: [(u8, usize); 2] = [(op::DATA_END, 4), (op::FOOTER, 20)];

/// A file, or what gives its messages in the order of time where they are not.
///
/// # Errors
/// A file that can be looked at and not be read from its beginning again.
pub fn in_order<'a, S: Read + Seek + Send + 'a>(mut from: S) -> io::Result<Box<dyn Read + Send + 'a>> {
    if !matches!(from.stream_position(), Ok(0)) {
        return Ok(Box::new(from));
    }
    // What cannot be looked at is for the reader, which names the place.
    let mixed = |walk: &Option<Walk>| walk.as_ref().is_some_and(|walk| walk.is_mixed);
    let mut found = walk::walk(&mut from, false).unwrap_or(None);
    if mixed(&found) {
        from.seek(SeekFrom::Start(0))?;
        found = walk::walk(&mut from, true).unwrap_or(None);
    }
    from.seek(SeekFrom::Start(0))?;
    let Some(mut walk) = found.filter(|walk| walk.is_mixed) else { return Ok(Box::new(from)) };
    walk.entries.sort_by_key(|entry| (entry.time_ns, entry.place));
    let (last, first): (Vec<_>, Vec<_>) = walk.metadata.into_iter().partition(|(_, ends)| *ends);
    let place = |(place, _): (Place, bool)| Step::Copy(place);
    let mut steps = vec![
        Step::Bytes(MAGIC.to_vec()),
        Step::Copy(Place { record: walk.header, within: None }),
        Step::Bytes(walk.declared),
    ];
    steps.extend(first.into_iter().map(place));
    steps.extend(walk.entries.into_iter().map(|entry| Step::Copy(entry.place)));
    steps.extend(last.into_iter().map(place));
    steps.push(Step::Bytes(
        END.iter().flat_map(|&(op, length)| empty(op, length)).chain(MAGIC.iter().copied()).collect(),
    ));
    let steps = steps.into_iter();
    Ok(Box::new(InOrder { from, steps, chunks: HashMap::new(), kept: 0, out: Vec::new(), taken: 0 }))
}

/// A record of zeros.
fn empty(op: u8, length: usize) -> Vec<u8> {
    let head = (length as u64).to_le_bytes();
    [&[op][..], &head, &vec![0; length]].concat()
}

/// What comes next.
enum Step {
    Bytes(Vec<u8>),
    /// The record at a place of the file.
    Copy(Place),
}

struct InOrder<S> {
    from: S,
    steps: std::vec::IntoIter<Step>,
    /// Unpacked chunks by their place, and their memory [B].
    chunks: HashMap<u64, Vec<u8>>,
    kept: usize,
    /// Bytes of the last step, and how many of them were read.
    out: Vec<u8>,
    taken: usize,
}

fn damaged(what: &str) -> io::Error {
    io::Error::new(
        io::ErrorKind::InvalidData,
        format!("MCAP: {what}: the file is damaged, write or copy it again"),
    )
}

impl<S: Read + Seek> InOrder<S> {
    fn bytes(&mut self, step: Step) -> io::Result<Vec<u8>> {
        match step {
            Step::Bytes(bytes) => Ok(bytes),
            Step::Copy(Place { record, within: None }) => self.record(record),
            Step::Copy(Place { record, within: Some(at) }) => {
                if !self.chunks.contains_key(&record) {
                    let records = self.unpacked(record)?;
                    if self.kept + records.len() > KEPT {
                        self.chunks.clear();
                        self.kept = 0;
                    }
                    self.kept += records.len();
                    self.chunks.insert(record, records);
                }
                let records = self.chunks.get(&record).map(Vec::as_slice).unwrap_or_default();
                let whole = usize::try_from(at).ok().and_then(|at| records.get(at..));
                let whole = whole.ok_or_else(|| damaged("an index points behind its chunk"))?;
                let mut rest = whole;
                chunk::next_record(&mut rest).map_err(|e| damaged(e.text()))?;
                Ok(whole[..whole.len() - rest.len()].to_vec())
            }
        }
    }

    /// The record at a place of the file, which was there when it was looked at.
    fn record(&mut self, place: u64) -> io::Result<Vec<u8>> {
        self.from.seek(SeekFrom::Start(place))?;
        let mut bytes = vec![0; walk::HEAD];
        self.from.read_exact(&mut bytes)?;
        let length = walk::length(&bytes);
        let read = self.from.by_ref().take(length).read_to_end(&mut bytes)?;
        if read as u64 == length {
            Ok(bytes)
        } else {
            Err(damaged("a record reaches over the end of the file"))
        }
    }

    fn unpacked(&mut self, place: u64) -> io::Result<Vec<u8>> {
        walk::unpack(&self.record(place)?[walk::HEAD..]).map_err(|e| damaged(e.text()))
    }
}

impl<S: Read + Seek> Read for InOrder<S> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        while self.taken == self.out.len() {
            let Some(step) = self.steps.next() else { return Ok(0) };
            (self.out, self.taken) = (self.bytes(step)?, 0);
        }
        let count = to.len().min(self.out.len() - self.taken);
        to[..count].copy_from_slice(&self.out[self.taken..self.taken + count]);
        self.taken += count;
        Ok(count)
    }
}
