//! Stages of a plant: a scene cut in two at a storage plane, and the flow between both.
//!
//! ```text
//! split: scene → scene upstream, scene downstream
//! outlet: crossings of the run upstream → tables of its file
//! replay: run upstream → inlet stream           inlet: inlet stream → particles that enter the run downstream
//! ```
//!
//! [`outlet`] comes first; [`inlet`] and [`replay`] read its tables and do not know each other; [`split`] works on the text of scenes alone.
//! Uses `scene` for plans and the heads of streams, `record` for formats, `dem` for the types of particles; no engine runs here.

mod error;
pub mod inlet;
mod order;
pub mod outlet;
pub mod replay;
pub mod split;

pub use error::StageError;
