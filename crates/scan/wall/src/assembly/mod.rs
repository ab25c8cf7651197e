//! Builds a wall and writes it.

mod assemble;
mod columns;
mod report;
mod warnings;
mod write;

pub use assemble::{build, spacing};
pub use report::{Wall, WallReport};
pub use write::write_mcap;
