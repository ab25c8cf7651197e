//! Reads a stream event by event, also while it is still being written, in memory for one chunk.

use super::{END_OF_STREAM, McapError, chunk, lengths, points};
use crate::Table;
use ::mcap::{
    McapError as Inner, parse_record,
    records::{Record, op},
    sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions},
};
use sha2::{Digest, Sha256};
use std::{
    collections::{BTreeMap, HashMap, VecDeque},
    io::{self, Read},
};

/// Bytes asked for at a time, the first and the most; a claimed length is never asked for at once.
const STEP: (usize, usize) = (1 << 13, 1 << 18);
/// No record is larger [B].
const LIMIT: usize = 1 << 32;

/// What a stream holds.
#[derive(Debug, Clone, PartialEq)]
pub enum Event {
    /// A metadata record.
    Metadata {
        /// `provenance`, `scene`, `materials`, …
        name: String,
        /// Its keys and values.
        map: BTreeMap<String, String>,
    },
    /// A point cloud message.
    Points {
        /// `/walls`, `/particles`, …
        topic: String,
        /// Simulated time [ns].
        time_ns: u64,
        /// Its columns.
        table: Table,
    },
    /// Any other message.
    Bytes {
        /// `/checkpoint`, `/log`, …
        topic: String,
        /// Simulated time [ns].
        time_ns: u64,
        /// The message as it is.
        data: Vec<u8>,
    },
}

struct Channel {
    topic: String,
    points: bool,
    /// Time of its last message [ns].
    last_ns: u64,
}

/// Reads an MCAP stream; an iterator that ends after the first error.
///
/// The last item is an error unless the stream was finished, is unchanged, and nothing follows it.
pub struct Reader<R: Read> {
    source: R,
    records: LinearReader,
    schemas: HashMap<u16, String>,
    channels: HashMap<u16, Channel>,
    events: VecDeque<Event>,
    digest: Option<Sha256>,
    messages: u64,
    byte: u64,
    ended: bool,
    done: bool,
}

impl<R: Read> Reader<R> {
    /// A reader of a file or a pipe.
    pub fn new(source: R) -> Reader<R> {
        let options = LinearReaderOptions::default()
            .with_emit_chunks(true)
            .with_validate_data_section_crc(true)
            .with_validate_summary_section_crc(true)
            .with_check_finishes_after_end_magic(true)
            .with_record_length_limit(LIMIT);
        Reader {
            source,
            records: LinearReader::new_with_options(options),
            schemas: HashMap::new(),
            channels: HashMap::new(),
            events: VecDeque::new(),
            digest: None,
            messages: 0,
            byte: 0,
            ended: false,
            done: false,
        }
    }

    /// A reader that also hashes what it reads, for [`Reader::digest`].
    pub fn hashed(source: R) -> Reader<R> {
        Reader { digest: Some(Sha256::new()), ..Reader::new(source) }
    }

    /// SHA-256 of the content so far: the same whether chunks were packed or not, in a file or a pipe.
    /// Empty unless the reader was made by [`Reader::hashed`].
    pub fn digest(&self) -> String {
        let hash = self.digest.clone().map(|d| d.finalize());
        hash.iter().flatten().map(|byte| format!("{byte:02x}")).collect()
    }

    /// Goes on until an event is there; `None` at a good end.
    fn advance(&mut self) -> Result<Option<Event>, McapError> {
        loop {
            if let Some(event) = self.events.pop_front() {
                return Ok(Some(event));
            }
            let event = match self.records.next_event() {
                None if self.ended => return Ok(None),
                None => return Err(self.truncated()),
                Some(event) => event,
            };
            match event {
                Ok(LinearReadEvent::ReadRequest(_)) => self.fill()?,
                Ok(LinearReadEvent::Record { opcode: op::CHUNK, data }) => {
                    let data = data.to_vec();
                    self.chunk(&data)?;
                }
                Ok(LinearReadEvent::Record { opcode, data }) if is_of_use(opcode) => {
                    let data = data.to_vec();
                    self.record(opcode, &data)?;
                }
                Ok(_) => {}
                Err(e) => return Err(self.explain(e)),
            }
        }
    }

    fn fill(&mut self) -> Result<(), McapError> {
        // As much as there was so far: a short stream is read in little memory, a long one in few steps.
        let step = usize::try_from(self.byte).unwrap_or(STEP.1).clamp(STEP.0, STEP.1);
        let read = loop {
            match self.source.read(self.records.insert(step)) {
                Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
                other => break other?,
            }
        };
        self.byte += read as u64;
        self.records.notify_read(read);
        Ok(())
    }

    fn chunk(&mut self, data: &[u8]) -> Result<(), McapError> {
        lengths::check(op::CHUNK, data).map_err(|w| self.malformed(w.text()))?;
        let Record::Chunk { header, data } = parse_record(op::CHUNK, data).map_err(|e| self.explain(e))?
        else {
            return Ok(());
        };
        let wrong = |w: chunk::ChunkError| match w {
            // Nothing is wrong with the file.
            chunk::ChunkError::Memory => McapError::Io(io::Error::new(io::ErrorKind::OutOfMemory, w.text())),
            w => self.malformed(w.text()),
        };
        let records = chunk::unpack(&header, &data).map_err(wrong)?;
        let mut rest = &records[..];
        while !rest.is_empty() {
            let (opcode, body) = chunk::next_record(&mut rest).map_err(|w| self.malformed(w.text()))?;
            if is_of_use(opcode) {
                self.record(opcode, body)?;
            }
        }
        Ok(())
    }

    fn record(&mut self, opcode: u8, body: &[u8]) -> Result<(), McapError> {
        lengths::check(opcode, body).map_err(|w| self.malformed(w.text()))?;
        match parse_record(opcode, body).map_err(|e| self.explain(e))? {
            Record::Schema { header, .. } => {
                self.schemas.insert(header.id, header.name);
            }
            Record::Channel(channel) => {
                let schema = self.schemas.get(&channel.schema_id);
                let points = channel.message_encoding == "protobuf"
                    && schema.is_some_and(|name| name == "foxglove.PointCloud");
                // Channels are declared again in the summary, and may be at any time.
                let last_ns = self.channels.get(&channel.id).map_or(0, |known| known.last_ns);
                self.channels.insert(channel.id, Channel { topic: channel.topic, points, last_ns });
            }
            Record::Metadata(record) if record.name == END_OF_STREAM => self.end(&record.metadata)?,
            Record::Metadata(record) => self.metadata(record.name, record.metadata),
            Record::Message { header, data } => {
                self.message(header.channel_id, header.log_time, data.into_owned())?
            }
            _ => {}
        }
        Ok(())
    }

    fn metadata(&mut self, name: String, map: BTreeMap<String, String>) {
        if let Some(digest) = &mut self.digest {
            digest.update(format!("{name} {map:?}"));
        }
        self.events.push_back(Event::Metadata { name, map });
    }

    fn message(&mut self, channel: u16, time_ns: u64, data: Vec<u8>) -> Result<(), McapError> {
        if self.ended {
            return Err(self.malformed("a message follows the end-of-stream record"));
        }
        let Some(Channel { topic, points, last_ns }) = self.channels.get_mut(&channel) else {
            return Err(self.malformed("a message of an undeclared channel"));
        };
        if time_ns < *last_ns {
            return Err(McapError::Order { topic: topic.clone(), time_ns, after_ns: *last_ns });
        }
        *last_ns = time_ns;
        if let Some(digest) = &mut self.digest {
            digest.update(format!("{topic} {time_ns} {} ", data.len()));
            digest.update(&data);
        }
        self.messages += 1;
        let topic = topic.clone();
        self.events.push_back(if *points {
            match points::decode(data) {
                Ok(table) => Event::Points { topic, time_ns, table },
                Err(what) => return Err(McapError::Points { topic, time_ns, what }),
            }
        } else {
            Event::Bytes { topic, time_ns, data }
        });
        Ok(())
    }

    fn end(&mut self, map: &BTreeMap<String, String>) -> Result<(), McapError> {
        self.ended = true;
        // Other programs may end a stream without counting.
        match map.get("messages").and_then(|text| text.parse().ok()) {
            Some(expected) if expected != self.messages => {
                Err(McapError::Count { found: self.messages, expected })
            }
            _ => Ok(()),
        }
    }

    fn malformed(&self, what: &'static str) -> McapError {
        McapError::Malformed { byte: self.byte, messages: self.messages, what }
    }

    fn truncated(&self) -> McapError {
        McapError::Truncated { messages: self.messages, byte: self.byte }
    }

    fn explain(&self, error: Inner) -> McapError {
        match error {
            Inner::UnexpectedEof if self.byte == 0 => McapError::Empty,
            // The head of a chunk tells no length before the chunk is whole.
            Inner::RecordTooLarge { opcode: op::CHUNK, len: u64::MAX }
            | Inner::BadChunkLength { header: u64::MAX, .. }
            | Inner::UnexpectedEof => self.truncated(),
            Inner::BadMagic if self.messages == 0 && !self.ended => McapError::Magic,
            Inner::BytesAfterEndMagic => McapError::Trailing { byte: self.byte },
            Inner::Io(e) => McapError::Io(e),
            // Its own words are a trace through the parser, in colours.
            Inner::Parse(_) => self.malformed("a record does not have the fields of its kind"),
            other => McapError::Damaged { byte: self.byte, messages: self.messages, source: Box::new(other) },
        }
    }
}

/// Records that are looked at; the others serve random access.
fn is_of_use(opcode: u8) -> bool {
    matches!(opcode, op::SCHEMA | op::CHANNEL | op::MESSAGE | op::METADATA)
}

impl<R: Read> Iterator for Reader<R> {
    type Item = Result<Event, McapError>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.done {
            return None;
        }
        let item = self.advance().transpose();
        self.done = !matches!(item, Some(Ok(_)));
        item
    }
}
