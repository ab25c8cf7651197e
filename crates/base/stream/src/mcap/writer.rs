//! Writes a stream that is whole only when it was finished.

use super::seek_buffer::{KEPT, SeekBuffer, SeekFn};
use super::{END_OF_STREAM, McapError, PROVENANCE, Provenance, point_cloud, points};
use crate::{Rows, Table};
use ::mcap::{WriteOptions, records};
use std::{borrow::Borrow, collections::BTreeMap, io::Write};

/// Name of the writer in the header; free of versions, so that bytes do not depend on them.
const LIBRARY: &str = "grainpipe";
/// A chunk is closed when it has grown to this [B].
const CHUNK: u64 = 1 << 20;

/// How chunks are packed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Compression {
    /// Not at all: the fastest between two tools.
    #[default]
    None,
    /// Zstandard at level 1: for files that stay.
    Zstd,
}

/// How a stream is written.
#[derive(Debug)]
pub struct StreamOptions<W> {
    /// How chunks are packed.
    pub compression: Compression,
    /// How the output goes back in itself, which a file can: what is written goes there at once. What goes to any other output waits in memory
    /// until its chunk is whole.
    pub seeks: Option<SeekFn<W>>,
}

impl<W> From<Compression> for StreamOptions<W> {
    fn from(compression: Compression) -> StreamOptions<W> {
        StreamOptions { compression, seeks: None }
    }
}

/// Writes an MCAP stream to a file or a pipe; the bytes are the same for both.
///
/// Dropping it without [`Writer::finish`] leaves a stream that every reader refuses as truncated.
pub struct Writer<W: Write> {
    inner: Option<::mcap::Writer<SeekBuffer<W>>>,
    /// Id and next sequence number, by schema or encoding and topic.
    channels: BTreeMap<String, (u16, u32)>,
    /// Memory of the last message, used again unless it was large.
    message: Vec<u8>,
    /// Bytes in the open chunk.
    open: u64,
    messages: u64,
}

impl<W: Write> Writer<W> {
    /// Begins a stream without compression.
    ///
    /// # Errors
    /// A write that fails.
    pub fn new(out: W, provenance: &Provenance) -> Result<Writer<W>, McapError> {
        Writer::compressed(out, provenance, Compression::None)
    }

    /// Begins a stream.
    ///
    /// # Errors
    /// A write that fails.
    pub fn compressed(
        out: W,
        provenance: &Provenance,
        how: impl Into<StreamOptions<W>>,
    ) -> Result<Writer<W>, McapError> {
        let StreamOptions { compression, seeks } = how.into();
        let options = WriteOptions::new()
            .library(LIBRARY)
            .compression(match compression {
                Compression::None => None,
                Compression::Zstd => Some(::mcap::Compression::Zstd),
            })
            .compression_level(1)
            // With threads, bytes would depend on their number.
            .compression_threads(0)
            .chunk_size(None);
        let inner = options.create(SeekBuffer::new(out, seeks)).map_err(McapError::writing)?;
        let mut writer = Writer {
            inner: Some(inner),
            channels: BTreeMap::new(),
            message: Vec::new(),
            open: 0,
            messages: 0,
        };
        writer.metadata(PROVENANCE, provenance.to_map())?;
        Ok(writer)
    }

    fn inner(&mut self) -> Result<&mut ::mcap::Writer<SeekBuffer<W>>, McapError> {
        // Only `finish`, which takes the writer away, empties it.
        self.inner.as_mut().ok_or_else(|| McapError::Io(std::io::ErrorKind::NotConnected.into()))
    }

    /// Writes a metadata record, and sends on what is in the open chunk.
    ///
    /// # Errors
    /// A write that fails.
    pub fn metadata(&mut self, name: &str, map: BTreeMap<String, String>) -> Result<(), McapError> {
        let record = records::Metadata { name: name.to_owned(), metadata: map };
        self.inner()?.write_metadata(&record).map_err(McapError::writing)?;
        self.flush_chunk()
    }

    /// Writes a table as one `foxglove.PointCloud` at `time_ns` [ns] of simulated time. A table that is given away is gone before the message is
    /// packed: a large run has little room for both.
    ///
    /// # Errors
    /// A write that fails; a table of 2 GiB or more.
    pub fn points(
        &mut self,
        topic: &str,
        time_ns: u64,
        frame_id: &str,
        table: impl Borrow<Table>,
    ) -> Result<(), McapError> {
        self.cloud(topic, time_ns, |message| {
            let encoded = points::encode(table.borrow(), time_ns, frame_id, message);
            drop(table);
            encoded
        })
    }

    /// Writes rows that are made while they are packed, as [`Writer::points`] writes a table of them.
    ///
    /// # Errors
    /// As for a table.
    pub fn rows(
        &mut self,
        topic: &str,
        time_ns: u64,
        frame_id: &str,
        rows: &impl Rows,
    ) -> Result<(), McapError> {
        self.cloud(topic, time_ns, |message| points::encode_rows(rows, time_ns, frame_id, message))
    }

    fn cloud(
        &mut self,
        topic: &str,
        time_ns: u64,
        encode: impl FnOnce(&mut Vec<u8>) -> Result<(), String>,
    ) -> Result<(), McapError> {
        let mut message = std::mem::take(&mut self.message);
        let wrong = |what| McapError::Points { topic: topic.to_owned(), time_ns, what };
        encode(&mut message).map_err(wrong)?;
        let channel = format!("{} {topic}", point_cloud::NAME);
        if !self.channels.contains_key(&channel) {
            let inner = self.inner()?;
            let schema = inner.add_schema(point_cloud::NAME, "protobuf", point_cloud::DESCRIPTOR);
            self.add_channel(&channel, schema.map_err(McapError::writing)?, topic, "protobuf")?;
        }
        self.send(&channel, time_ns, &message)?;
        if message.capacity() <= KEPT {
            self.message = message;
        }
        Ok(())
    }

    /// Writes bytes in a named encoding (`json`, `bincode`…) at `time_ns` [ns] of simulated time.
    ///
    /// # Errors
    /// A write that fails.
    pub fn bytes(&mut self, topic: &str, encoding: &str, time_ns: u64, data: &[u8]) -> Result<(), McapError> {
        let channel = format!("{encoding} {topic}");
        if !self.channels.contains_key(&channel) {
            self.add_channel(&channel, 0, topic, encoding)?;
        }
        self.send(&channel, time_ns, data)
    }

    fn add_channel(&mut self, key: &str, schema: u16, topic: &str, encoding: &str) -> Result<(), McapError> {
        let none = BTreeMap::new();
        let id = self.inner()?.add_channel(schema, topic, encoding, &none).map_err(McapError::writing)?;
        self.channels.insert(key.to_owned(), (id, 0));
        Ok(())
    }

    fn send(&mut self, channel: &str, time: u64, data: &[u8]) -> Result<(), McapError> {
        let Some((channel_id, sequence)) = self.channels.get_mut(channel) else { return Ok(()) };
        let header = records::MessageHeader {
            channel_id: *channel_id,
            sequence: *sequence,
            log_time: time,
            publish_time: time,
        };
        *sequence = sequence.wrapping_add(1);
        self.messages += 1;
        self.open += data.len() as u64;
        self.inner()?.write_to_known_channel(&header, data).map_err(McapError::writing)?;
        if self.open >= CHUNK { self.flush_chunk() } else { Ok(()) }
    }

    /// Closes the open chunk and sends it on: a reader now sees every message so far.
    ///
    /// # Errors
    /// A write that fails.
    pub fn flush_chunk(&mut self) -> Result<(), McapError> {
        self.open = 0;
        self.inner()?.flush().map_err(McapError::writing)
    }

    /// Ends the stream and gives the output back, flushed.
    ///
    /// # Errors
    /// A write that fails; then the stream stays without its end.
    pub fn finish(mut self) -> Result<W, McapError> {
        let end = BTreeMap::from([("messages".to_owned(), self.messages.to_string())]);
        self.metadata(END_OF_STREAM, end)?;
        self.inner()?.finish().map_err(McapError::writing)?;
        let inner =
            self.inner.take().ok_or_else(|| McapError::Io(std::io::ErrorKind::NotConnected.into()))?;
        let mut held = inner.into_inner();
        held.flush()?;
        Ok(held.into_inner())
    }
}

impl<W: Write> Drop for Writer<W> {
    /// Takes the output out of the mcap writer, which would write a summary and end magic on its own drop.
    fn drop(&mut self) {
        if let Some(inner) = self.inner.take() {
            drop(inner.into_inner());
        }
    }
}
