//! Streams: tables of named columns, PLY and MCAP over files and pipes, exact state, provenance.

#![deny(missing_docs)]

pub mod mcap;
pub mod number_type;
pub mod ply;
pub mod reads;
mod rows;
mod shell;
pub mod state;
pub mod table;
pub mod whole;

pub use number_type::NumberType;
pub use rows::{Fill, Line, Rows};
pub use shell::{quoted, reads_more, words};
pub use table::{Column, MOST_COLUMNS, Table, Values};

use sha2::{Digest, Sha256};
use std::io::{self, Read};

/// SHA-256 of bytes, in hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    digits(Sha256::digest(bytes).as_slice())
}

fn digits(hash: &[u8]) -> String {
    hash.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A stream whose SHA-256 is taken as it is read.
pub struct Hashed<R> {
    from: R,
    hash: Sha256,
}

impl<R> Hashed<R> {
    /// Nothing is read yet.
    pub fn new(from: R) -> Hashed<R> {
        Hashed { from, hash: Sha256::new() }
    }

    /// SHA-256 of what was read, in hexadecimal digits.
    pub fn sha256(self) -> String {
        digits(self.hash.finalize().as_slice())
    }
}

impl<R: Read> Read for Hashed<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.from.read(buffer)?;
        self.hash.update(&buffer[..count]);
        Ok(count)
    }
}
