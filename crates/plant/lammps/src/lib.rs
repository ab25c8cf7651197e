//! A scene on LAMMPS: laws, walls and particles as a deck, LAMMPS as a process, its dumps as a run file.
//!
//! ```text
//! Plan → refuse → types → law, wall, motion → deck, data → folder → process ⇄ dump → run file
//! ```
//!
//! [`inflow`] reads what inlets bring, [`arrivals`] has it come in from a [`depot`]; [`refusal`] lists what LAMMPS cannot do; [`law`] turns contact laws into coefficients of `pair_style granular` and `fix wall/gran`; [`deck`] is the text of
//! a run, [`data`] its atoms, [`clumps`] its rigid bodies, [`bonds`] its bonds, [`breaking`] when they break, [`files`] what they are called; [`folder`] keeps what a later start goes on from; [`process`] starts LAMMPS and keeps its last
//! words; [`dump`] reads what it writes, [`outlet`] finds crossings in it, [`loads`] what contacts bear, [`joined`] what bonds do; [`job`] writes all of that as [`run::RunFile`].
//!
//! Sources: the documentation of LAMMPS (`pair_style granular`, `fix wall/gran`, `fix wall/gran/region`, `fix move`, `dump custom`) and its
//! source of 29 Sep 2021 and 22 Jul 2025, against which the conversions are tested. Uses `dem` for the setup's types, `run` for the file.

mod arrival;
mod arrivals;
mod batch;
mod bonds;
mod breaking;
mod clumps;
mod damping;
mod data;
mod deck;
mod depot;
mod dump;
mod error;
mod files;
mod folder;
mod grain;
mod head;
mod inflow;
mod instant;
mod job;
mod joined;
mod law;
mod loads;
mod motion;
mod outlet;
mod places;
mod process;
mod refusal;
mod simulate;
mod types;
mod version;
mod wall;

pub use deck::Deck;
pub use dump::Parts;
pub use error::{LammpsError, Refusal};
pub use files::FRAMES;
pub use folder::{Start, open};
pub use inflow::Inflow;
pub use law::Target;
pub use process::Engine;
pub use refusal::{Allowed, allow};
pub use simulate::{Origin, Outcome, Prepared, Settings, prepare, run, sampled};
pub use version::Version;
