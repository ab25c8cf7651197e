//! A binary PLY of one element without lists, in blocks of rows as they arrive. Nearly all clouds are like this.
//!
//! The bytes of the file are never all in memory, and a reader begins before the writer has ended.

use super::{Encoding, NumberType, PlyError, binary::is_line_end, header};
use crate::{Values, number_type::of_kind, rows::Number};
use std::io::{self, Read};

/// Bytes that are read at once: they stay in the cache of a core until they are columns.
const BLOCK: usize = 1 << 18;

/// The longest end of a line [B].
const LINE_END: u64 = 2;

/// Rows that are still to come.
pub struct Blocks<R> {
    from: R,
    /// The bytes read last, and how many of them are used up.
    buffer: Vec<u8>,
    used: usize,
    /// Name of the element.
    element: String,
    /// Comment lines of the header.
    pub comments: Vec<String>,
    /// Number of rows that the header promises.
    pub rows: u64,
    /// Bytes of a row.
    pub stride: usize,
    /// Properties of a row.
    pub properties: Vec<RowProperty>,
    /// Rows given.
    given: u64,
    /// Bytes of the file up to the end of the buffer.
    bytes: u64,
}

/// A property of rows of one size.
pub struct RowProperty {
    /// Its name.
    pub name: String,
    /// Its type.
    pub kind: NumberType,
    /// Where it begins in a row [B].
    pub offset: usize,
}

/// What a stream turned out to be.
pub enum Opened<R> {
    /// One element of plain little-endian numbers.
    Blocks(Blocks<R>),
    /// Something else: the bytes read so far, and the rest.
    Other(Vec<u8>, R),
}

impl<R: Read> Opened<R> {
    /// Looks at the beginning of a stream.
    ///
    /// # Errors
    /// A read that fails.
    pub fn new(mut from: R) -> io::Result<Opened<R>> {
        let mut buffer = Vec::with_capacity(BLOCK);
        from.by_ref().take(BLOCK as u64).read_to_end(&mut buffer)?;
        let Ok((header, at)) = header::parse(&buffer) else { return Ok(Opened::Other(buffer, from)) };
        let stride = header.elements.first().and_then(header::ElementHeader::stride).filter(|&s| s > 0);
        let (Encoding::BinaryLittleEndian, 1, Some(stride)) =
            (header.encoding, header.elements.len(), stride)
        else {
            return Ok(Opened::Other(buffer, from));
        };
        let Some(element) = header.elements.into_iter().next() else {
            return Ok(Opened::Other(buffer, from));
        };
        let mut offset = 0;
        let place = |p: header::Property| {
            let property = RowProperty { name: p.name, kind: p.kind, offset };
            offset += property.kind.size();
            property
        };
        Ok(Opened::Blocks(Blocks {
            properties: element.properties.into_iter().map(place).collect(),
            element: element.name,
            comments: header.comments,
            rows: element.rows,
            bytes: buffer.len() as u64,
            from,
            buffer,
            used: at,
            stride,
            given: 0,
        }))
    }
}

impl<R: Read> Blocks<R> {
    /// The next rows, whole; none after the last, when nothing follows it.
    ///
    /// # Errors
    /// A read that fails, an end before the last row, bytes after it.
    pub fn next_rows(&mut self) -> Result<Option<&[u8]>, PlyError> {
        let left = self.rows - self.given;
        if left == 0 {
            return self.end().map(|()| None);
        }
        if self.buffer.len() - self.used < self.stride {
            self.refill()?;
        }
        let rows =
            ((self.buffer.len() - self.used) / self.stride).min(usize::try_from(left).unwrap_or(usize::MAX));
        if rows == 0 {
            let (element, rows) = (self.element.clone(), self.rows);
            return Err(PlyError::Truncated { element, rows, row: self.given, byte: self.bytes });
        }
        self.given += rows as u64;
        let from = self.used;
        self.used += rows * self.stride;
        Ok(Some(&self.buffer[from..self.used]))
    }

    /// The bytes read so far, when no row has been given, and the rest.
    pub fn into_parts(self) -> (Vec<u8>, R) {
        (self.buffer, self.from)
    }

    /// Moves what is left to the front, and fills the buffer up.
    fn refill(&mut self) -> io::Result<()> {
        self.buffer.drain(..self.used);
        self.used = 0;
        let room = BLOCK.max(self.stride) - self.buffer.len();
        self.bytes += self.from.by_ref().take(room as u64).read_to_end(&mut self.buffer)? as u64;
        Ok(())
    }

    /// Nothing may follow but the end of a line.
    fn end(&mut self) -> Result<(), PlyError> {
        let mut rest = self.buffer.split_off(self.used);
        let byte = self.bytes - rest.len() as u64;
        self.from.by_ref().take(LINE_END).read_to_end(&mut rest)?;
        let extra = rest.len() as u64 + io::copy(&mut self.from, &mut io::sink())?;
        self.buffer.clear();
        (self.used, self.bytes) = (0, byte);
        if extra == rest.len() as u64 && is_line_end(&rest) {
            Ok(())
        } else {
            Err(PlyError::Trailing { extra, byte })
        }
    }
}

impl Values {
    /// Adds the numbers at `offset` of whole little-endian rows of `stride` bytes.
    pub fn extend_from_rows(&mut self, rows: &[u8], stride: usize, offset: usize) {
        macro_rules! extend {
            ($($t:ident $v:ident),*) => {
                match self { $(Values::$v(v) => v.extend(rows.chunks_exact(stride).map(|row| $t::get::<false>(&row[offset..]))),)* }
            };
        }
        extend!(i8 I8, u8 U8, i16 I16, u16 U16, i32 I32, u32 U32, f32 F32, f64 F64);
    }
}

/// The number of the given type at the beginning of little-endian bytes.
#[inline(always)]
pub fn number_at(bytes: &[u8], kind: NumberType) -> f64 {
    #[allow(clippy::unnecessary_cast)]
    {
        of_kind!(kind, T, _V => <T as Number>::get::<false>(bytes) as f64)
    }
}
