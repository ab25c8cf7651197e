//! Text: XYZ, PTS and their kin, and PTX.

mod columns;
mod given;
mod names;
pub(super) mod ptx;
mod words;
pub(super) mod xyz;

pub use given::TextColumns;
