//! What an outlet records: tables of crossings, their contacts, their bonds, and the paths to the storage plane.
//!
//! Each file translates one topic between the engine's types and a table, in both directions: `run` writes them, `replay` and `inlet` read
//! them. Column names that other topics share are in `record::column`. [`crossing`] comes first; [`path`] has its columns and one more.

pub mod bond;
pub mod contact;
pub mod crossing;
pub mod path;
