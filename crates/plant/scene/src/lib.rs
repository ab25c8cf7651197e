//! Scenes: the TOML text, its keys, its checks and defaults, and the plan that an engine can run.
//!
//! ```text
//! text → keys → check → Scene → plan → Plan (the engine's setup, insertions, inlets, warnings)
//! ```
//!
//! [`text`] finds places in the file and reads it into [`keys`]; [`check`] judges every value by itself; [`Scene::plan`] reads the files
//! that the scene names ([`input`]), places particles and makes the setup ([`plan`]). Modules use those before them in this list, never
//! those after: error, text, keys, check, input, materials, scene, plan, origin (the key that an error of the engine is about). [`advice`] puts errors of the engine into
//! the words of scenes and uses none of them. Uses `dem` for the setup's types and `record` for formats of files; knows nothing of time
//! or of outputs.

#![deny(missing_docs)]

pub mod advice;
mod check;
pub mod error;
pub mod input;
pub mod keys;
pub mod materials;
mod origin;
pub mod plan;
mod scene;
pub mod text;

pub use advice::SceneSetupError;
pub use dem::setup::{WhenBlocked, ZoneMotion, ZoneTest};
pub use error::{Place, Result, SceneError, nearest};
pub use input::Input;
pub use plan::{Below, Plan};
pub use scene::Scene;
pub use text::Text;
