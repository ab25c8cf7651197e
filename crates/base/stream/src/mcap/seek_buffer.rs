//! The buffer of a stream until a chunk is complete.

use std::io::{self, Seek, SeekFrom, Write};

/// Memory that is kept from one chunk to the next [B]; that of a larger one is given back.
pub(super) const KEPT: usize = 1 << 20;

/// Goes to a place in an output and tells how far it is from the start [B], as [`Seek::seek`] does.
pub type SeekFn<W> = fn(&mut W, SeekFrom) -> io::Result<u64>;

/// An output that may be sought in, as far back as it was last flushed: the head of a chunk tells its length and its checksum. A pipe takes no byte
/// twice, so that what goes there waits in memory; a file is changed where it is.
pub(super) struct SeekBuffer<W> {
    out: W,
    seeks: Option<SeekFn<W>>,
    held: Vec<u8>,
    /// Bytes that were sent on: where what is held begins.
    sent: u64,
    /// Where the next byte goes, from there.
    at: usize,
}

impl<W: Write> SeekBuffer<W> {
    pub fn new(out: W, seeks: Option<SeekFn<W>>) -> SeekBuffer<W> {
        SeekBuffer { out, seeks, held: Vec::new(), sent: 0, at: 0 }
    }

    /// The output, without what was not flushed.
    pub fn into_inner(self) -> W {
        self.out
    }
}

impl<W: Write> Write for SeekBuffer<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.seeks.is_some() {
            return self.out.write(bytes);
        }
        let over = bytes.len().min(self.held.len() - self.at);
        self.held[self.at..self.at + over].copy_from_slice(&bytes[..over]);
        self.held.extend_from_slice(&bytes[over..]);
        self.at += bytes.len();
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.write_all(&self.held)?;
        self.sent += self.held.len() as u64;
        self.at = 0;
        self.held.clear();
        if self.held.capacity() > KEPT {
            self.held = Vec::new();
        }
        self.out.flush()
    }
}

impl<W> Seek for SeekBuffer<W> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        if let Some(seek) = self.seeks {
            return seek(&mut self.out, to);
        }
        let end = self.sent + self.held.len() as u64;
        let place = match to {
            SeekFrom::Start(place) => Some(place),
            SeekFrom::End(by) => end.checked_add_signed(by),
            SeekFrom::Current(by) => (self.sent + self.at as u64).checked_add_signed(by),
        };
        let place = place.filter(|place| (self.sent..=end).contains(place));
        let place = place.ok_or_else(|| io::Error::other("sought in what was sent on"))?;
        self.at = (place - self.sent) as usize;
        Ok(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_held_may_be_changed_and_what_was_sent_on_may_not() {
        let mut held = SeekBuffer::new(Vec::new(), None);
        held.write_all(b"first").unwrap();
        held.flush().unwrap();
        held.write_all(b"----, then more").unwrap();
        assert_eq!(held.seek(SeekFrom::Start(5)).unwrap(), 5);
        held.write_all(b"next").unwrap();
        assert_eq!(held.stream_position().unwrap(), 9);
        assert!(held.seek(SeekFrom::Start(4)).is_err() && held.seek(SeekFrom::Start(21)).is_err());
        assert_eq!(held.seek(SeekFrom::End(-4)).unwrap(), 16);
        held.write_all(b"all of it").unwrap();
        held.flush().unwrap();
        assert_eq!(held.seek(SeekFrom::End(0)).unwrap(), 25);
        assert_eq!(held.into_inner(), b"firstnext, then all of it");
    }

    /// Several times the largest frame would lie idle between two frames.
    #[test]
    fn no_memory_of_a_large_chunk_is_kept() {
        let mut held = SeekBuffer::new(io::sink(), None);
        held.write_all(&vec![1; 3 * KEPT]).unwrap();
        held.flush().unwrap();
        assert!(held.held.capacity() <= KEPT);
    }
}
