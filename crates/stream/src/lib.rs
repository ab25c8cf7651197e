//! Streams: tables of named columns, PLY and MCAP over files and pipes, provenance.

pub mod table;

pub use table::{Column, Table, Values};
