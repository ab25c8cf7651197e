//! A plan through time, written as MCAP: frames, crossings, checkpoints; and the answer of `--explain`.
//!
//! ```text
//! start (engine, head of the file) → write what is due (crossings, checkpoint, frame) → let in → step → … → stop, or the end
//! ```
//!
//! [`underway`] is what a run holds, [`simulate`] the loop; [`start`], [`write`] and [`stop`] are its beginning, its output and its early end. [`supply`] merges what comes
//! in, [`schedule`] knows which steps are written, [`frames`] and [`walls`] make the tables, [`checkpoint`] saves and resumes, [`earlier`] copies what a resumed run wrote before. [`explain`] runs a part of a
//! scene to measure it. [`RunFile`] writes the same file for a run that another engine computes. Uses `scene` for the plan, `stages` for inlets and crossings, `record` for formats, `dem` for the engine.

mod checkpoint;
mod earlier;
mod error;
pub mod explain;
mod fallen;
mod file;
mod frames;
mod integration;
mod progress;
mod returned;
mod same_scene;
mod schedule;
mod servos;
mod settling;
mod simulate;
mod start;
mod stop;
mod supply;
mod underway;
mod walls;
mod write;

pub use checkpoint::Checkpoint;
pub use earlier::Earlier;
pub use error::RunError;
pub use fallen::Fallen;
pub use file::RunFile;
pub use integration::IntegrationError;
pub use progress::Progress;
pub use returned::{removals, warnings};
pub use schedule::Schedule;
pub use servos::ServoHeld;
pub use settling::Settled;
pub use simulate::{ready, run};
pub use underway::{Outcome, Settings};
