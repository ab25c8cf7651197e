//! Standard laboratory tests on a sample of grains: the scenes that they need, the runs, and the curves that come of them.
//!
//! ```text
//! sample.toml → Sample ─┬─ Recipe::preparation → prepare.toml → dem-run → prepare.mcap ─┐
//!             Request ──┘                                                              ▼
//!                          Recipe::test → test.toml → dem-run → test.mcap → dem-measure → tables → Recipe::curve → Curve → figures
//! ```
//!
//! [`sample`] is what a specimen is made of, with its [`grains`], [`request`] what the user asks for; a file of [`recipes`] is one test. [`scenes`] composes the scenes of a test, [`chain`] runs the
//! programs of one specimen in its folder, [`lab`] all specimens, and [`summary`] judges their curves. The tests compose dem-run and dem-measure from
//! outside, so that each step can be swapped or repeated by hand.

mod composing;
mod curves;
mod error;
pub mod recipes;
mod running;
mod specimen;

pub use composing::scenes;
pub use curves::{series, state, summary};
pub use error::{LabError, Result};
pub use lab::Lab;
pub use recipes::{Recipe, Stresses};
pub use request::Request;
pub use running::chain::Programs;
pub use running::lab;
pub use running::specimens::{SpecimenOutcome, Specimens};
pub use sample::Sample;
pub use series::{Column, Curve};
pub use specimen::{grains, request, sample};
pub use summary::{Figure, Level, Summary};
