//! The TOML scene: its keys, its checks, its defaults; what it calls for, which engine that makes, and the run.

pub mod accuracy;
mod bodies;
mod bonds;
mod check;
pub mod checkpoint;
mod clump_info;
mod clumps;
mod columns;
mod contact_check;
mod contacts;
pub mod crossings;
mod doubts;
pub mod error;
pub mod explain;
mod faucet;
mod feeds;
mod fill;
mod forms;
pub mod frames;
pub mod gate;
pub mod inlet;
pub mod input;
pub mod links;
pub mod material_info;
mod meeting;
pub mod mesh_file;
mod missing;
pub mod model;
mod moment;
mod parse;
mod particle_file;
pub mod paths;
mod plan;
pub mod replay;
pub mod returned;
mod room;
pub mod run;
mod scene;
pub mod schedule;
pub mod split;
pub mod text;
pub mod touches;
mod wall_file;
mod walls;
mod zones;

pub use checkpoint::Checkpoint;
pub use error::SceneError;
pub use input::Input;
pub use moment::Moment;
pub use plan::Plan;
pub use scene::Scene;
pub use text::Text;
pub use wall_file::WallFile;

pub use dem::setup::{ZoneMotion, ZoneTest};

/// SHA-256 of a text, in hexadecimal digits.
pub(crate) fn sha256(text: &str) -> String {
    stream::sha256(text.as_bytes())
}
