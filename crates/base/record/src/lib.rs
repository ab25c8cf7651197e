//! What the files of a run hold: topics, metadata records and columns, each declared once.
//!
//! A run (`dem-run`), walls (`wallgen`) and an inlet (`stage-replay`) are MCAP streams. [`topic`] names their channels and [`metadata`]
//! their records; [`column`] names the columns of tables. The other modules are the records and messages themselves: what writes and what
//! reads one stands side by side. [`Columns`] reads a table, [`TableBuilder`] makes one.
//!
//! Uses `geom` and `stream` alone. It knows no engine and no scene, so that tools which only read runs (`view`, `measure`, `wall`) need
//! neither; `scene`, `stages` and `run` translate between these records and the engine's types.

#![deny(missing_docs)]

mod clump;
pub mod column;
mod columns;
mod domain;
mod ending;
mod error;
mod limits;
mod material;
mod messages;
pub mod metadata;
pub mod name;
mod stop;
mod surface;
mod table;
mod times;
pub mod topic;
mod walls_end;

pub use clump::ClumpRecord;
pub use columns::{Columns, hash};
pub use domain::DomainRecord;
pub use ending::Ending;
pub use error::{RecordError, positive};
pub use limits::{BondRange, Sizes};
pub use material::{MaterialRecord, POISSON, is_poisson};
pub use messages::{LogMessage, SIGNAL, Watermark};
pub use stop::{Guard, ReportedStop, StopCause};
pub use surface::{SurfaceShape, WallRecord, home, moved, to_json as motion_to_json};
pub use table::TableBuilder;
pub use times::RunTimes;
pub use walls_end::WallsEnd;

/// Metadata of one record: text by key.
pub type Map = std::collections::BTreeMap<String, String>;

/// The name of a point cloud's frame of reference.
pub const FRAME: &str = "world";

/// A simulated time [s] as the clock of messages [ns].
pub fn nanoseconds(time: f64) -> u64 {
    (time * 1e9).round() as u64
}

/// Latest time of a file [s]: its messages hold whole seconds in 32 bits.
pub const LATEST: f64 = 4e9;

/// JSON of what always is JSON: structs of numbers and text.
pub fn json(value: &impl serde::Serialize) -> String {
    serde_json::to_string(value).unwrap_or_default()
}
