//! Between columns and packed rows of bytes, the layout of binary PLY and of point cloud messages.

use crate::{
    Values,
    number_type::{NumberType, of_kind},
    table::each,
};
use rayon::prelude::*;

/// Rows that one thread takes at a time; fixed, and small enough that they stay in the cache.
const CHUNK: usize = 2048;

/// A number with a fixed layout.
pub trait Number: Copy + Default + Send + Sync {
    /// From the first bytes of a slice that is long enough.
    fn get<const BIG: bool>(bytes: &[u8]) -> Self;
    /// To the first bytes of a slice that is long enough.
    fn put<const BIG: bool>(self, bytes: &mut [u8]);
    /// To the end of a buffer.
    fn append<const BIG: bool>(self, bytes: &mut Vec<u8>);
}

macro_rules! number {
    ($($t:ty)*) => {$(
        impl Number for $t {
            #[inline(always)]
            fn get<const BIG: bool>(bytes: &[u8]) -> Self {
                let mut own = [0; size_of::<$t>()];
                own.copy_from_slice(&bytes[..size_of::<$t>()]);
                if BIG { <$t>::from_be_bytes(own) } else { <$t>::from_le_bytes(own) }
            }
            #[inline(always)]
            fn put<const BIG: bool>(self, bytes: &mut [u8]) {
                let own = if BIG { self.to_be_bytes() } else { self.to_le_bytes() };
                bytes[..size_of::<$t>()].copy_from_slice(&own);
            }
            fn append<const BIG: bool>(self, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(&if BIG { self.to_be_bytes() } else { self.to_le_bytes() });
            }
        }
    )*};
}
number!(i8 u8 i16 u16 i32 u32 f32 f64);

/// The column at `offset` of rows that are `stride` bytes wide; `bytes` holds whole rows.
pub(crate) fn column<const BIG: bool>(
    bytes: &[u8],
    stride: usize,
    offset: usize,
    kind: NumberType,
) -> Values {
    of_kind!(kind, T, V => V(bytes
        .par_chunks_exact(stride)
        .with_min_len(CHUNK)
        .map(|row| T::get::<BIG>(&row[offset..]))
        .collect()))
}

/// Rows that are made while they are packed: they are never held as columns.
pub trait Rows: Sync {
    /// Names and types of the numbers of a row, in order.
    fn fields(&self) -> Vec<(&str, NumberType)>;
    /// How many rows there are.
    fn count(&self) -> usize;
    /// Puts the numbers of the row after `n` others, in that order.
    fn put(&self, n: usize, row: &mut Line);
}

/// What is left of a row that numbers are put into.
pub struct Line<'a>(&'a mut [u8]);

impl Line<'_> {
    /// Puts the next number.
    ///
    /// # Panics
    /// When the row is full.
    #[inline(always)]
    pub fn put<T: Number>(&mut self, x: T) {
        let (own, rest) = std::mem::take(&mut self.0).split_at_mut(size_of::<T>());
        x.put::<false>(own);
        self.0 = rest;
    }
}

/// Fills `out`, which holds whole rows of `stride` bytes.
pub(crate) fn pack_rows(rows: &impl Rows, stride: usize, out: &mut [u8]) {
    in_chunks(stride, 0, out, |first, out, stride| {
        for (n, row) in (first..).zip(out.chunks_exact_mut(stride)) {
            rows.put(n, &mut Line(row));
        }
    });
}

/// Bytes of one row of `columns`.
pub(crate) fn stride(columns: &[&Values]) -> usize {
    columns.iter().map(|c| c.kind().size()).sum()
}

/// Fills `out`, which holds whole rows, with the rows from `first` on.
pub(crate) fn pack<const BIG: bool>(columns: &[&Values], first: usize, out: &mut [u8]) {
    in_chunks(stride(columns), first, out, |first, out, stride| {
        let mut offset = 0;
        for column in columns {
            put::<BIG>(column, first, out, (stride, offset));
            offset += column.kind().size();
        }
    });
}

/// Fills the column at `offset` of rows that are `stride` bytes wide with the values from `first` on.
fn put<const BIG: bool>(column: &Values, first: usize, rows: &mut [u8], (stride, offset): (usize, usize)) {
    let rows = rows.chunks_exact_mut(stride);
    each!(column, v => for (row, x) in rows.zip(&v[first..]) {
        x.put::<BIG>(&mut row[offset..]);
    });
}

/// Calls `fill` with the first row of each part of `out`, the part and the `stride` [B]; in parallel.
fn in_chunks(stride: usize, first: usize, out: &mut [u8], fill: impl Fn(usize, &mut [u8], usize) + Sync) {
    if stride > 0 {
        let parts = out.par_chunks_mut(CHUNK * stride).enumerate();
        parts.for_each(|(chunk, out)| fill(first + chunk * CHUNK, out, stride));
    }
}

/// Numbers that can be written as a column of little-endian rows, wherever they are kept.
pub trait Fill: Sync {
    /// Their type.
    fn kind(&self) -> NumberType;
    /// Fills a column of `rows` with the numbers from `first` on; `place` is the width of a row and where in it the column begins [B].
    fn fill(&self, first: usize, rows: &mut [u8], place: (usize, usize));
}

impl Fill for Values {
    fn kind(&self) -> NumberType {
        self.kind()
    }
    fn fill(&self, first: usize, rows: &mut [u8], place: (usize, usize)) {
        put::<false>(self, first, rows, place);
    }
}

/// As [`pack`], little-endian, from wherever the columns are kept.
pub(crate) fn pack_from(columns: &[&dyn Fill], first: usize, out: &mut [u8]) {
    let stride = columns.iter().map(|c| c.kind().size()).sum();
    in_chunks(stride, first, out, |first, out, stride| {
        let mut offset = 0;
        for column in columns {
            column.fill(first, out, (stride, offset));
            offset += column.kind().size();
        }
    });
}
