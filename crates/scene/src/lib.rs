//! The TOML scene: its keys, its checks, its defaults; what it calls for, which engine that makes, and the run.

mod check;
mod columns;
mod contacts;
pub mod crossings;
pub mod error;
mod faucet;
mod fill;
mod forms;
pub mod inlet;
pub mod input;
pub mod material_info;
pub mod mesh_file;
pub mod model;
mod parse;
mod particle_file;
mod plan;
mod room;
mod scene;
pub mod text;
mod wall_file;
mod walls;

pub use error::SceneError;
pub use input::Input;
pub use plan::Plan;
pub use scene::Scene;
pub use text::Text;
pub use wall_file::WallFile;

/// SHA-256 of a text, in hexadecimal digits.
pub(crate) fn sha256(text: &str) -> String {
    stream::sha256(text.as_bytes())
}
