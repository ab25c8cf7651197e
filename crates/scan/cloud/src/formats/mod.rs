//! Formats of clouds, detected by their first bytes, never by the file name.
//!
//! A format is one file or folder here and one line in the list of `read`. Text without a magic number comes last.

mod drawing;
mod e57;
mod error;
mod foreign;
mod las;
mod narrowed;
mod pcd;
mod ply;
mod read;
mod text;

pub use error::ReadError;
pub use ply::{read_mesh, to_ply, write_mesh, write_ply};
pub(crate) use read::MOST;
pub use read::{from_bytes, from_bytes_as, go_on, go_on_among, go_on_as, name_of, read};
pub use text::TextColumns;
