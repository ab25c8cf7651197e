//! Streams: tables of named columns, PLY and MCAP over files and pipes, exact state, provenance.

pub mod kind;
pub mod mcap;
pub mod ply;
mod rows;
pub mod state;
pub mod table;

pub use kind::Kind;
pub use table::{Column, Table, Values};

use sha2::{Digest, Sha256};

/// SHA-256 of bytes, in hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
