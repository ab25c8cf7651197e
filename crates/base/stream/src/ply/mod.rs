//! PLY: clouds and meshes. Every element, property, list, comment and `obj_info` line is kept, in order.
//!
//! Reads ASCII and binary of both endians, with LF, CRLF or CR line ends, and numbers of any type under
//! their old and new names. Truncated data, bytes after the end and unknown types are errors that say
//! where. Memory depends on the bytes present, never on a count that a header claims.
//!
//! Header and ASCII are parsed here, not by `ply-rs-bw`: that crate refuses `nan` in ASCII and CR line
//! ends, ignores trailing bytes without a message, and keeps no position for messages.

mod ascii;
mod binary;
mod blocks;
mod header;
#[cfg(test)]
mod tests;
mod text;
mod write;

pub use blocks::{Blocks, Opened, number_at};
pub use write::{write, write_columns, write_rows};

pub use crate::number_type::NumberType;
use crate::{Table, Values};
use std::io::{self, Read};
use thiserror::Error;

/// A whole PLY file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ply {
    /// Comment lines of the header, without the word `comment`.
    pub comments: Vec<String>,
    /// `obj_info` lines of the header.
    pub obj_info: Vec<String>,
    /// Elements in the order of the file: `vertex`, `face`, …
    pub elements: Vec<Element>,
}

/// One element: rows of numbers, and of lists of numbers.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Element {
    /// `vertex`, `face`, …
    pub name: String,
    /// The properties that are one number each.
    pub table: Table,
    /// The properties that are lists.
    pub lists: Vec<ListColumn>,
}

/// A property that is a list in every row.
#[derive(Debug, Clone, PartialEq)]
pub struct ListColumn {
    /// `vertex_indices`, …
    pub name: String,
    /// How many number properties stand before it in the file, so that order is kept.
    pub position: usize,
    /// Type of the count in front of each list.
    pub count_kind: NumberType,
    /// Row i is `values[ends[i-1]..ends[i]]`.
    pub ends: Vec<usize>,
    /// All lists, one after the other.
    pub values: Values,
}

impl ListColumn {
    /// The range of `values` that belongs to `row`.
    pub fn row(&self, row: usize) -> std::ops::Range<usize> {
        let start = if row == 0 { 0 } else { self.ends[row - 1] };
        start..self.ends[row]
    }
}

impl Ply {
    /// The element called `name`.
    pub fn element(&self, name: &str) -> Option<&Element> {
        self.elements.iter().find(|e| e.name == name)
    }
}

/// How numbers are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Encoding {
    /// Text.
    Ascii,
    /// Binary, lowest byte first.
    #[default]
    BinaryLittleEndian,
    /// Binary, highest byte first.
    BinaryBigEndian,
}

/// What is wrong with a PLY stream.
#[derive(Debug, Error)]
#[allow(missing_docs)]
pub enum PlyError {
    #[error("PLY: cannot read or write")]
    Io(#[from] io::Error),
    #[error("PLY header, line {line}: {what}: '{found}'")]
    Header { line: usize, what: &'static str, found: String },
    #[error("PLY header: 'end_header' is missing: the file is truncated or not PLY")]
    NoEnd,
    #[error(
        "PLY: element '{element}': the header promises {rows} rows, the data ends in row {row} (byte {byte}): \
         the file is cut off, write it again"
    )]
    Truncated { element: String, rows: u64, row: u64, byte: u64 },
    #[error(
        "PLY: {extra} bytes follow the last row (from byte {byte}): the header's counts do not fit the data, or \
         files were joined"
    )]
    Trailing { extra: u64, byte: u64 },
    #[error(
        "PLY: line {line}: element '{element}', row {row}, property '{property}': '{found}' is not a {kind}"
    )]
    Number { line: usize, element: String, row: u64, property: String, found: String, kind: &'static str },
    #[error(
        "PLY: element '{element}', row {row} (byte {byte}), list '{property}': a count of {count} is not possible"
    )]
    Count { element: String, row: u64, byte: u64, property: String, count: f64 },
    #[error(
        "PLY: line {line}: element '{element}', row {row} has {extra} values too many, from '{found}' on"
    )]
    Extra { line: usize, element: String, row: u64, extra: usize, found: String },
    #[error("PLY: element '{element}' has {rows} rows but no property")]
    Empty { element: String, rows: u64 },
    #[error("PLY: element '{element}'")]
    Table {
        element: String,
        #[source]
        source: crate::table::TableError,
    },
    #[error(
        "PLY: element '{element}': the name '{name}' is not allowed in a header (blank, empty or not ASCII)"
    )]
    Name { element: String, name: String },
    #[error("PLY: element '{element}', list '{property}': {what}")]
    List { element: String, property: String, what: &'static str },
}

/// Reads a whole PLY stream.
///
/// # Errors
/// As [`PlyError`] says, with the place.
pub fn read(from: &mut impl Read) -> Result<Ply, PlyError> {
    let mut bytes = Vec::new();
    crate::whole::rest(from, &mut bytes)?;
    parse(&bytes)
}

/// Reads a PLY that is in memory.
///
/// # Errors
/// As [`PlyError`] says, with the place.
pub fn parse(bytes: &[u8]) -> Result<Ply, PlyError> {
    let (header, body) = header::parse(bytes)?;
    match header.encoding {
        Encoding::Ascii => ascii::body(header, bytes, body),
        Encoding::BinaryLittleEndian => binary::body::<false>(header, bytes, body),
        Encoding::BinaryBigEndian => binary::body::<true>(header, bytes, body),
    }
}
