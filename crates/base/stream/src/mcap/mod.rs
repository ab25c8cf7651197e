//! MCAP over files and pipes: everything that has a time, or attributes per sphere.
//!
//! A stream is a header, a metadata record `provenance`, further metadata, chunks of messages, and a last
//! metadata record `end_of_stream`, which only [`Writer::finish`] writes and which [`Reader`] requires: a tool
//! that failed half way leaves a file that no reader takes for a whole one. Points travel as
//! `foxglove.PointCloud`; times are simulation times, and nothing depends on the clock, so that the same
//! input gives the same bytes.

mod chunk;
mod in_order;
mod lengths;
mod point_cloud;
mod points;
mod provenance;
mod reader;
mod seek_buffer;
#[cfg(test)]
mod tests;
mod walk;
mod writer;

pub use in_order::in_order;
pub use provenance::{PROVENANCE, Provenance};
pub use reader::{Event, Reader};
pub use seek_buffer::SeekFn;
pub use writer::{Compression, StreamOptions, Writer};

use std::io;
use thiserror::Error;

/// Name of the metadata record that ends a good stream; its key `messages` holds their number.
pub const END_OF_STREAM: &str = "end_of_stream";

/// What is wrong with an MCAP stream.
#[derive(Debug, Error)]
#[allow(missing_docs)]
pub enum McapError {
    #[error("MCAP: cannot read or write")]
    Io(#[from] io::Error),
    #[error("MCAP: the stream is empty: did the previous tool fail?")]
    Empty,
    #[error(
        "MCAP: not an MCAP stream: magic bytes are missing; give a file of wallgen, dem-run or stage-replay"
    )]
    Magic,
    #[error(
        "MCAP: truncated after message {messages} (byte {byte}): the end-of-stream record is missing, the tool that \
         wrote it did not finish; run it again"
    )]
    Truncated { messages: u64, byte: u64 },
    #[error("MCAP: near byte {byte}, after message {messages}: the file is damaged, write or copy it again")]
    Damaged {
        byte: u64,
        messages: u64,
        #[source]
        source: Box<::mcap::McapError>,
    },
    #[error(
        "MCAP: near byte {byte}, after message {messages}: {what}; the file is damaged, write or copy it again"
    )]
    Malformed { byte: u64, messages: u64, what: &'static str },
    #[error(
        "MCAP: bytes follow the end of the stream (from byte {byte}): were files joined with cat? Give each file separately"
    )]
    Trailing { byte: u64 },
    #[error("MCAP: {found} messages found, but the end-of-stream record counts {expected}")]
    Count { found: u64, expected: u64 },
    #[error("MCAP: topic '{topic}' at {time_ns} ns: point cloud: {what}")]
    Points { topic: String, time_ns: u64, what: String },
    #[error(
        "MCAP: topic '{topic}': a message of {} s follows one of {} s: give it as a file, which is put in order, and not in a pipe; \
         or write the messages in the order of their times (docs/reference/files.md#mcap-in-the-order-of-time)", seconds(*time_ns), seconds(*after_ns)
    )]
    Order { topic: String, time_ns: u64, after_ns: u64 },
    #[error("MCAP: cannot write")]
    Write(#[source] Box<::mcap::McapError>),
}

fn seconds(time_ns: u64) -> f64 {
    time_ns as f64 * 1e-9
}

impl McapError {
    /// Keeps an I/O error in sight, so that a closed pipe is known for what it is.
    fn writing(error: ::mcap::McapError) -> McapError {
        match error {
            ::mcap::McapError::Io(e) => McapError::Io(e),
            other => McapError::Write(Box::new(other)),
        }
    }
}
